"""The knee over the gait cycle and its sway while its foot rests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import with_count
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.motion.model import KneeMotion, LegPlace
from gaitlab.recording.model import Floats, Side

SWAY_SD_M: Mapping[LegPlace, float] = MappingProxyType(
    {LegPlace.SHANK: 0.0015, LegPlace.THIGH: 0.0025, LegPlace.UNKNOWN: 0.005}
)
"""Uncertainty of the knee's movement across the line of walking within a rest of about 0.4 s: its RMS distance from
that of the optical leg at the same place in six rests of ``mtw-leg-vicon`` was 0.0012 m on the upper shank, 0.0006 m
above the ankle, 0.0024 m on the thigh. It is the skin's: in simulated walks the sensor's own share is 0.0001 m."""

SHORTEST_REST_S = 0.05
"""A shorter rest shows no sway."""
UNSEEN = "It is below what this method can see."


@dataclass(frozen=True, eq=False)
class KneeGait:
    """A knee's gait cycles and its sway, one entry a rest of its foot on a straight part."""

    motion: KneeMotion
    sway_sd_m: Floats
    sway_range_m: Floats


def knee_gait(motion: KneeMotion, foot: FootGait, shift: int) -> KneeGait:
    """Sway of a knee in each rest between two straight strides; knee row = foot row + shift."""
    scatter, spread = [], []
    rests, places = foot.motion.rests, foot.motion.rest_position_m
    for k in range(1, len(rests) - 1):
        if not (foot.straight[k - 1] and foot.straight[k]):
            continue
        low, high = int(rests.start[k]) + shift, int(rests.end[k]) + shift
        if low < 0 or high > motion.n_samples or high - low < SHORTEST_REST_S * motion.rate_hz:
            continue
        movement = sway_across(motion.position_m[low:high], places[k + 1] - places[k - 1])
        scatter.append(float(movement.std()))
        spread.append(float(np.ptp(movement)))
    return KneeGait(motion, np.array(scatter), np.array(spread))


def sway_across(path_m: Floats, line_m: Floats) -> Floats:
    """Movement of a path, shape (n, 3), across a line of walking, positive to its left, shape (n,).

    The straight line through it over time is taken out: the leg leans steadily over the standing foot.
    """
    across = np.array([-line_m[1], line_m[0]]) / max(float(np.linalg.norm(line_m[:2])), 1e-9)
    movement = path_m[:, :2] @ across
    ramp = np.linspace(-1.0, 1.0, len(movement))
    sway: Floats = movement - movement.mean() - ramp * float(movement @ ramp) / float(ramp @ ramp)
    return sway


def knee_parameters(knees: Mapping[Side, KneeGait]) -> list[Measurement]:
    """Sway and correction of each knee that was recorded; not determinable for the others."""
    measurements = []
    for side in Side:
        which = MeasuredSide(side)
        if side not in knees:
            reason = f"The {side} knee was not recorded."
            measurements += [not_determinable(one, which, reason) for one in (d.KNEE_SWAY, d.KNEE_RESIDUAL)]
            continue
        knee = knees[side]
        n, m = len(knee.sway_sd_m), len(knee.motion.residual_m)
        if n:
            sway = float(np.sqrt(np.mean(knee.sway_sd_m**2)))
            sd = SWAY_SD_M[knee.motion.link.place if knee.motion.link else LegPlace.UNKNOWN] / np.sqrt(n)
            value = with_count(measured(d.KNEE_SWAY, which, sway, sd, n))
            measurements.append(value if sway > sd else value.with_attention(UNSEEN))
        else:
            measurements.append(
                not_determinable(d.KNEE_SWAY, which, "No rest lies between two straight strides.")
            )
        if m > 1:
            residual = float(np.sqrt(np.mean(knee.motion.residual_m**2)))
            measurements.append(measured(d.KNEE_RESIDUAL, which, residual, residual / np.sqrt(2.0 * m), m))
        else:
            measurements.append(
                not_determinable(d.KNEE_RESIDUAL, which, "The foot made no whole gait cycle.")
            )
    return measurements
