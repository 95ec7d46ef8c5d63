"""Reports made once for all tests of this room."""

from __future__ import annotations

import datetime as dt
import re
from pathlib import Path

import pytest

from gaitlab.analysis import Settings, analyze
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement
from gaitlab.report import Report, SessionInfo, Subject, TrialReport, build_report
from tests.report import walk

MADE_AT = dt.datetime(2026, 11, 21, 13, 5, tzinfo=dt.timezone(dt.timedelta(hours=1)))
SUBJECT = Subject(
    "VB-0042", "female", 1961, 1.68, 71.5, 0.86, "Unilateral hypofunction", "Walks with a stick."
)
SESSION = SessionInfo(dt.date(2026, 11, 20), "10mwt", 10.0, "Corridor", "Audiology")
REAL = ("1-1", "5-1", "leg")


def squeezed(text: str) -> str:
    """Text without any white space: line breaks in a PDF fall anywhere."""
    return re.sub(r"\s+", "", text)


def report_of(*trials: TrialReport) -> Report:
    """The report of trials with this page's patient and session."""
    return build_report(SUBJECT, SESSION, trials, created_at=MADE_AT)


@pytest.fixture(scope="session")
def trial() -> TrialReport:
    """The closed-form walk as a trial."""
    return TrialReport(1, walk.result(), walk.series())


@pytest.fixture(scope="session")
def report(trial: TrialReport) -> Report:
    """The report of the closed-form walk."""
    return report_of(trial)


@pytest.fixture(scope="session", params=REAL)
def real_trial(request: pytest.FixtureRequest, data_dir: Path) -> TrialReport:
    """A real recording, analysed: two feet with lost packets, or two feet and two knees."""
    if request.param == "leg":
        devices = {
            Placement.LEFT_FOOT: "00B40C55",
            Placement.RIGHT_FOOT: "00B40C48",
            Placement.LEFT_KNEE: "00B40BA5",
            Placement.RIGHT_KNEE: "00B40C35",
        }
        folder = data_dir / "mtw-leg-vicon"
        files = {place: next(folder.glob(f"*{device}*")) for place, device in devices.items()}
        analysis = analyze(read_recording(placements=files))
    else:
        folder = data_dir / "mtw-10m-walk"
        recording = read_recording(folder / f"{request.param}_lf.txt", folder / f"{request.param}_rf.txt")
        analysis = analyze(recording, Settings(course_m=10.0))
    return TrialReport(1, analysis.result, analysis.series)
