"""The timed walk over a course of known length: T25-FW and its relatives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.lengths import independent_sd
from gaitlab.gait.measurement import TWO_SIDED_95, MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import EventErrors
from gaitlab.motion.course import Course
from gaitlab.motion.frame import anchor_rest
from gaitlab.recording.model import Floats, Side

START_RULE = "first foot off after standing"
BOTH = MeasuredSide.BOTH
END_SHARE = 0.05
"""A straight walk that ends farther than this share from the end of the course did not end there."""
STANDING_S = 0.5
"""A foot stands before the walk where it has rested for at least this long."""


@dataclass(frozen=True)
class TimedCourse:
    """When the walk over the course began and ended, in seconds, with the 95 % interval of the duration.

    The leading foot advances by steps, so that an error of place costs no time or a whole step's: the interval is not
    symmetrical. ``reached_m`` is how far the leading foot's farthest place of rest lies forward, ``reached_sd_m``
    how uncertain that is; ``reserve`` says why the time wants attention, or is empty.
    """

    course_m: float
    start_s: float
    end_s: float
    interval_s: tuple[float, float]
    reached_m: float
    reached_sd_m: float
    reserve: str = ""


@dataclass(frozen=True, eq=False)
class _Way:
    """Way of one foot forward from where it stood before a straight part, from ``start_s`` (its foot off) on."""

    foot: FootGait
    start_s: float
    stood_s: float
    time_s: Floats
    forward_m: Floats
    places_m: Floats

    def crossing_s(self, distance_m: float) -> float | None:
        """When the foot has come that far, interpolated between samples; None where it does not."""
        over = np.flatnonzero(self.forward_m >= distance_m)
        if not len(over) or over[0] == 0:
            return None
        row = int(over[0])
        gain = self.forward_m[row] - self.forward_m[row - 1]
        share = (distance_m - self.forward_m[row - 1]) / gain if gain > 0 else 0.0
        return float(self.time_s[row - 1] + share * (self.time_s[row] - self.time_s[row - 1]))


def time_course(feet: Mapping[Side, FootGait], course: Course, course_m: float | None) -> TimedCourse | str:
    """Time the walk over the course, or say in a sentence why it cannot be timed.

    The clock starts with the first foot off of the straight part that follows standing, and stops when the leading
    foot has come ``course_m`` forward from where it stood, interpolated between samples, before the turn that ends
    the part is over.
    """
    if course_m is None:
        return "No length of a course was given."
    if not course.bouts:
        return "Nobody walks in this recording."
    starts = [k for k, part in enumerate(course.straights) if course.follows_standing(part)]
    reached, unseen = 0.0, False
    for k in starts:
        ways = [way for way in (_way(foot, course, k) for foot in feet.values()) if way is not None]
        if len(ways) < len(feet) or min(way.stood_s for way in ways) < STANDING_S:
            unseen = True
            continue
        timed = _timed(ways, course_m)
        if timed is not None:
            return timed
        reached = max(reached, *(float(way.forward_m.max(initial=0.0)) for way in ways))
    if unseen and reached == 0.0:
        return "Nobody is seen to stand before the walk, so its start is not in the recording."
    if not starts:
        return "The walk has no straight part of at least a metre that begins from standing."
    return f"The leading foot came {reached:.2f} m forward before the walk turned or ended; the course is {course_m:g} m."


def _way(foot: FootGait, course: Course, part: int) -> _Way | None:
    """The foot's way over a straight part; None where it makes no stride there."""
    strides = np.flatnonzero(foot.part == part)
    if not len(strides):
        return None
    motion, straight = foot.motion, course.straights[part]
    rest = anchor_rest(motion, course, part)
    stood = float(motion.time_s[motion.rests.end[rest] - 1] - motion.time_s[motion.rests.start[rest]])
    after = [turn.end_s for turn in course.turns if turn.start_s >= straight[1] - 1e-6]
    bout = next(b for b in course.bouts if b[0] <= straight[0] + 1e-6 and straight[1] <= b[1] + 1e-6)
    until = min([*after, bout[1] + 0.5])
    places = motion.rest_position_m[:, :2]
    line = places[strides[-1] + 1] - places[rest]
    line = line / max(float(np.linalg.norm(line)), 1e-9)
    rows = slice(int(motion.rests.moment[rest]), int(np.searchsorted(motion.time_s, until)))
    forward = (motion.position_m[rows, :2] - places[rest]) @ line
    moments = motion.time_s[motion.rests.start]
    inside = (np.arange(len(places)) > rest) & (moments <= until)
    off = float(foot.events.foot_off_s[strides[0]])
    return _Way(foot, off, stood, motion.time_s[rows], forward, (places[inside] - places[rest]) @ line)


def _timed(ways: list[_Way], course_m: float) -> TimedCourse | None:
    """Time over the course along these ways; None where no foot comes to its end."""

    def reached(distance_m: float) -> float | None:
        times = [way.crossing_s(distance_m) for way in ways]
        return min((time for time in times if time is not None), default=None)

    end = reached(course_m)
    if end is None:
        return None
    start = min(way.start_s for way in ways)
    place_sd = float(np.mean([_place_sd(way.foot, course_m, end) for way in ways]))
    margin = TWO_SIDED_95 * place_sd
    before, beyond = reached(course_m - margin), reached(course_m + margin)
    by_pace = margin * (end - start) / course_m  # where the foot stopped before
    errors = EventErrors.at(min(way.foot.motion.rate_hz for way in ways))
    parts = [errors.off_sd_s, errors.common_sd_s]
    reserve = ""
    if len(ways) == 1:
        strides = ways[0].foot.events.initial_contact_s[ways[0].foot.straight]
        parts.append(0.25 * float(np.median(np.diff(strides))) if len(strides) > 1 else 0.5)
        reserve = "One foot alone does not tell which foot started and which one led at the end."
    leading = max(ways, key=lambda way: float(way.places_m.max(initial=0.0)))
    far = float(leading.places_m.max(initial=0.0))
    far_sd = _place_sd(leading.foot, far, float(leading.time_s[-1]))
    others = TWO_SIDED_95 * float(np.linalg.norm(parts))
    early = math.hypot(end - before if before else by_pace, others)
    late = math.hypot(beyond - end if beyond else by_pace, others)
    interval = max(end - start - early, 0.0), end - start + late
    return TimedCourse(course_m, start, end, interval, far, far_sd, reserve)


def timed_walk(timed: TimedCourse | str) -> list[Measurement]:
    """Time and speed over the course, and the straight walk against its length."""
    if isinstance(timed, str):
        return [not_determinable(one, BOTH, timed) for one in (d.WALK_TIME, d.WALK_SPEED, d.COURSE_CHECK)]
    duration = timed.end_s - timed.start_s
    speed = timed.course_m / duration
    excess = timed.reached_m - timed.course_m
    percent = 100.0 / timed.course_m
    check = measured(d.COURSE_CHECK, BOTH, excess * percent, timed.reached_sd_m * percent, 1)
    if excess > END_SHARE * timed.course_m:
        reason = "The person seems to have gone on past the end of the course: no check of scale then."
        check = check.with_attention(reason)
    low, high = timed.interval_s
    sd = (high - low) / (2.0 * TWO_SIDED_95)
    slow, fast = timed.course_m / high, timed.course_m / max(low, 0.1 * duration)
    speed_sd = (fast - slow) / (2.0 * TWO_SIDED_95)
    times = [
        replace(measured(d.WALK_TIME, BOTH, duration, sd, 1), interval=(low, high)),
        replace(measured(d.WALK_SPEED, BOTH, speed, speed_sd, 1), interval=(slow, fast)),
    ]
    return [*(one.with_attention(timed.reserve) if timed.reserve else one for one in times), check]


def _place_sd(foot: FootGait, distance_m: float, until_s: float) -> float:
    """Standard uncertainty of a foot's place along the way by then, in metres."""
    independent = independent_sd(foot)[foot.start_s < until_s]
    return float(np.hypot(np.sqrt(np.sum(independent**2)), foot.common_sd * distance_m))
