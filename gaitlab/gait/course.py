"""The timed walk, speeds, turns and how straight the walk was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both
from gaitlab.gait.events import EventParams
from gaitlab.gait.lengths import NO_FOOT, NO_STEADY, chosen_strides, independent_sd
from gaitlab.gait.measurement import Definition, MeasuredSide, Measurement, Status, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import LONGEST_STRIDE_S, walking_span
from gaitlab.motion.heading import Course
from gaitlab.recording.model import Bools, Floats, Side

START_RULE = "first foot off after standing"
BOTH = MeasuredSide.BOTH
END_SHARE = 0.05
"""A straight walk that ends farther than this share from the end of the course did not end there."""
NOBODY_WALKS = "Nobody walks in this recording."


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
    where it stood, interpolated between samples, on the first straight part.
    """
    if course_m is None:
        return "No length of a course was given."
    span = walking_span(feet)
    if span is None or not course.straights:
        return NOBODY_WALKS if span is None else "The walk has no straight part of at least a metre."
    if not any(foot.motion.offsets.standing for foot in feet.values()):
        return "Nobody stands still before the walk, so the start is not in the recording."
    until = course.turns[0].end_s if course.turns else course.straights[0][1] + 1.0
    crossings = [
        c for c in (_crossing(foot, course_m, span[0], until) for foot in feet.values()) if c is not None
    ]
    if not crossings:
        reached = forward_reach(feet, until)
        return f"The leading foot came {reached:.2f} m forward before the walk turned or ended; the course is {course_m:g} m."
    end, sd = min(crossings)
    return TimedCourse(course_m, span[0], end, float(np.hypot(sd, EventParams().event_sd_s)))


def _forward(foot: FootGait) -> Floats:
    motion = foot.motion
    stood = motion.rest_position_m[0, 0] if len(motion.rests) else 0.0
    forward: Floats = motion.position_m[:, 0] - stood
    return forward


def forward_reach(feet: Mapping[Side, FootGait], until_s: float) -> float:
    """How far the leading foot came forward until then, in metres."""
    return max(
        float(_forward(foot)[foot.motion.time_s <= until_s].max(initial=0.0)) for foot in feet.values()
    )


def _crossing(foot: FootGait, course_m: float, from_s: float, until_s: float) -> tuple[float, float] | None:
    """When the foot has come that far, and the standard uncertainty of that time; None where it does not."""
    motion = foot.motion
    forward = _forward(foot)
    over = np.flatnonzero((forward >= course_m) & (motion.time_s >= from_s) & (motion.time_s <= until_s))
    if not len(over) or over[0] == 0:
        return None
    row = int(over[0])
    gain = forward[row] - forward[row - 1]
    share = (course_m - forward[row - 1]) / gain if gain > 0 else 0.0
    time = float(motion.time_s[row - 1] + share * (motion.time_s[row] - motion.time_s[row - 1]))
    before = foot.start_s < time
    place_sd = float(np.hypot(np.sqrt(np.sum(independent_sd(foot)[before] ** 2)), foot.common_sd * course_m))
    speed = max(float(motion.velocity_mps[row, 0]), 0.3)
    return time, place_sd / speed


def timed_walk(feet: Mapping[Side, FootGait], timed: TimedCourse | str, course: Course) -> list[Measurement]:
    """Time and speed over the course, and the straight walk against its length."""
    if isinstance(timed, str):
        return [not_determinable(one, BOTH, timed) for one in (d.WALK_TIME, d.WALK_SPEED, d.COURSE_CHECK)]
    duration = timed.end_s - timed.start_s
    speed = timed.course_m / duration
    until = course.turns[0].start_s if course.turns else course.straights[0][1] + 1.0
    excess = forward_reach(feet, until) - timed.course_m
    sd = float(np.mean([_place_sd(foot, timed.course_m) for foot in feet.values()]))
    check = measured(d.COURSE_CHECK, BOTH, 100.0 * excess / timed.course_m, 100.0 * sd / timed.course_m, 1)
    if abs(excess) > END_SHARE * timed.course_m:
        beyond = "gone on past" if excess > 0 else "turned before"
        check = check.with_attention(
            f"The person seems to have {beyond} the end of the course: no check of scale then."
        )
    return [
        measured(d.WALK_TIME, BOTH, duration, timed.sd_s, 1),
        measured(d.WALK_SPEED, BOTH, speed, speed * timed.sd_s / duration, 1),
        check,
    ]


def _place_sd(foot: FootGait, distance_m: float) -> float:
    strides = independent_sd(foot)[foot.straight]
    return float(np.hypot(np.sqrt(np.sum(strides**2)), foot.common_sd * distance_m))


def speeds(feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """Stride velocity of each side and the steady speed."""
    velocity, steady = [], []
    for side in Side:
        if side not in feet:
            reason = NO_FOOT.format(side=side)
            velocity.append(not_determinable(d.STRIDE_VELOCITY, MeasuredSide(side), reason))
            steady.append(not_determinable(d.STEADY_SPEED, MeasuredSide(side), reason))
            continue
        foot = feet[side]
        no_straight = "There is no stride on a straight part."
        velocity.append(_speed(d.STRIDE_VELOCITY, side, foot, foot.straight, no_straight))
        steady.append(_speed(d.STEADY_SPEED, side, foot, chosen_strides(foot), NO_STEADY))
    both = of_both(*steady)
    if both.status is Status.NOT_DETERMINABLE:
        known = [one for one in steady if one.value is not None]
        if known:
            both = Measurement(d.STEADY_SPEED, BOTH, known[0].value, known[0].sd, known[0].n)
            both = both.with_attention(f"It rests on the {known[0].side} foot alone.")
    return [*velocity, of_both(*velocity), both]


def _speed(definition: Definition, side: Side, foot: FootGait, rows: Bools, reason: str) -> Measurement:
    """Mean of stride length over stride time; a stride after standing has no contact before it and no stride time."""
    contact = foot.events.initial_contact_s
    k = np.flatnonzero(rows)
    k = k[k > 0]
    k = k[foot.walking[k - 1]]
    duration = contact[k] - contact[k - 1]
    usable = (duration > 0) & (duration <= LONGEST_STRIDE_S)
    k, duration = k[usable], duration[usable]
    values = foot.length_m[k] / duration
    jitter = np.sqrt(2.0) * EventParams().event_sd_s * values / duration
    independent = np.hypot(independent_sd(foot)[k] / duration, jitter)
    common = foot.common_sd * float(values.mean()) if len(values) else 0.0
    return mean_of(definition, side, values, independent, common, reason)


def turns(course: Course) -> list[Measurement]:
    """Duration and angle of the turns."""
    n = len(course.turns)
    if n == 0:
        reason = "The walk has no turn."
        return [not_determinable(one, BOTH, reason) for one in (d.TURN_DURATION, d.TURN_ANGLE)]
    duration = float(np.mean([t.end_s - t.start_s for t in course.turns]))
    angle = float(np.mean([abs(np.degrees(t.angle_rad)) for t in course.turns]))
    sd = np.sqrt(2.0) * EventParams().event_sd_s / np.sqrt(n)
    return [
        measured(d.TURN_DURATION, BOTH, duration, float(sd), n),
        measured(
            d.TURN_ANGLE, BOTH, angle, 3.0 / np.sqrt(n), n
        ),  # 3°: scatter of the heading in straight strides
    ]


def path_deviation(feet: Mapping[Side, FootGait], course: Course) -> Measurement:
    """How far the points midway between the feet stray from a straight line on the first straight part."""
    missing = [side for side in Side if side not in feet]
    if missing:
        return not_determinable(
            d.STRAIGHTNESS, BOTH, f"It needs both feet; the {missing[0]} foot was not recorded."
        )
    if not course.straights:
        return not_determinable(d.STRAIGHTNESS, BOTH, "The walk has no straight part of at least a metre.")
    low, high = course.straights[0]
    times = np.arange(low, high, 0.1)
    paths = []
    for foot in feet.values():
        moments = foot.motion.time_s[foot.motion.rests.moment]
        paths.append(
            np.stack([np.interp(times, moments, foot.motion.rest_position_m[:, k]) for k in (0, 1)], axis=1)
        )
    middle = 0.5 * (paths[0] + paths[1])
    rows = np.flatnonzero(np.concatenate([[True], np.diff(middle[:, 0]) > 0]))
    middle = middle[rows]
    if len(middle) < 5:
        return not_determinable(d.STRAIGHTNESS, BOTH, "The first straight part is too short to fit a line.")
    centred = middle - middle.mean(axis=0)
    across = np.linalg.svd(centred, full_matrices=False)[2][1]
    deviation = centred @ across
    sd = 0.5 * float(np.sqrt(sum(np.mean(independent_sd(foot) ** 2) for foot in feet.values() if len(foot))))
    n = int(sum(foot.straight.sum() for foot in feet.values()))
    return measured(d.STRAIGHTNESS, BOTH, float(deviation.std()), sd, n)


def start_to_end(feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """Horizontal distance from each foot's first to its last place of rest."""
    sides = []
    for side in Side:
        if side not in feet or len(feet[side]) == 0:
            reason = NO_FOOT.format(side=side) if side not in feet else "The foot made no stride."
            sides.append(not_determinable(d.CLOSING_ERROR, MeasuredSide(side), reason))
            continue
        foot = feet[side]
        gap = float(np.linalg.norm((foot.motion.rest_position_m[-1] - foot.motion.rest_position_m[0])[:2]))
        sd = float(np.sqrt(np.sum(independent_sd(foot) ** 2)))
        sides.append(measured(d.CLOSING_ERROR, MeasuredSide(side), gap, sd, len(foot)))
    return sides
