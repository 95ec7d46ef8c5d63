"""The timed walk over a course of known length: T25-FW and its relatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.events import EventParams
from gaitlab.gait.lengths import independent_sd
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import walking_span
from gaitlab.motion.heading import Course
from gaitlab.recording.model import Floats, Side

START_RULE = "first foot off after standing"
BOTH = MeasuredSide.BOTH
END_SHARE = 0.05
"""A straight walk that ends farther than this share from the end of the course did not end there."""


@dataclass(frozen=True)
class TimedCourse:
    """When the walk over the course began and ended, in seconds, with the uncertainty of the duration."""

    course_m: float
    start_s: float
    end_s: float
    sd_s: float


def time_course(feet: Mapping[Side, FootGait], course: Course, course_m: float | None) -> TimedCourse | str:
    """Time the walk over the course, or say in a sentence why it cannot be timed.

    The clock starts with the first foot off and stops when the leading foot has come ``course_m`` forward from
    where it stood, interpolated between samples, on the first straight part or in the turn that ends it.
    """
    if course_m is None:
        return "No length of a course was given."
    span = walking_span(feet)
    if span is None:
        return "Nobody walks in this recording."
    if not course.straights:
        return "The walk has no straight part of at least a metre."
    if not any(foot.motion.offsets.standing for foot in feet.values()):
        return "Nobody stands still before the walk, so the start is not in the recording."
    until = course.turns[0].end_s if course.turns else course.straights[0][1] + 1.0
    end = _reached(feet, course_m, span[0], until)
    if end is None:
        came = forward_reach(feet, until)
        return f"The leading foot came {came:.2f} m forward before the walk turned or ended; the course is {course_m:g} m."
    place_sd = _time_sd(feet, course_m, span[0], until, end)
    return TimedCourse(course_m, span[0], end, float(np.hypot(place_sd, EventParams().event_sd_s)))


def timed_walk(feet: Mapping[Side, FootGait], timed: TimedCourse | str, course: Course) -> list[Measurement]:
    """Time and speed over the course, and the straight walk against its length."""
    if isinstance(timed, str):
        return [not_determinable(one, BOTH, timed) for one in (d.WALK_TIME, d.WALK_SPEED, d.COURSE_CHECK)]
    duration = timed.end_s - timed.start_s
    speed = timed.course_m / duration
    until = course.turns[0].start_s if course.turns else course.straights[0][1] + 1.0
    excess = forward_reach(feet, until) - timed.course_m
    sd = _place_sd(feet, timed.course_m, timed.end_s)
    check = measured(d.COURSE_CHECK, BOTH, 100.0 * excess / timed.course_m, 100.0 * sd / timed.course_m, 1)
    if abs(excess) > END_SHARE * timed.course_m:
        did = "gone on past" if excess > 0 else "turned before"
        reason = f"The person seems to have {did} the end of the course: no check of scale then."
        check = check.with_attention(reason)
    return [
        measured(d.WALK_TIME, BOTH, duration, timed.sd_s, 1),
        measured(d.WALK_SPEED, BOTH, speed, speed * timed.sd_s / duration, 1),
        check,
    ]


def forward_reach(feet: Mapping[Side, FootGait], until_s: float) -> float:
    """How far the leading foot came forward until then, in metres."""
    return max(
        float(_forward(foot)[foot.motion.time_s <= until_s].max(initial=0.0)) for foot in feet.values()
    )


def _forward(foot: FootGait) -> Floats:
    """Way forward from where the foot stood, shape (n,)."""
    motion = foot.motion
    stood = motion.rest_position_m[0, 0] if len(motion.rests) else 0.0
    forward: Floats = motion.position_m[:, 0] - stood
    return forward


def _reached(feet: Mapping[Side, FootGait], distance_m: float, from_s: float, until_s: float) -> float | None:
    """When the leading foot has come that far forward; None where it does not."""
    times = [_crossing(foot, distance_m, from_s, until_s) for foot in feet.values()]
    return min((time for time in times if time is not None), default=None)


def _crossing(foot: FootGait, distance_m: float, from_s: float, until_s: float) -> float | None:
    """When a foot has come that far forward, interpolated between samples; None where it does not."""
    time_s, forward = foot.motion.time_s, _forward(foot)
    over = np.flatnonzero((forward >= distance_m) & (time_s >= from_s) & (time_s <= until_s))
    if not len(over) or over[0] == 0:
        return None
    row = int(over[0])
    gain = forward[row] - forward[row - 1]
    share = (distance_m - forward[row - 1]) / gain if gain > 0 else 0.0
    return float(time_s[row - 1] + share * (time_s[row] - time_s[row - 1]))


def _time_sd(
    feet: Mapping[Side, FootGait], course_m: float, from_s: float, until_s: float, end_s: float
) -> float:
    """Half the time between the places one standard uncertainty short of the end and one beyond it.

    The leading foot advances by steps, so neither its speed at the crossing nor the mean speed alone says how an
    error of place becomes one of time. Where it does not come as far as the second place, the mean speed stands in.
    """
    place_sd = _place_sd(feet, course_m, end_s)
    before = _reached(feet, course_m - place_sd, from_s, until_s)
    beyond = _reached(feet, course_m + place_sd, from_s, until_s)
    if before is None or beyond is None:
        return place_sd * (end_s - from_s) / course_m
    return 0.5 * (beyond - before)


def _place_sd(feet: Mapping[Side, FootGait], distance_m: float, until_s: float) -> float:
    """Standard uncertainty of a foot's place along the way by then, in metres; mean of the feet."""
    parts = []
    for foot in feet.values():
        independent = independent_sd(foot)[foot.start_s < until_s]
        parts.append(float(np.hypot(np.sqrt(np.sum(independent**2)), foot.common_sd * distance_m)))
    return float(np.mean(parts))
