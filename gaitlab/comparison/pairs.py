"""Differences between what two methods say of the same strides or rests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from gaitlab.comparison.model import Difference
from gaitlab.gait.measurement import TWO_SIDED_95
from gaitlab.motion.model import Indices
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class Compared:
    """What the pairs of a question are, and in which unit they are shown: ``scale`` units in one of SI."""

    of: str
    pairs: str
    unit: str
    scale: float
    decimals: int


@dataclass(frozen=True, eq=False)
class Pairs:
    """Method less ours, shape (m,), SI; and the standard uncertainty that all of ours share."""

    difference: Floats
    ours_sd: float


def difference_of(what: Compared, sides: list[Pairs]) -> Difference:
    """Mean difference over the pairs of both feet, ± t·s/√m and what ours shares, in quadrature.

    The scatter of the differences holds the independent part of our own uncertainty; the shared part (scale, drift) would
    be the same in all of them, so it is added.
    """
    known = [one.difference[np.isfinite(one.difference)] for one in sides]
    all_pairs = np.concatenate([*known, np.zeros(0)])
    n = len(all_pairs)
    mean = float(all_pairs.mean()) if n else np.nan
    half = np.nan
    if n > 1:
        counts = np.array([len(one) for one in known])
        shared = float(counts @ [one.ours_sd for one in sides]) / n
        spread = float(stdtrit(n - 1, 0.975)) * float(all_pairs.std(ddof=1)) / np.sqrt(n)
        half = float(np.hypot(spread, TWO_SIDED_95 * shared))
    return Difference(what.of, what.scale * mean, what.scale * half, n, what.pairs, what.unit, what.decimals)


def nearest_pairs(found_s: Floats, ours_s: Floats, within_s: float) -> tuple[Indices, Indices]:
    """Instants that are each other's nearest and no further apart than ``within_s``: indices of found and of ours, (m,)."""
    if not len(found_s) or not len(ours_s):
        return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
    of_found, of_ours = _nearest(found_s, ours_s), _nearest(ours_s, found_s)
    rows = np.arange(len(found_s))
    mutual = (of_ours[of_found] == rows) & (np.abs(ours_s[of_found] - found_s) <= within_s)
    return rows[mutual], of_found[mutual]


def _nearest(at: Floats, among: Floats) -> Indices:
    """Index of the nearest of ascending values for each."""
    after = np.clip(np.searchsorted(among, at), 0, len(among) - 1)
    before = np.maximum(after - 1, 0)
    return np.where(np.abs(among[before] - at) <= np.abs(among[after] - at), before, after)
