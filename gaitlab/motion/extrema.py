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
    change = np.flatnonzero(np.diff(values) != 0.0)
    rising = np.diff(values)[change] > 0.0
    turning = np.flatnonzero(rising[1:] != rising[:-1])
    rows = np.unique(np.concatenate([[0], change[turning] + 1, [len(values) - 1]]))
    peaks: list[int] = []
    top, bottom = -1, -np.inf  # row of the highest since the last valley; the lowest since the last peak
    for row in rows.tolist():
        value = values[row]
        if top < 0:
            if value >= bottom + prominence:
                top = row
            else:
                bottom = min(bottom, value)
        elif value > values[top]:
            top = row
        elif value <= values[top] - prominence:
            peaks.append(top)
            top, bottom = -1, value
    if top >= 0:
        peaks.append(top)
    return np.array(peaks, dtype=np.intp)
