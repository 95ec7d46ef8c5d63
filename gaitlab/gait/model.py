"""Everything that was reconstructed of one walk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gaitlab.gait.knees import KneeGait
from gaitlab.gait.measurement import Measurement
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timed_walk import TimedCourse
from gaitlab.gait.variability import Spreads
from gaitlab.motion.course import Course
from gaitlab.recording.model import Finding, Side


@dataclass(frozen=True, eq=False)
class Gait:
    """What was reconstructed, before it is put into words and numbers."""

    feet: Mapping[Side, FootGait]
    knees: Mapping[Side, KneeGait]
    course: Course
    timed: TimedCourse | str
    parameters: tuple[Measurement, ...]
    findings: tuple[Finding, ...]
    spreads: Spreads
