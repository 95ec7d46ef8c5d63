"""The knee over the gait cycle and its sway while its foot rests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import with_count
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.motion.model import KneeMotion
from gaitlab.recording.model import Floats, Side

SWAY_SD_M = 0.005
"""Uncertainty of the knee's movement across the line of walking within a rest of about 0.3 s: an acceleration error
of 0.08 m/s² and the sensor's play on the skin."""

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
    """Sway of a knee across the line of walking in each rest between two straight strides; knee row = foot row +
    shift.

    The line through the movement over the rest is taken out: the leg leans steadily over the standing foot.
    """
    scatter, spread = [], []
    rests, places = foot.motion.rests, foot.motion.rest_position_m
    for k in range(1, len(rests) - 1):
        if not (foot.straight[k - 1] and foot.straight[k]):
            continue
        low, high = int(rests.start[k]) + shift, int(rests.end[k]) + shift
        if low < 0 or high > motion.n_samples or high - low < SHORTEST_REST_S * motion.rate_hz:
            continue
        line = (places[k + 1] - places[k - 1])[:2]
        across = np.array([-line[1], line[0]]) / max(float(np.linalg.norm(line)), 1e-9)
        movement = motion.position_m[low:high, :2] @ across
        ramp = np.linspace(-1.0, 1.0, len(movement))
        movement = movement - movement.mean() - ramp * float(movement @ ramp) / float(ramp @ ramp)
        scatter.append(float(movement.std()))
        spread.append(float(np.ptp(movement)))
    return KneeGait(motion, np.array(scatter), np.array(spread))


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
            value = with_count(measured(d.KNEE_SWAY, which, sway, SWAY_SD_M / np.sqrt(n), n))
            measurements.append(value if sway > SWAY_SD_M / np.sqrt(n) else value.with_attention(UNSEEN))
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
