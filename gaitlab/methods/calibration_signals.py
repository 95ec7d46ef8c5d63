"""A foot's sensor beside a reference path: pairs of signals along the walk that a calibration can learn from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, filtfilt

from gaitlab.motion.model import FootMotion, Indices
from gaitlab.recording.model import Bools, Floats


@dataclass(frozen=True)
class ReferenceParams:
    """``cutoff_hz``: of the low-pass (Butterworth, order 2, both ways) before a reference path is differentiated twice;
    ``least_s``: a shorter stretch in sight is of no use."""

    cutoff_hz: float = 10.0
    least_s: float = 2.0


@dataclass(frozen=True, eq=False)
class Pair:
    """What the sensor gives and what is true of it, along the walk, row by row; in ``unit``."""

    name: str
    unit: str
    measured: Floats
    reference: Floats


def calibration_pairs(
    motion: FootMotion, reference_m: Floats, params: ReferenceParams | None = None
) -> tuple[Pair, ...]:
    """Displacement and acceleration along the walk, by the sensor and by a reference, over the longest stretch in sight.

    ``position``: the free acceleration integrated twice from the stretch's start with nothing taken out; only the
    velocity there is taken for zero where the foot rests, else for what the corrected path has. ``stride``: the same,
    begun anew at every rest, as is the reference. ``acceleration``: the free acceleration and the second derivative of
    the reference. "Along the walk" is from the stretch's first place to its last, for sensor and reference each in its own
    world, so that the two headings need not be known.

    Parameters
    ----------
    motion : FootMotion
    reference_m : ndarray (n, 3)
        Where a point of the foot was at each row of ``motion``, z up; NaN where it was not seen.

    Returns
    -------
    tuple of Pair
        None where too little was in sight or the foot went nowhere.
    """
    p = params or ReferenceParams()
    start, end = _longest(np.asarray(np.isfinite(reference_m).all(axis=1)))
    if (end - start) < p.least_s * motion.rate_hz:
        return ()
    rows = slice(start, end)
    own, true = motion.position_m[rows, :2], reference_m[rows, :2]
    along, along_true = own[-1] - own[0], true[-1] - true[0]
    if not (np.linalg.norm(along) > 0.0 and np.linalg.norm(along_true) > 0.0):
        return ()
    along, along_true = along / np.linalg.norm(along), along_true / np.linalg.norm(along_true)
    reference = (true - true[0]) @ along_true
    position = (motion.raw_position_m[rows, :2] - motion.raw_position_m[start, :2]) @ along
    velocity = motion.raw_velocity_mps[rows, :2] @ along
    time = np.arange(end - start) / motion.rate_hz
    drift = velocity[0] - float(motion.velocity_mps[start, :2] @ along)
    moments = motion.rests.moment
    rests = moments[(moments > start) & (moments < end)] - start
    smooth = filtfilt(*butter(2, 2.0 * p.cutoff_hz / motion.rate_hz), reference)
    truly = np.gradient(np.gradient(smooth, time), time)
    return (
        Pair("position", "m", position - drift * time, reference),
        Pair("stride", "m", _anew(position, velocity, rests, time), _anew(reference, None, rests, time)),
        Pair("acceleration", "m/s²", motion.acceleration_mps2[rows, :2] @ along, truly),
    )


def _anew(position: Floats, velocity: Floats | None, rests: Indices, time_s: Floats) -> Floats:
    """Displacement since the rest before (or the start), with the velocity that stood there taken for zero."""
    begins = np.concatenate([[0], rests]).astype(np.intp)
    latest = begins[np.searchsorted(begins, np.arange(len(position)), side="right") - 1]
    moved = position - position[latest]
    return moved if velocity is None else moved - velocity[latest] * (time_s - time_s[latest])


def _longest(seen: Bools) -> tuple[int, int]:
    """The longest run of true, ``[start, end)``."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], seen, [False]]).astype(np.int8)))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        return 0, 0
    best = int(np.argmax(ends - starts))
    return int(starts[best]), int(ends[best])
