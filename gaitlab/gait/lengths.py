"""Stride length, step length, step width and distance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait, Steps
from gaitlab.motion.frame import FrameParams
from gaitlab.recording.model import Bools, Floats, Side

NO_STEADY = "There is no stride on a straight part."
APART = "The feet are not known to have stood together before the walk, so the place of one says nothing of the other's."
UNKNOWN_STRIDE_M = 1.0
"""A foot of which one stride is more uncertain than this, most of a stride, has no distance."""
WIDTH_SD_M = 0.1
"""A step width more uncertain than this, a whole step width, is not given."""
LOST = "How far the foot went while samples were lost is not known."
NO_STEP = "There is no step between two strides on a straight part."
NO_FOOT = "The {side} foot was not recorded."
ONE_FOOT = "It needs both feet; the {side} foot was not recorded."


def chosen_strides(foot: FootGait) -> Bools:
    """Steady strides without the doubtful ones, where some are left; else all steady ones."""
    sound = foot.steady & ~foot.doubtful
    return sound if sound.any() else foot.steady


def independent_sd(foot: FootGait) -> Floats:
    """Uncertainty of each stride length without the part that all strides share."""
    shared = foot.common_sd * foot.length_m
    sd: Floats = np.sqrt(np.maximum(foot.length_sd_m**2 - shared**2, 0.0))
    return sd


def stride_length(feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """Left, right and both."""
    sides = []
    for side in Side:
        if side not in feet:
            sides.append(not_determinable(d.STRIDE_LENGTH, MeasuredSide(side), NO_FOOT.format(side=side)))
            continue
        foot = feet[side]
        chosen = chosen_strides(foot)
        lengths = foot.length_m[chosen]
        common = foot.common_sd * float(lengths.mean()) if len(lengths) else 0.0
        sides.append(mean_of(d.STRIDE_LENGTH, side, lengths, independent_sd(foot)[chosen], common, NO_STEADY))
    return [*sides, of_both(*sides)]


def lost_a_stride(foot: FootGait) -> bool:
    """How far one of its strides went is not known at all."""
    return bool((foot.length_sd_m > UNKNOWN_STRIDE_M).any())


def distance_of(foot: FootGait) -> tuple[float, float]:
    """Distance travelled by a foot in metres, and its standard uncertainty."""
    total = float(foot.length_m.sum())
    sd = float(np.sqrt(np.sum(independent_sd(foot) ** 2) + (foot.common_sd * total) ** 2))
    return total, sd


def traversed_distance(feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """Left, right and both."""
    sides = []
    for side in Side:
        if side not in feet:
            sides.append(not_determinable(d.DISTANCE, MeasuredSide(side), NO_FOOT.format(side=side)))
            continue
        total, sd = distance_of(feet[side])
        n = int(feet[side].walking.sum())
        if n == 0:
            sides.append(not_determinable(d.DISTANCE, MeasuredSide(side), "The foot made no stride."))
        else:
            if lost_a_stride(feet[side]):
                sides.append(not_determinable(d.DISTANCE, MeasuredSide(side), LOST, n))
                continue
            one = measured(d.DISTANCE, MeasuredSide(side), total, sd, n)
            sides.append(replace(one, common_sd=feet[side].common_sd * total))
    return [*sides, of_both(*sides, a_mean=False)]


def step_length(feet: Mapping[Side, FootGait], steps: Steps, stood_together: bool) -> list[Measurement]:
    """Left, right and both, from the steady steps of the first straight part.

    A foot that stood a little before the other makes one side's steps longer and the other's shorter by that much; the
    mean of both sides does not know of it.
    """
    missing = [side for side in Side if side not in feet]
    if missing or not stood_together:
        reason = ONE_FOOT.format(side=missing[0]) if missing else APART
        return [not_determinable(d.STEP_LENGTH, side, reason) for side in MeasuredSide]
    params, steady = FrameParams(), _first_steps(steps)
    common = float(np.hypot(params.standing_stagger_sd_m, _drift_between(feet)[0]))
    left, right = (
        mean_of(
            d.STEP_LENGTH,
            side,
            steps.length_m[steady & (steps.left == (side is Side.LEFT))],
            0.0,
            common,
            NO_STEP,
        )
        for side in Side
    )
    both = of_both(left, right)
    sides = [
        one.with_attention(
            f"It assumes that the feet stood side by side (± {100 * params.standing_stagger_sd_m:.0f} cm) before the walk."
        )
        for one in (left, right)
    ]
    if both.value is None:
        return [*sides, both]
    shared = 0.5 * (feet[Side.LEFT].common_sd + feet[Side.RIGHT].common_sd) * both.value
    random = float(np.mean([_mean_independent(feet[side]) for side in Side])) / 2.0
    return [*sides, replace(both, sd=float(np.hypot(shared, random)))]


def step_width(feet: Mapping[Side, FootGait], steps: Steps, stood_together: bool) -> list[Measurement]:
    """Both feet together, from the steady steps of the first straight part.

    The assumed distance between the standing feet and the direction of each foot dominate its uncertainty; whether it
    is given depends on that alone, never on the value.
    """
    both = MeasuredSide.BOTH
    missing = [side for side in Side if side not in feet]
    if missing or not stood_together:
        reason = ONE_FOOT.format(side=missing[0]) if missing else APART
        return [not_determinable(d.STEP_WIDTH, both, reason)]
    widths = steps.width_m[_first_steps(steps)]
    if not len(widths):
        return [not_determinable(d.STEP_WIDTH, both, NO_STEP)]
    params = FrameParams()
    sd = float(np.hypot(params.standing_width_sd_m, _drift_between(feet)[1]))
    value = float(widths.mean())
    if sd > WIDTH_SD_M:
        reason = (
            "Sensors on the feet do not see each other. With the feet taken to stand 17 ± 5 cm apart before the walk the"
            f" step width would be {100 * value:.0f} ± {100 * sd:.0f} cm, which says too little."
        )
        return [not_determinable(d.STEP_WIDTH, both, reason, len(widths))]
    reason = (
        "It assumes that the feet stood 17 ± 5 cm apart before the walk and walked in the same direction."
    )
    return [measured(d.STEP_WIDTH, both, value, sd, len(widths)).with_attention(reason)]


def _first_steps(steps: Steps) -> Bools:
    """Steady steps of the first straight part: later the two paths have drifted apart."""
    first: Bools = steps.steady & (steps.part == 0)
    return first


def _mean_independent(foot: FootGait) -> float:
    chosen = chosen_strides(foot)
    n = max(int(chosen.sum()), 1)
    return float(np.sqrt(np.sum(independent_sd(foot)[chosen] ** 2)) / n)


def _drift_between(feet: Mapping[Side, FootGait]) -> tuple[float, float]:
    """How far the two feet's paths may have drifted apart by the middle of the first straight part, in metres, along and
    across the line of walking."""
    along, across = 0.0, 0.0
    for foot in feet.values():
        first = foot.part == 0
        half_way = 0.5 * float(foot.length_m[first].sum())
        random = 0.25 * float(np.sum(independent_sd(foot)[first] ** 2))
        along += random
        across += random + (0.5 * FrameParams().heading_sd_rad * half_way) ** 2
    return float(np.sqrt(along)), float(np.sqrt(across))
