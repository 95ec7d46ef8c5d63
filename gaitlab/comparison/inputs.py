"""What the methods are given of one recording, and what is missing for which of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from gaitlab.analysis import Analysis
from gaitlab.gait.strides import FootGait
from gaitlab.methods.model import FootView, Method, Need
from gaitlab.methods.steps_signals import Person, StepSignals, stride_signals
from gaitlab.methods.thigh_model import SwingFactors, ThighView, thigh_view
from gaitlab.methods.view import foot_view
from gaitlab.motion.model import KneeMotion, LegPlace
from gaitlab.recording.model import Floats, Placement, Recording, Sensor, Side

USUAL_HEIGHT_M = 1.7
"""For which ``SwingFactors`` are given."""


@dataclass(frozen=True, eq=False)
class Inputs:
    """One recording as the methods see it.

    Attributes
    ----------
    feet : mapping of FootView
        Of the feet that were recorded.
    strides : mapping of StepSignals
        Their strides, for the step-length models.
    thighs : mapping of ThighView
        Of the sensors that move as on a thigh.
    known_length_m : float or None
        How far each foot went from its first rest to its last, measured otherwise.
    """

    analysis: Analysis
    feet: Mapping[Side, FootView]
    strides: Mapping[Side, StepSignals]
    thighs: Mapping[Side, ThighView]
    person: Person = field(default_factory=Person)
    known_length_m: float | None = None

    @property
    def recording(self) -> Recording:
        return self.analysis.recording

    def gait(self, side: Side) -> FootGait:
        """Our own strides of a foot."""
        return self.analysis.gait.feet[side]

    def knee(self, side: Side) -> tuple[Sensor, Floats, int, KneeMotion] | None:
        """The sensor on shank or thigh, its times, knee row less foot row, and its path by ours; None without one."""
        if side not in self.analysis.gait.knees:
            return None
        placement = Placement.knee(side)
        sensor, foot = self.recording.sensors[placement], self.recording.sensors[Placement.foot(side)]
        shift = foot.first_packet - sensor.first_packet
        return sensor, self.recording.time_s(placement), shift, self.analysis.gait.knees[side].motion


def inputs_of(analysis: Analysis, person: Person, known_length_m: float | None) -> Inputs:
    """The views of all feet and thighs of a recording."""
    feet = {
        side: foot_view(analysis.recording.sensors[Placement.foot(side)], foot.motion)
        for side, foot in analysis.gait.feet.items()
    }
    strides = {side: stride_signals(foot) for side, foot in feet.items()}
    bare = Inputs(analysis, feet, strides, {}, person, known_length_m)
    return Inputs(analysis, feet, strides, _thighs(bare), person, known_length_m)


def _thighs(inputs: Inputs) -> dict[Side, ThighView]:
    factors = SwingFactors()
    if inputs.person.height_m is not None:  # the leg is a share of the height
        factors = SwingFactors(factors.per_rad_m * inputs.person.height_m / USUAL_HEIGHT_M)
    views = {}
    for side, foot in inputs.feet.items():
        worn = inputs.knee(side)
        if worn is None:
            continue
        sensor, time_s, shift, motion = worn
        if motion.link is not None and motion.link.place is LegPlace.THIGH:
            views[side] = thigh_view(sensor, time_s, foot.motion, shift, motion, factors)
    return views


def missing(method: Method, inputs: Inputs, side: Side) -> tuple[Need, ...]:
    """What a method wants of a side that the recording and the caller did not give."""
    foot = inputs.feet[side]
    there = {
        Need.ACCELEROMETER: _holds(foot.acc_mps2),
        Need.GYROSCOPE: _holds(foot.gyr_radps),
        Need.MAGNETOMETER: _holds(foot.mag),
        Need.PRESSURE: _holds(foot.pressure_pa),
        Need.KNEE: inputs.knee(side) is not None,
        Need.THIGH: side in inputs.thighs,
        Need.BOTH_FEET: len(inputs.feet) == 2,
        Need.KNOWN_LENGTH: inputs.known_length_m is not None,
        Need.BODY_HEIGHT: inputs.person.height_m is not None,
        Need.SEX: inputs.person.sex is not None,
        Need.REFERENCE: False,
    }
    return tuple(need for need in method.needs if not there[need])


def _holds(signal: Floats | None) -> bool:
    """Whether a signal is there, and more than zeros or gaps."""
    return signal is not None and bool(np.any(np.isfinite(signal) & (signal != 0.0)))
