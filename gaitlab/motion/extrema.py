"""Peaks that stand out from both their neighbours."""

from __future__ import annotations

import numpy as np

from gaitlab.motion.model import Indices
from gaitlab.recording.model import Floats


def prominent_peaks(values: Floats, prominence: float) -> Indices:
    """Rows of the peaks between which ``values``, shape (n,), falls by at least ``prominence``; the ends count as valleys.

    The values rise and fall in zigzag; a fall (and a rise) of less than ``prominence`` belongs to the one around it. Of
    each rise to the next the highest row is the peak, its first one where there are several.
    """
    if not len(values):
        return np.zeros(0, dtype=np.intp)
    rising = values[1:] > values[:-1]
    turning = np.flatnonzero(rising[1:] != rising[:-1]) + 1
    rows = np.concatenate([[0], turning, [len(values) - 1]])
    peaks: list[int] = []
    top, height, bottom = (
        -1,
        0.0,
        -np.inf,
    )  # row and value of the highest since the last valley; the lowest since
    for row, value in zip(
        rows.tolist(), values[rows].tolist(), strict=True
    ):  # plain numbers: the loop is hot
        if top < 0:
            if value >= bottom + prominence:
                top, height = row, value
            elif value < bottom:
                bottom = value
        elif value > height:
            top, height = row, value
        elif value <= height - prominence:
            peaks.append(top)
            top, bottom = -1, value
    if top >= 0:
        peaks.append(top)
    return np.array(peaks, dtype=np.intp)
