from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd
import pytest
from pypdf import PdfReader

from gaitlab.clinic import patients, reports, sessions
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.views import PatientForm, SessionForm, SessionView
from gaitlab.errors import GaitlabError
from gaitlab.recording import InputFile, Placement
from gaitlab.result import Result
from tests.clinic.conftest import People
from tests.recordings import short_walk

COLUMNS = "placement,t_s,lost,rest,ax_mps2,ay_mps2,az_mps2,vx_mps,vy_mps,vz_mps,px_m,py_m,pz_m"


@dataclass(frozen=True)
class Stored:
    session: SessionView
    trial_id: str


@pytest.fixture
def stored(clinic: Clinic, people: People) -> Stored:
    """A session whose patient, note and files all carry names."""
    files = {p: InputFile(f"Smith_{f.name}", f.content) for p, f in short_walk(knees=True).items()}
    form = SessionForm.model_validate({"date": "2026-11-20", "test": "t25fw", "note": "canary-session-note"})
    with clinic.desk(people.alice) as desk:
        patient = patients.add_patient(
            desk, PatientForm(code="canary-code", diagnosis="canary-diagnosis", note="canary-note")
        )
        session = sessions.add_session(desk, patient.id, form, files)
    return Stored(session, session.trials[0].id)


def test_html_and_pdf_are_of_this_patient_and_result(clinic: Clinic, people: People, stored: Stored) -> None:
    with clinic.desk(people.rita) as desk:
        html = reports.session_report_html(desk, stored.session.id)
        pdf = reports.session_report_pdf(desk, stored.session.id)
    text = "".join(page.extract_text() for page in PdfReader(io.BytesIO(pdf)).pages)
    for said in ("canary-code", stored.session.trials[0].result.provenance.settings_sha256[:8]):
        assert said in html
        assert said in text


def test_the_result_is_given_as_it_was_stored(
    clinic: Clinic, people: People, stored: Stored, sql: Callable[..., list[tuple[object, ...]]]
) -> None:
    with clinic.desk(people.rita) as desk:
        text = reports.trial_result_json(desk, stored.trial_id)
    assert [(text,)] == sql("SELECT result_json FROM analysis")


def test_the_series_table_has_every_sensor_under_the_fixed_columns(
    clinic: Clinic, people: People, stored: Stored
) -> None:
    with clinic.desk(people.rita) as desk:
        text = reports.trial_series_csv(desk, stored.trial_id)
    assert text.splitlines()[0] == COLUMNS
    table = pd.read_csv(io.StringIO(text))
    sizes = table.groupby("placement", sort=False).size()
    quality = stored.session.trials[0].result.sensors
    assert dict(sizes) == {place: one.samples for place, one in quality.items()}
    assert list(sizes.index) == [place.value for place in Placement]


def test_figures_are_those_of_the_current_analysis(clinic: Clinic, people: People, stored: Stored) -> None:
    with clinic.desk(people.rita) as desk:
        figures = reports.trial_figures(desk, stored.trial_id)
    assert figures
    assert all(figure.svg.lstrip().startswith(b"<svg") for figure in figures)


def test_an_engineers_report_and_exports_name_nobody(clinic: Clinic, people: People, stored: Stored) -> None:
    with clinic.desk(people.erik) as desk:
        html = reports.session_report_html(desk, stored.session.id)
        pdf = PdfReader(io.BytesIO(reports.session_report_pdf(desk, stored.session.id)))
        result = reports.trial_result_json(desk, stored.trial_id)
        figures = b"".join(figure.svg for figure in reports.trial_figures(desk, stored.trial_id)).decode()
        pseudonym = patients.get_patient(desk, stored.session.patient_id).code
    attached = b"".join(b"".join(contents) for contents in pdf.attachments.values()).decode()
    text = "".join(page.extract_text() for page in pdf.pages) + str(pdf.metadata)
    for shown in (html, text, attached, result, figures):
        assert "canary" not in shown
        assert "Smith" not in shown
    assert pseudonym in html
    assert pseudonym in text
    assert attached
    stripped = Result.model_validate_json(result)
    original = stored.session.trials[0].result
    assert stripped.parameters == original.parameters
    assert [one.sha256 for one in stripped.provenance.inputs] == [
        one.sha256 for one in original.provenance.inputs
    ]


def test_a_damaged_series_is_noticed_and_not_drawn(
    clinic: Clinic, people: People, stored: Stored, sql: Callable[..., list[tuple[object, ...]]]
) -> None:
    from pathlib import Path

    path = Path(clinic.files.path(str(sql("SELECT series_sha256 FROM analysis")[0][0])))
    path.chmod(0o600)
    path.write_bytes(path.read_bytes()[:-1])
    for look in (reports.trial_series_csv, reports.trial_figures):
        with pytest.raises(GaitlabError, match="not as it was stored"), clinic.desk(people.rita) as desk:
            look(desk, stored.trial_id)
