"""From free acceleration to velocity and position, with the drift removed between rests."""

from __future__ import annotations

from dataclasses import dataclass, replace

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


def reset_at_rests(raw_velocity_mps: Floats, rests: Rests) -> tuple[Floats, Rests]:
    """Set the velocity to zero in every rest and take the drift out of the movement between.

    The velocity at the ends of each rest is pure drift; between two rests it is removed in proportion to time,
    before the first and after the last rest it is taken as constant.

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
    rows = np.arange(len(raw_velocity_mps))
    drift = np.stack([np.interp(rows, knots, raw_velocity_mps[knots, k]) for k in range(3)], axis=1)
    velocity = raw_velocity_mps - drift
    velocity[rests.mask(len(rows))] = 0.0
    last = np.maximum(rests.end - 1, rests.start)
    residual = np.zeros((len(rests), 3))
    residual[1:] = raw_velocity_mps[rests.start[1:]] - raw_velocity_mps[last[:-1]]
    return velocity, replace(rests, residual_mps=residual)


@dataclass(frozen=True)
class PathUncertainty:
    """Sizes of the errors that the removal of drift leaves.

    Attributes
    ----------
    unlinear_share : float
        Share of the residual velocity that did not grow linearly and so is not removed. 0.4 makes the interval cover
        the optical stride lengths of ``mtw-leg-vicon``; simulated walks with perfect rests would allow 0.1.
    rest_speed_mps : float
        A resting foot is not exactly still: speed of the optical mid-foot in the rests of ``mtw-leg-vicon``, 0.014 to
        0.025 m/s, marker noise included.
    bridge : float
        Position error at the end per velocity error and duration: 1/√12 for a Brownian bridge (drift removed linearly).
    doubt_factor : float
        The drift's part is widened by 1 + this · share of lost or saturated rows.
    blind_gap_s, blind_sd_m : float
        Over a longer gap than this the movement is not known, and the displacement is uncertain by a stride.
    """

    unlinear_share: float = 0.4
    rest_speed_mps: float = 0.01
    bridge: float = 12.0**-0.5
    doubt_factor: float = 10.0
    blind_gap_s: float = 0.3
    blind_sd_m: float = 0.7


def displacement_sd(
    rests: Rests,
    rate_hz: float,
    gravity_error: float,
    length_m: Floats,
    doubtful: Floats,
    uncertainty: PathUncertainty,
) -> Floats:
    """Standard uncertainty of the horizontal displacement from each rest to the next, in metres, shape (k − 1,).

    Three independent parts:

    1. Drift. An acceleration error that is white over a swing of duration T and leaves the residual velocity Δv
       leaves, after the linear removal, a Brownian bridge in velocity: u = Δv·T/√12. Δv is the RMS of the stride's
       own residual and the recording's (one residual alone says little about its spread) times ``unlinear_share``.
    2. Rest. ``rest_speed_mps`` over the swing.
    3. Scale. Gravity read wrong by the share e may be an error of scale as well as of offset: u = e·L/√3.

    ``doubtful`` (k − 1,) is the share of lost or saturated rows in each stride; it widens the first part.
    """
    p = uncertainty
    swing_s = (rests.start[1:] - np.maximum(rests.end[:-1] - 1, rests.start[:-1])) / rate_hz
    own = np.linalg.norm(rests.residual_mps[1:, :2], axis=1) / np.sqrt(2.0)
    common = np.sqrt(np.mean(own**2)) if len(own) else 0.0
    remaining = p.unlinear_share * np.sqrt(0.5 * (own**2 + common**2)) * (1.0 + p.doubt_factor * doubtful)
    drift = remaining * swing_s * p.bridge
    rest = p.rest_speed_mps * swing_s
    scale = gravity_error * length_m / np.sqrt(3.0)
    sd: Floats = np.sqrt(drift**2 + rest**2 + scale**2)
    return sd
