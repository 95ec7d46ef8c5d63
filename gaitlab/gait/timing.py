"""Stride time, step time, cadence, stance, swing, double support and stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both
from gaitlab.gait.events import EventParams
from gaitlab.gait.lengths import NO_FOOT, NO_STEADY, NO_STEP, ONE_FOOT
from gaitlab.gait.measurement import (
    Definition,
    MeasuredSide,
    Measurement,
    Status,
    measured,
    not_determinable,
)
from gaitlab.gait.strides import FootGait, Steps
from gaitlab.motion.course import Course
from gaitlab.recording.model import Floats, Side

LONGEST_STRIDE_S = 4.0
"""A longer time between two contacts of a foot holds a stop (mobgap's gate for a stride: 3 s)."""
OVERLAP_S = 0.05
"""A swing of the other foot may reach this far out of a stance and still be its swing: the error of two events."""


@dataclass(frozen=True, eq=False)
class Phases:
    """Times of the steady strides of a foot, in seconds: stride, stance before the swing, swing; and when they
    began."""

    contact_s: Floats
    off_s: Floats
    stride_s: Floats
    stance_s: Floats
    swing_s: Floats


def phases_of(foot: FootGait) -> Phases:
    """Phases of each steady stride whose contact before it is known."""
    off, contact = foot.events.foot_off_s, foot.events.initial_contact_s
    k = np.flatnonzero(foot.steady & foot.continued)
    k = k[contact[k] - contact[k - 1] <= LONGEST_STRIDE_S]
    stride = contact[k] - contact[k - 1]
    return Phases(contact[k - 1], off[k], stride, off[k] - contact[k - 1], contact[k] - off[k])


def times_and_phases(feet: Mapping[Side, FootGait], steps: Steps) -> list[Measurement]:
    """Stride time, stance, swing, step time, double support, cadence."""
    params = EventParams()
    rate_hz = min(foot.motion.rate_hz for foot in feet.values())
    jitter, bias = np.sqrt(2.0) * params.sd_s(rate_hz), np.sqrt(2.0) * params.event_bias_sd_s
    phases = {side: phases_of(foot) for side, foot in feet.items()}
    measurements: list[Measurement] = []

    def by_side(
        definition: Definition, values: Mapping[Side, Floats], independent: float, common: float
    ) -> None:
        sides = [
            mean_of(definition, side, values[side], independent, common, NO_STEADY)
            if side in values
            else not_determinable(definition, MeasuredSide(side), NO_FOOT.format(side=side))
            for side in Side
        ]
        measurements.extend([*sides, of_both(*sides)])

    mean_stride = np.mean([p.stride_s.mean() for p in phases.values() if len(p.stride_s)] or [1.0])
    percent = 100.0 / float(mean_stride)
    by_side(d.STRIDE_TIME, {side: p.stride_s for side, p in phases.items()}, jitter, 0.0)
    by_side(
        d.STANCE,
        {s: 100.0 * p.stance_s / p.stride_s for s, p in phases.items()},
        jitter * percent,
        bias * percent,
    )
    by_side(
        d.SWING,
        {s: 100.0 * p.swing_s / p.stride_s for s, p in phases.items()},
        jitter * percent,
        bias * percent,
    )
    measurements += _double_support(feet, phases, jitter * percent, bias * percent)
    measurements += _step_times(feet, steps, jitter, bias)
    return measurements


def _double_support(
    feet: Mapping[Side, FootGait], phases: Mapping[Side, Phases], jitter: float, bias: float
) -> list[Measurement]:
    missing = [side for side in Side if side not in feet]
    if missing:
        reason = ONE_FOOT.format(side=missing[0])
        return [not_determinable(d.DOUBLE_SUPPORT, side, reason) for side in MeasuredSide]
    sides = []
    for side in Side:
        own, other = phases[side], feet[side.other].events
        shares = []
        for contact, off, stride in zip(own.contact_s, own.off_s, own.stride_s, strict=True):
            inside = (other.foot_off_s >= contact - OVERLAP_S) & (other.initial_contact_s <= off + OVERLAP_S)
            if inside.sum() == 1:
                swing = float(other.initial_contact_s[inside][0] - other.foot_off_s[inside][0])
                shares.append(100.0 * (off - contact - swing) / stride)
        reason = "No steady stride has exactly one swing of the other foot in its stance."
        sides.append(
            mean_of(
                d.DOUBLE_SUPPORT, side, np.array(shares), np.sqrt(2.0) * jitter, np.sqrt(2.0) * bias, reason
            )
        )
    return [*sides, of_both(*sides)]


def _step_times(feet: Mapping[Side, FootGait], steps: Steps, jitter: float, bias: float) -> list[Measurement]:
    missing = [side for side in Side if side not in feet]
    if missing:
        reason = ONE_FOOT.format(side=missing[0])
        return [
            *(not_determinable(d.STEP_TIME, side, reason) for side in MeasuredSide),
            not_determinable(d.CADENCE, MeasuredSide.BOTH, reason),
        ]
    usable = steps.steady & (steps.time_s <= 0.5 * LONGEST_STRIDE_S)
    sides = [
        mean_of(
            d.STEP_TIME,
            side,
            steps.time_s[usable & (steps.left == (side is Side.LEFT))],
            jitter,
            bias,
            NO_STEP,
        )
        for side in Side
    ]
    both = of_both(*sides)
    if both.value is None:
        return [*sides, both, not_determinable(d.CADENCE, MeasuredSide.BOTH, both.reason)]
    random_sd = jitter / np.sqrt(max(both.n, 1))
    cadence = 60.0 / both.value
    value = measured(d.CADENCE, MeasuredSide.BOTH, cadence, cadence * random_sd / both.value, both.n)
    value = value.with_attention(both.reason) if both.status is Status.ATTENTION else value
    return [*sides, replace(both, sd=float(random_sd)), value]


def stop_duration(feet: Mapping[Side, FootGait], course: Course) -> Measurement:
    """Total time of the stops between two bouts of walking."""
    both = MeasuredSide.BOTH
    missing = [side for side in Side if side not in feet]
    if missing:
        return not_determinable(d.STOP_DURATION, both, ONE_FOOT.format(side=missing[0]))
    if not course.bouts:
        return not_determinable(d.STOP_DURATION, both, "Nobody walks in this recording.")
    total = sum(end - start for start, end in course.stops)
    sd = EventParams().event_sd_s * np.sqrt(2.0 * max(len(course.stops), 1))
    return measured(d.STOP_DURATION, both, float(total), float(sd), len(course.stops))
