"""A knee's path against the optical knee joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import Indices, KneeMotion
from gaitlab.recording.model import Bools, Floats
from gaitlab.validation.truth import LeverFit, OpticalPath, fit_lever


@dataclass(frozen=True, eq=False)
class KneeCheck:
    """The knee in each gait cycle that lies wholly within sight of the cameras.

    Attributes
    ----------
    start_s, end_s : ndarray (m,)
        The cycles.
    cycle : ndarray (n,)
        Cycle of each row that was compared.
    first, mean : LeverFit
        Laid on the optical joint at the first row of each cycle, and at its mean place.
    """

    start_s: Floats
    end_s: Floats
    cycle: Indices
    first: LeverFit
    mean: LeverFit

    def __len__(self) -> int:
        return len(self.start_s)


def check_knee(
    knee: KneeMotion, cycle_start: Indices, cycle_end: Indices, optical: OpticalPath
) -> KneeCheck | None:
    """Lay the path of a knee's sensor on the optical joint; None where no gait cycle is in sight."""
    truth = optical.at(knee.time_s)
    seen: Bools = np.all(np.isfinite(truth), axis=1)
    whole = [
        (int(a), int(b))
        for a, b in zip(cycle_start, cycle_end, strict=True)
        if seen[a : b + 1].all() and b > a
    ]
    if not whole:
        return None
    rows = np.concatenate([np.arange(a, b + 1) for a, b in whole])
    cycle = np.concatenate([np.full(b + 1 - a, k) for k, (a, b) in enumerate(whole)])
    rotation = _matrices(knee.attitude[rows])
    fits = [
        fit_lever(knee.position_m[rows], rotation, truth[rows], cycle, start_is_mean=mean)
        for mean in (False, True)
    ]
    start, end = (knee.time_s[[one[k] for one in whole]] for k in (0, 1))
    return KneeCheck(start, end, cycle, *fits)


def rms(error_m: Floats) -> float:
    """Root of the mean square length of error vectors, shape (n, any); NaN for none."""
    return float(np.sqrt(np.mean(np.sum(error_m**2, axis=1)))) if len(error_m) else float("nan")


def _matrices(attitude: Floats) -> Floats:
    """Rotation matrices (n, 3, 3), sensor to world, of unit quaternions (n, 4)."""
    w, x, y, z = attitude.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
