"""Stride length, step length, step width and distance."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both, with_count
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait, Steps
from gaitlab.motion.heading import HeadingParams
from gaitlab.recording.model import Bools, Floats, Side

NO_STEADY = "There is no stride on a straight part."
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
            sides.append(measured(d.DISTANCE, MeasuredSide(side), total, sd, n))
    return [*sides, of_both(*sides)]


def step_length(feet: Mapping[Side, FootGait], steps: Steps) -> list[Measurement]:
    """Left, right and both.

    A foot that stood 3 cm before the other makes one side's steps longer and the other's shorter by that much; the
    mean of both sides does not know of it.
    """
    missing = [side for side in Side if side not in feet]
    if missing:
        reason = ONE_FOOT.format(side=missing[0])
        return [not_determinable(d.STEP_LENGTH, side, reason) for side in MeasuredSide]
    stagger = HeadingParams().standing_stagger_sd_m
    reason = NO_STEP
    sides = []
    for side in Side:
        rows = steps.steady & (steps.left == (side is Side.LEFT))
        spread = _drift_between(feet)
        value = mean_of(
            d.STEP_LENGTH, side, steps.length_m[rows], 0.0, float(np.hypot(stagger, spread)), reason
        )
        if value.value is not None:
            value = value.with_attention(
                "It assumes that the feet stood side by side (± 3 cm) before the walk."
            )
        sides.append(value)
    left, right = sides
    both = of_both(left, right)
    if both.value is not None:
        common = 0.5 * max(feet[side].common_sd for side in Side) * 2.0 * both.value
        random = 0.5 * float(np.mean([_mean_independent(feet[side]) for side in Side]))
        both = with_count(
            measured(d.STEP_LENGTH, MeasuredSide.BOTH, both.value, float(np.hypot(common, random)), both.n)
        )
    return [left, right, both]


def _mean_independent(foot: FootGait) -> float:
    chosen = chosen_strides(foot)
    n = max(int(chosen.sum()), 1)
    return float(np.sqrt(np.sum(independent_sd(foot)[chosen] ** 2)) / n)


def _drift_between(feet: Mapping[Side, FootGait]) -> float:
    """How far the two feet's paths may have drifted apart by the middle of the walk, in metres, per axis."""
    squares = [0.5 * float(np.sum(independent_sd(foot) ** 2)) for foot in feet.values()]
    return float(np.sqrt(0.5 * sum(squares)))


def step_width(feet: Mapping[Side, FootGait], steps: Steps) -> list[Measurement]:
    """Both feet together; the assumed distance between the standing feet dominates its uncertainty."""
    both = MeasuredSide.BOTH
    missing = [side for side in Side if side not in feet]
    if missing:
        return [not_determinable(d.STEP_WIDTH, both, ONE_FOOT.format(side=missing[0]))]
    widths = steps.width_m[steps.steady]
    if not len(widths):
        return [not_determinable(d.STEP_WIDTH, both, NO_STEP)]
    params = HeadingParams()
    sd = float(np.hypot(params.standing_width_sd_m, _drift_between(feet)))
    value = float(widths.mean())
    if sd > 0.5 * abs(value) or value < 0:
        return [
            not_determinable(
                d.STEP_WIDTH,
                both,
                "Sensors on the feet do not see each other. With the feet taken to stand 17 ± 5 cm apart before the walk the"
                f" step width would be {100 * value:.0f} ± {100 * sd:.0f} cm, which says too little.",
                len(widths),
            )
        ]
    reason = (
        "It assumes that the feet stood 17 ± 5 cm apart before the walk and walked in the same direction."
    )
    return [measured(d.STEP_WIDTH, both, value, sd, len(widths)).with_attention(reason)]
