"""``gaitlab analyze``."""

from __future__ import annotations

import argparse
import datetime as dt
import os
import sys
from pathlib import Path

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.cli.files import write_files
from gaitlab.cli.parser import PLACEMENTS
from gaitlab.cli.table import print_result
from gaitlab.errors import InputError
from gaitlab.recording import Placement, read_recording
from gaitlab.series import to_csv


def run(chosen: argparse.Namespace) -> int:
    """Analyse a recording; nothing is written unless all of it could be computed."""
    named = {Placement(name): getattr(chosen, name) for name in PLACEMENTS if getattr(chosen, name)}
    if not chosen.paths and not named:
        chosen.usage_error("give a folder, a zip or the files of a recording")
    if chosen.out == "-" and sys.stdout is None:
        raise InputError("cannot_write", "Standard output is closed.", "Give --out the name of a file.")
    recording = read_recording(*chosen.paths, placements=named or None, rate_hz=chosen.rate)
    settings = Settings(
        method=chosen.method, course_m=chosen.course, closed=chosen.closed, way_m=chosen.known_way
    )
    analysis = analyze(recording, settings)
    outputs = _outputs(chosen, analysis)
    write_files(outputs, [*chosen.paths, *named.values()])
    if chosen.out == "-":
        sys.stdout.write(analysis.result.to_json())
    else:
        print_result(analysis.result)
        for path in outputs:
            print(f"wrote {path}")
    return 0


def _outputs(chosen: argparse.Namespace, analysis: Analysis) -> dict[Path, bytes]:
    """Contents to write, by path."""
    outputs: dict[Path, bytes] = {}
    _refuse_twice(chosen)
    if chosen.out not in (None, "-"):
        outputs[Path(chosen.out)] = analysis.result.to_json().encode()
    if chosen.series is not None:
        if os.path.exists(chosen.series) and not os.path.isdir(chosen.series):  # noqa: PTH110, PTH112 never raise
            raise InputError("not_a_folder", f"{chosen.series} is not a folder.", "Give --series a folder.")
        for placement, series in analysis.series.items():
            outputs[chosen.series / f"{placement}.csv"] = to_csv(series).encode()
    if chosen.report:
        from gaitlab.report import SessionInfo, TrialReport, build_report, report_html, report_pdf

        trial = TrialReport(1, analysis.result, analysis.series)
        now = dt.datetime.now(dt.UTC)
        report = build_report(None, SessionInfo(course_m=chosen.course), [trial], created_at=now)
        for path in chosen.report:
            pdf = path.suffix.lower() == ".pdf"
            outputs[path] = report_pdf(report) if pdf else report_html(report).encode()
    return outputs


def _refuse_twice(chosen: argparse.Namespace) -> None:
    """One path given for two outputs would be one key in the table of outputs."""
    given = [*chosen.report, *([Path(chosen.out)] if chosen.out not in (None, "-") else [])]
    for path in given:
        if given.count(path) > 1:
            raise InputError(
                "output_twice", f"{path} is given for two outputs.", "Give each output its own name."
            )
