"""``gaitlab demo``: the main job from files to report, with an example."""

from __future__ import annotations

import argparse
import datetime as dt
import time
from dataclasses import replace
from pathlib import Path

from gaitlab.cli.files import cannot_write, write_files
from gaitlab.cli.table import print_result
from gaitlab.clinic import accounts, patients, reports, sessions
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.desk import Desk
from gaitlab.clinic.settings import ClinicSettings
from gaitlab.clinic.views import PatientForm, SessionForm, SessionView
from gaitlab.recording.file import InputFile
from gaitlab.recording.intake import load
from gaitlab.recording.model import Placement
from gaitlab.recording.selection import place_files
from gaitlab.simulation.mtmanager import write_mtmanager
from gaitlab.simulation.presets import example_walk

CODE = "DEMO-01"


def run(chosen: argparse.Namespace) -> int:
    """Make the example and say where everything is."""
    began = time.perf_counter()
    folder: Path = chosen.dir
    try:
        write_mtmanager(example_walk(), folder / "recording")
    except OSError as error:
        raise cannot_write(Path(error.filename or folder), error) from error
    files = dict(place_files(load([folder / "recording"])).files)
    settings = replace(ClinicSettings.from_environment({}), data_dir=folder / "gaitlab-data")
    clinic = Clinic.open(settings)
    try:
        with clinic.desk(accounts.console(clinic)) as desk:
            session = _session(desk, files)
        with clinic.desk(accounts.console(clinic)) as desk:
            outputs = {
                folder / "report.html": reports.session_report_html(desk, session.id).encode(),
                folder / "report.pdf": reports.session_report_pdf(desk, session.id),
                folder / "result.json": reports.trial_result_json(desk, session.trials[0].id).encode(),
            }
    finally:
        clinic.close()
    write_files(outputs)
    print("Example: a simulated timed 25-foot walk, sensors on both feet and knees.")
    print_result(session.trials[0].result)
    print(f"\nDone in {time.perf_counter() - began:.1f} s:")
    print(f"  {folder / 'recording'}  the recording, as MT Manager writes it")
    for path in outputs:
        print(f"  {path}")
    print(f"  {settings.data_dir}  the database and the raw files")
    if chosen.serve:
        from api.serving import serve

        serve(settings, port=chosen.port)
    else:
        print(f"\nTo see the pages: gaitlab demo --serve --dir {folder}")
    return 0


def _session(desk: Desk, files: dict[Placement, InputFile]) -> SessionView:
    """The example session: made at the first run, found again at the next."""
    found = patients.list_patients(desk, query=CODE).items
    form = PatientForm(
        code=CODE,
        sex="female",
        birth_year=1971,
        height_m=1.68,
        weight_kg=64.0,
        leg_length_m=0.88,
        diagnosis="Example (simulated walk)",
        note="Made by gaitlab demo. Nobody walked.",
    )
    patient = found[0] if found else patients.add_patient(desk, form)
    today = SessionForm(date=dt.datetime.now(dt.UTC).date(), test="t25fw")
    earlier = sessions.list_sessions(desk, patient.id)
    if earlier:
        return sessions.get_session(desk, earlier[0].id)
    return sessions.add_session(desk, patient.id, today, files)
