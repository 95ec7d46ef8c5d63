"""What is uncertain of a foot's displacement from rest to rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gaitlab.motion.heading import heading_change
from gaitlab.motion.model import FootMotion, Motion, Rests
from gaitlab.motion.passages import leaving
from gaitlab.recording.model import Bools, Floats


@dataclass(frozen=True)
class DisplacementParams:
    """What is uncertain beside the path's own covariance.

    Attributes
    ----------
    scale_sd : float
        Shared by all displacements, as a share of their length: the accelerometer's scale (gravity reads up to 5 % wrong,
        most of it an offset), and that a resting foot begins to roll. Our strides are 0.4 % shorter than the optical ones of
        ``mtw-leg-vicon`` that do not turn and 0.6 % shorter than those of ``foot-mocap``.
    timing_share_per_s : float
        The same for the instant within its interval that a sample speaks of: half an interval of 10 ms makes 1 % of a
        stride, and is doubted by 0.8 % at that interval, in proportion at others.
    lever_m : float
        The sensor may sit so far from the point of the foot that a stride is measured at: 2.6 cm before the middle of
        ankle and toe in ``mtw-leg-vicon``. It counts where the foot turns.
    """

    scale_sd: float = 0.006
    timing_share_per_s: float = 0.8
    lever_m: float = 0.03


def foot_motion(
    moved: dict[str, Any],
    free: Motion,
    rests: Rests,
    step_covariance_m2: Floats,
    place_covariance_m2: Floats,
    velocity_var_m2ps2: Floats,
    level: Bools,
    params: DisplacementParams | None = None,
) -> FootMotion:
    """A foot's motion: ``free`` with what of it has changed, its rests, and the uncertainty of its displacements."""
    p = params or DisplacementParams()
    motion = Motion(**(vars(free) | moved))
    step = np.diff(motion.position_m[rests.moment], axis=0)[:, :2]
    length = np.sqrt(np.einsum("ij,ij->i", step, step))
    along = np.where((length > 0.1)[:, None], step / np.maximum(length, 1e-9)[:, None], np.sqrt(0.5))
    variance = np.einsum("ki,kij,kj->k", along, step_covariance_m2[:, :2, :2], along)
    turn = heading_change(motion, rests) if len(rests) else np.zeros(0)
    scale_sd = float(np.hypot(p.scale_sd, p.timing_share_per_s / motion.rate_hz))
    variance += (2.0 * p.lever_m * np.sin(0.5 * turn)) ** 2 + (scale_sd * length) ** 2
    return FootMotion(
        **vars(motion),
        rests=rests,
        displacement_sd_m=np.sqrt(variance),
        scale_sd=scale_sd,
        doubtful_share=_doubtful_share(free, rests),
        step_covariance_m2=step_covariance_m2,
        place_covariance_m2=place_covariance_m2,
        velocity_var_m2ps2=velocity_var_m2ps2,
        level=level,
        turn_rad=turn,
    )


def _doubtful_share(free: Motion, rests: Rests) -> Floats:
    """Share of lost or saturated rows in each movement from rest to rest."""
    leave, reach = leaving(rests)[:-1], rests.start[1:]
    bad = np.concatenate([[0], np.cumsum(~free.received | free.saturated)])
    share: Floats = (bad[reach] - bad[leave]) / np.maximum(reach - leave, 1)
    return share
