"""``gaitlab doctor``."""

from __future__ import annotations

import argparse
import json

from gaitlab.recording.doctor import describe, examine, to_dict
from gaitlab.recording.intake import load


def run(chosen: argparse.Namespace) -> int:
    """Print what each file is; 1 if any of them cannot be used."""
    reports = [examine(file, chosen.rate) for file in load(chosen.files)]
    if chosen.json:
        print(json.dumps([to_dict(report) for report in reports], indent=1))
    else:
        print("\n\n".join(describe(report) for report in reports))
    return 1 if not reports or any(report.problem is not None for report in reports) else 0
