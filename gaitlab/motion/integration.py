"""From free acceleration to velocity and position, with the drift removed between rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gaitlab.motion.model import Indices, Rests
from gaitlab.recording.model import Floats


def velocity_of(acceleration_mps2: Floats, rate_hz: float) -> Floats:
    """Velocity at the end of each sample's interval, zero at row 0, shape (n, 3).

    Each sample is the mean acceleration over the interval that ends with it, so its sum is exact.
    """
    velocity = np.cumsum(acceleration_mps2, axis=0) / rate_hz
    moved: Floats = velocity - velocity[0]
    return moved


def position_of(velocity_mps: Floats, rate_hz: float) -> Floats:
    """Position by the trapezoidal rule, zero at row 0, shape (n, 3)."""
    position = np.zeros_like(velocity_mps)
    np.cumsum((velocity_mps[1:] + velocity_mps[:-1]) * (0.5 / rate_hz), axis=0, out=position[1:])
    return position


def _knots(rests: Rests) -> Indices:
    """Rows at which the velocity is known to be zero: both ends of each rest, or its one row."""
    last = np.maximum(rests.end - 1, rests.start)
    rows = np.unique(np.stack([rests.start, last], axis=1).ravel())
    return rows.astype(np.intp)


def reset_at_rests(
    raw_velocity_mps: Floats, rests: Rests, clock: Floats | None = None
) -> tuple[Floats, Rests]:
    """Set the velocity to zero in every rest and take the drift out of the movement between.

    The velocity at the ends of each rest is pure drift; between two rests it is removed in proportion to time, or to
    ``clock``, shape (n,), which never runs backwards: how doubtful the samples were up to each row. Before the first
    and after the last rest it is taken as constant.

    Returns
    -------
    velocity : ndarray (n, 3)
    rests : Rests
        With the residual velocity of each: what the drift had grown to since the rest before it.

    Source: İkizoğlu et al. 2018, §3.2, and Jiménez et al. 2009, §IV.B step 3 (linear interpolation between stances).
    Deviation: the two ends of a rest are two knots, so that drift within a long rest is not spread over the swing.
    """
    if not len(rests):
        return raw_velocity_mps.copy(), rests
    knots = _knots(rests)
    rows = np.arange(len(raw_velocity_mps)) if clock is None else clock
    drift = np.stack([np.interp(rows, rows[knots], raw_velocity_mps[knots, k]) for k in range(3)], axis=1)
    velocity = raw_velocity_mps - drift
    velocity[rests.mask(len(rows))] = 0.0
    last = np.maximum(rests.end - 1, rests.start)
    residual = np.zeros((len(rests), 3))
    residual[1:] = raw_velocity_mps[rests.start[1:]] - raw_velocity_mps[last[:-1]]
    return velocity, replace(rests, residual_mps=residual)
