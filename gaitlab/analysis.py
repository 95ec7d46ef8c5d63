"""From a recording to its result: the table of contents of the method."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.recording.model import Recording
from gaitlab.result import Result
from gaitlab.series import Series


@dataclass(frozen=True)
class Settings:
    """What can be chosen for an analysis; stored with every result.

    Attributes
    ----------
    method : str
        ``gaitlab`` or ``ikizoglu2018`` (the paper to the letter).
    course_m : float or None
        Length of the timed course; None for a free walk.
    """

    method: str = "gaitlab"
    course_m: float | None = None


@dataclass(frozen=True, eq=False)
class Analysis:
    """An analysed recording: the result and the series behind it."""

    recording: Recording
    result: Result
    series: Series


def analyze(recording: Recording, settings: Settings | None = None) -> Analysis:
    """Reconstruct how each foot and knee moved and measure the gait."""
    raise NotImplementedError
