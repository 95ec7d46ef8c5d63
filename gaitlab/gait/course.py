"""Speeds, turns and how straight the walk was."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both
from gaitlab.gait.lengths import (
    APART,
    LOST,
    NO_FOOT,
    NO_STEADY,
    chosen_strides,
    independent_sd,
    lost_a_stride,
)
from gaitlab.gait.measurement import Definition, MeasuredSide, Measurement, Status, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import LONGEST_STRIDE_S, REST_EDGE_SD_S, EventErrors, sd_in_mean
from gaitlab.motion.course import Course
from gaitlab.motion.smoother import SmootherParams
from gaitlab.recording.model import Bools, Side

BOTH = MeasuredSide.BOTH
HEADING_SCATTER_DEG = 3.0
"""Standard deviation of the foot's change of heading over the straight strides of ``mtw-10m-walk``."""


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
        sound = foot.straight & ~foot.doubtful
        velocity.append(
            _speed(d.STRIDE_VELOCITY, side, foot, sound if sound.any() else foot.straight, NO_STEADY)
        )
        steady.append(_speed(d.STEADY_SPEED, side, foot, chosen_strides(foot), NO_STEADY))
    both = of_both(*steady)
    if both.status is Status.NOT_DETERMINABLE:
        known = [one for one in steady if one.value is not None]
        if known:
            both = replace(known[0], side=BOTH).with_attention(f"It rests on the {known[0].side} foot alone.")
    return [*velocity, of_both(*velocity), both]


def _speed(definition: Definition, side: Side, foot: FootGait, rows: Bools, reason: str) -> Measurement:
    """Mean of stride length over stride time; a stride after standing has no contact before it and no stride time."""
    contact = foot.events.initial_contact_s
    k = np.flatnonzero(rows & foot.continued)
    duration = contact[k] - contact[k - 1]
    usable = (duration > 0) & (duration <= LONGEST_STRIDE_S)
    k, duration = k[usable], duration[usable]
    values = foot.length_m[k] / duration
    time_sd = sd_in_mean(k, EventErrors.at(foot.motion.rate_hz))
    independent = np.hypot(independent_sd(foot)[k], time_sd * values) / duration
    common = foot.common_sd * float(values.mean()) if len(values) else 0.0
    return mean_of(definition, side, values, independent, common, reason)


def turns(feet: Mapping[Side, FootGait], course: Course) -> list[Measurement]:
    """Duration and angle of the turns.

    The scatter of a foot's change of heading falls with their number; what the gyroscopes' offsets drift, in a mean turn,
    and what the feet differ by are common to all.
    """
    n = len(course.turns)
    if n == 0:
        reason = "The walk has no turn."
        return [not_determinable(one, BOTH, reason) for one in (d.TURN_DURATION, d.TURN_ANGLE)]
    duration = float(np.mean([t.end_s - t.start_s for t in course.turns]))
    angle = float(np.mean([abs(np.degrees(t.angle_rad)) for t in course.turns]))
    known = max(foot.motion.offsets.drift_sd_radps for foot in feet.values())
    walk = SmootherParams().drift_walk_radps * math.sqrt(max(turn.end_s for turn in course.turns))
    drift = math.degrees(math.hypot(known, walk)) * duration
    apart = math.degrees(float(np.mean([turn.spread_rad for turn in course.turns])))
    sd = float(np.linalg.norm([HEADING_SCATTER_DEG / math.sqrt(n), drift, apart]))
    measurements = [
        measured(d.TURN_DURATION, BOTH, duration, math.sqrt(2.0) * REST_EDGE_SD_S, n),
        measured(d.TURN_ANGLE, BOTH, angle, sd, n),
    ]
    if min(turn.seen_by for turn in course.turns) < len(feet):
        return [
            one.with_attention("Not every foot was recorded throughout the turns.") for one in measurements
        ]
    return measurements


def path_deviation(feet: Mapping[Side, FootGait], course: Course, stood_together: bool) -> Measurement:
    """How far the points midway between the feet stray from a straight line on the first straight part."""
    missing = [side for side in Side if side not in feet]
    if missing:
        return not_determinable(
            d.STRAIGHTNESS, BOTH, f"It needs both feet; the {missing[0]} foot was not recorded."
        )
    if not course.straights:
        return not_determinable(d.STRAIGHTNESS, BOTH, "The walk has no straight part of at least a metre.")
    if not stood_together:
        return not_determinable(d.STRAIGHTNESS, BOTH, APART)
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
    # a path whose strides err independently strays from its best line by σ²·n/15 (a Brownian motion without its trend)
    strayed = [float(np.sum(independent_sd(foot)[foot.part == 0] ** 2)) / 15.0 for foot in feet.values()]
    sd = 0.5 * math.sqrt(sum(strayed))
    n = int(sum(np.sum(foot.part == 0) for foot in feet.values()))
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
        spread = foot.motion.place_covariance_m2[-1][:2, :2]
        way = (foot.motion.rest_position_m[-1] - foot.motion.rest_position_m[0])[:2]
        along = float(way @ spread @ way) / max(gap, 1e-9) ** 2
        if gap**2 < float(np.trace(spread)):  # its direction says nothing then
            along = float(np.trace(spread)) / 2.0
        sd = float(np.sqrt(along + (foot.common_sd * gap) ** 2))
        if lost_a_stride(foot):
            sides.append(not_determinable(d.CLOSING_ERROR, MeasuredSide(side), LOST, len(foot)))
            continue
        sides.append(measured(d.CLOSING_ERROR, MeasuredSide(side), gap, sd, len(foot)))
    return sides
