"""``gaitlab doctor``."""

from __future__ import annotations

import argparse
import json

from gaitlab.errors import InputError
from gaitlab.recording.doctor import FileReport, describe, examine, to_dict, unusable
from gaitlab.recording.file import InputFile
from gaitlab.recording.intake import PLACEMENT_FILE, expand, load
from gaitlab.recording.rates import check_rate


def run(chosen: argparse.Namespace) -> int:
    """Print what each file is; 1 if any of them cannot be used."""
    if chosen.rate is not None:
        check_rate(chosen.rate)
    reports = [report for file in load(chosen.files) for report in _examine(file, chosen.rate)]
    if not reports:
        raise InputError(
            "no_files",
            f"There is no text file in {', '.join(chosen.files)}.",
            "Give a recording's file, a folder that holds some, or a zip.",
        )
    if chosen.json:
        print(json.dumps([to_dict(report) for report in reports], indent=1))
    else:
        print("\n\n".join(describe(report) for report in reports))
    return 1 if any(report.problem is not None for report in reports) else 0


def _examine(file: InputFile, rate_hz: float | None) -> list[FileReport]:
    """A report for the file, or for each file in a zip; a ``placement.json`` is no recording."""
    try:
        inside = expand([file])
    except InputError as error:
        return [unusable(file, error)]
    return [examine(one, rate_hz) for one in inside if one.basename.lower() != PLACEMENT_FILE]
