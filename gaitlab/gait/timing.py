"""Stride time, step time, cadence, stance, swing, double support and stops.

Where the uncertainty of a mean comes from: each event has an error of its own, and one that all events of its kind
have in a recording. Successive strides share a contact, which ends one and begins the next: in the mean of a run of
them all contacts but the first and the last cancel, and with n strides in r runs it is uncertain by σ·√(2r)/n, not by
σ·√(2/n).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import mean_of, of_both
from gaitlab.gait.events import EventParams
from gaitlab.gait.lengths import NO_FOOT, NO_STEADY, NO_STEP, ONE_FOOT, chosen_strides
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
from gaitlab.motion.model import Indices
from gaitlab.recording.model import Bools, Floats, Side

LONGEST_STRIDE_S = 4.0
"""A longer time between two contacts of a foot holds a stop (mobgap's gate for a stride: 3 s)."""
REST_EDGE_SD_S = 0.045
"""When a foot comes to rest or leaves it. In simulated walks a rest that is found begins 0.06 to 0.11 s after the foot is
flat and ends 0.01 to 0.02 s after its heel has begun to rise."""
OVERLAP_S = 0.05
"""A swing of the other foot may reach this far out of a stance and still be its swing: the error of two events."""


@dataclass(frozen=True)
class EventErrors:
    """Errors of the instants of events: each event's own, and what is common to the events of a kind in a recording.

    Attributes
    ----------
    contact_sd_s, off_sd_s : float
        Own errors of initial contact and foot off at 100 Hz and more: in the 46 trials of ``mtw-10m-walk`` the scatter of
        stride times that ours and the hand-checked ones do not have in common, shared out between the two (175 straight
        parts: 3.3 and 4.0 ms; the labels' own: 5 and 4 ms). In simulated walks 1 ms.
    common_sd_s : float
        Between recordings, per foot and kind; see ``EventParams.event_bias_sd_s``.
    """

    contact_sd_s: float = 0.0035
    off_sd_s: float = 0.004
    common_sd_s: float = EventParams().event_bias_sd_s

    @classmethod
    def at(cls, rate_hz: float) -> EventErrors:
        """Errors at a sampling rate: a contact is read to a sample."""
        coarse = max(1.0 / rate_hz**2 - 0.01**2, 0.0) / 12.0
        return cls(math.sqrt(cls.contact_sd_s**2 + coarse), math.sqrt(cls.off_sd_s**2 + coarse))


@dataclass(frozen=True, eq=False)
class Phases:
    """Times of the steady strides of a foot, in seconds: stride, stance before the swing, swing; when they began,
    and which of the foot's strides they are."""

    index: Indices
    contact_s: Floats
    off_s: Floats
    stride_s: Floats
    stance_s: Floats
    swing_s: Floats

    def only(self, chosen: Bools) -> Phases:
        """Some of the strides."""
        return Phases(*(getattr(self, field.name)[chosen] for field in fields(self)))


def runs_of(index: Indices) -> int:
    """Number of runs of successive strides among these, in order."""
    return 1 + int(np.count_nonzero(np.diff(index) > 1)) if len(index) else 0


def phases_of(foot: FootGait) -> Phases:
    """Phases of each steady stride that begins with a known contact, as far as there are some: that of a sound swing."""
    off, contact = foot.events.foot_off_s, foot.events.initial_contact_s
    k = np.flatnonzero(chosen_strides(foot) & foot.continued)
    k = k[contact[k] - contact[k - 1] <= LONGEST_STRIDE_S]
    begun = ~foot.doubtful[k - 1]
    k = k[begun] if begun.any() else k
    stride = contact[k] - contact[k - 1]
    return Phases(k, contact[k - 1], off[k], stride, off[k] - contact[k - 1], contact[k] - off[k])


def times_and_phases(feet: Mapping[Side, FootGait], steps: Steps) -> list[Measurement]:
    """Stride time, stance, swing, step time, double support, cadence."""
    errors = EventErrors.at(min(foot.motion.rate_hz for foot in feet.values()))
    phases = {side: phases_of(foot) for side, foot in feet.items()}
    mean_stride = np.mean([p.stride_s.mean() for p in phases.values() if len(p.stride_s)] or [1.0])
    percent = 100.0 / float(mean_stride)
    of_share = math.hypot(errors.contact_sd_s, errors.off_sd_s) * percent
    bias = math.sqrt(2.0) * errors.common_sd_s * percent
    measurements: list[Measurement] = []

    def by_side(
        definition: Definition,
        values: Mapping[Side, Floats],
        independent: Mapping[Side, float],
        common: float,
    ) -> None:
        sides = [
            mean_of(definition, side, values[side], independent[side], common, NO_STEADY)
            if side in values
            else not_determinable(definition, MeasuredSide(side), NO_FOOT.format(side=side))
            for side in Side
        ]
        measurements.extend([*sides, of_both(*sides)])

    strides = {side: p.stride_s for side, p in phases.items()}
    by_side(d.STRIDE_TIME, strides, {side: sd_in_mean(p.index, errors) for side, p in phases.items()}, 0.0)
    for definition, name in ((d.STANCE, "stance_s"), (d.SWING, "swing_s")):
        shares = {side: 100.0 * getattr(p, name) / p.stride_s for side, p in phases.items()}
        by_side(definition, shares, dict.fromkeys(phases, of_share), bias)
    measurements += _double_support(feet, phases, of_share, bias)
    measurements += _step_times(feet, steps, errors)
    return measurements


def sd_in_mean(index: Indices, errors: EventErrors) -> float:
    """Uncertainty of these strides' times that, were they independent, would make that of their mean."""
    return errors.contact_sd_s * math.sqrt(2.0 * runs_of(index) / max(len(index), 1))


def double_supports(own: Phases, other: FootGait) -> tuple[Floats, Bools]:
    """Double support in % of the stride, of each steady stride with exactly one swing of the other foot in its stance;
    and which strides these are."""
    off, contact = other.events.foot_off_s, other.events.initial_contact_s
    inside = (off >= own.contact_s[:, None] - OVERLAP_S) & (contact <= own.off_s[:, None] + OVERLAP_S)
    usable = inside.sum(axis=1) == 1
    swing = np.where(inside, contact - off, 0.0).sum(axis=1)
    share = 100.0 * (own.stance_s - swing) / own.stride_s
    return share[usable], usable


def _double_support(
    feet: Mapping[Side, FootGait], phases: Mapping[Side, Phases], of_share: float, bias: float
) -> list[Measurement]:
    missing = [side for side in Side if side not in feet]
    if missing:
        reason = ONE_FOOT.format(side=missing[0])
        return [not_determinable(d.DOUBLE_SUPPORT, side, reason) for side in MeasuredSide]
    reason = "No steady stride has exactly one swing of the other foot in its stance."
    # a stance and the other foot's swing
    independent, common = math.sqrt(2.0) * of_share, math.sqrt(2.0) * bias
    left, right = (
        mean_of(
            d.DOUBLE_SUPPORT,
            side,
            double_supports(phases[side], feet[side.other])[0],
            independent,
            common,
            reason,
        )
        for side in Side
    )
    both = of_both(left, right)
    if both.sd is None or left.sd is None or right.sd is None:
        return [left, right, both]
    # what is common to the events of a kind lengthens the double support of both sides alike: their mean keeps it
    random = 0.5 * math.sqrt(max(left.sd**2 + right.sd**2 - 2.0 * common**2, 0.0))
    return [left, right, replace(both, sd=math.hypot(random, common))]


def _step_times(feet: Mapping[Side, FootGait], steps: Steps, errors: EventErrors) -> list[Measurement]:
    missing = [side for side in Side if side not in feet]
    if missing:
        reason = ONE_FOOT.format(side=missing[0])
        return [
            *(not_determinable(d.STEP_TIME, side, reason) for side in MeasuredSide),
            not_determinable(d.CADENCE, MeasuredSide.BOTH, reason),
        ]
    own = math.sqrt(2.0) * errors.contact_sd_s
    usable = steps.steady & (steps.time_s <= 0.5 * LONGEST_STRIDE_S)
    sides = [
        mean_of(
            d.STEP_TIME,
            side,
            steps.time_s[usable & (steps.left == (side is Side.LEFT))],
            own,
            math.sqrt(2.0) * errors.common_sd_s,
            NO_STEP,
        )
        for side in Side
    ]
    both = of_both(*sides)
    if both.value is None:
        return [*sides, both, not_determinable(d.CADENCE, MeasuredSide.BOTH, both.reason)]
    successive = usable[1:] & usable[:-1] & (steps.part[1:] == steps.part[:-1])
    runs = int(usable.sum()) - int(successive.sum())
    random_sd = own * math.sqrt(runs) / max(both.n, 1)
    cadence = 60.0 / both.value
    value = measured(d.CADENCE, MeasuredSide.BOTH, cadence, cadence * random_sd / both.value, both.n)
    value = value.with_attention(both.reason) if both.status is Status.ATTENTION else value
    return [*sides, replace(both, sd=random_sd), value]


def stop_duration(feet: Mapping[Side, FootGait], course: Course) -> Measurement:
    """Total time of the stops between two bouts of walking."""
    both = MeasuredSide.BOTH
    missing = [side for side in Side if side not in feet]
    if missing:
        return not_determinable(d.STOP_DURATION, both, ONE_FOOT.format(side=missing[0]))
    if not course.bouts:
        return not_determinable(d.STOP_DURATION, both, "Nobody walks in this recording.")
    total = sum(end - start for start, end in course.stops)
    sd = REST_EDGE_SD_S * np.sqrt(2.0 * max(len(course.stops), 1))
    return measured(d.STOP_DURATION, both, float(total), float(sd), len(course.stops))
