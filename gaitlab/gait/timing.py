"""Stride time, step time, cadence, stance, swing, double support and stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both, with_count
from gaitlab.gait.events import EventParams
from gaitlab.gait.lengths import NO_FOOT, NO_STEADY, NO_STEP, ONE_FOOT
from gaitlab.gait.measurement import Definition, MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait, Steps
from gaitlab.recording.model import Floats, Side

LONGEST_STRIDE_S = 4.0
"""A longer time between two contacts of a foot holds a stop (mobgap's gate for a stride: 3 s)."""
STOP_S = 1.0
"""Both feet at rest for longer than this is a stop."""


@dataclass(frozen=True, eq=False)
class Phases:
    """Times of the steady strides of a foot, in seconds: stride, stance before the swing, swing; and when they
    began."""

    contact_s: Floats
    off_s: Floats
    stride_s: Floats
    stance_s: Floats
    swing_s: Floats
    length_m: Floats


def phases_of(foot: FootGait) -> Phases:
    """Phases of each steady stride whose contact before it is known."""
    off, contact = foot.events.foot_off_s, foot.events.initial_contact_s
    k = np.flatnonzero(foot.steady)
    k = k[k > 0]
    k = k[foot.walking[k - 1] & (contact[k] - contact[k - 1] <= LONGEST_STRIDE_S)]
    stride = contact[k] - contact[k - 1]
    return Phases(
        contact[k - 1], off[k], stride, off[k] - contact[k - 1], contact[k] - off[k], foot.length_m[k]
    )


def times_and_phases(feet: Mapping[Side, FootGait], steps: Steps) -> list[Measurement]:
    """Stride time, stance, swing, step time, double support, cadence."""
    params = EventParams()
    jitter, bias = np.sqrt(2.0) * params.event_sd_s, np.sqrt(2.0) * params.event_bias_sd_s
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
            inside = (other.foot_off_s >= contact - 0.05) & (other.initial_contact_s <= off + 0.05)
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
    both = with_count(measured(d.STEP_TIME, MeasuredSide.BOTH, both.value, random_sd, both.n))
    cadence = 60.0 / float(both.value or 1.0)
    sd = cadence * random_sd / float(both.value or 1.0)
    return [*sides, both, with_count(measured(d.CADENCE, MeasuredSide.BOTH, cadence, sd, both.n))]


def walking_span(feet: Mapping[Side, FootGait]) -> tuple[float, float] | None:
    """From the first foot off to the last initial contact of a walking stride, in seconds; None where nobody
    walks."""
    first, last = [], []
    for foot in feet.values():
        rows = np.flatnonzero(foot.walking)
        if len(rows):
            first.append(float(foot.events.foot_off_s[rows[0]]))
            last.append(float(foot.events.initial_contact_s[rows[-1]]))
    return (min(first), max(last)) if first else None


def stop_duration(feet: Mapping[Side, FootGait]) -> Measurement:
    """Total time of the stops between the first foot off and the last contact."""
    both = MeasuredSide.BOTH
    missing = [side for side in Side if side not in feet]
    if missing:
        return not_determinable(d.STOP_DURATION, both, ONE_FOOT.format(side=missing[0]))
    span = walking_span(feet)
    if span is None:
        return not_determinable(d.STOP_DURATION, both, "Nobody walks in this recording.")
    edges = []
    for foot in feet.values():
        for k in np.flatnonzero(foot.walking):
            edges += [(float(foot.events.foot_off_s[k]), 1), (float(foot.events.initial_contact_s[k]), -1)]
    edges.sort()
    total, stops, moving, since = 0.0, 0, 0, span[0]
    for time, change in edges:
        if moving == 0 and time - since > STOP_S:
            total, stops = total + time - since, stops + 1
        moving += change
        since = time
    sd = EventParams().event_sd_s * np.sqrt(2.0 * max(stops, 1))
    return measured(d.STOP_DURATION, both, total, float(sd), stops)
