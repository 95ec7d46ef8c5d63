"""Many stretches of rows at once: the highest row, the crossing of a level, the centre of mass in each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gaitlab.motion.model import Indices
from gaitlab.recording.model import Bools, Floats

_NONE = np.iinfo(np.intp).max


@dataclass(frozen=True, eq=False)
class Windows:
    """Stretches ``[start, end)`` of rows, none empty, shape (m,) each.

    Results have one entry a window; rows that are not whole lie between two samples, NaN where there is no such row.
    Levels are one for each window.
    """

    start: Indices
    end: Indices

    @cached_property
    def length(self) -> Indices:
        """Rows in each window."""
        return self.end - self.start

    @cached_property
    def first(self) -> Indices:
        """Where each window begins among the rows of all laid end to end."""
        return np.cumsum(self.length) - self.length

    @cached_property
    def rows(self) -> Indices:
        """Rows of all windows laid end to end."""
        return np.arange(int(self.length.sum())) + np.repeat(self.start - self.first, self.length)

    def highest(self, values: Floats) -> Indices:
        """Row of the highest value, the first where there are several."""
        inside = values[self.rows]
        top = np.repeat(np.maximum.reduceat(inside, self.first), self.length)
        return self._earliest(inside == top)

    def first_below(self, values: Floats, level: Floats) -> Floats:
        """Where the values first come down through the level."""
        below = values[self.rows] < np.repeat(level, self.length)
        return _between(values, self._earliest(below), self.start, level)

    def first_above(self, values: Floats, level: Floats) -> Floats:
        """Where the values first come up through the level."""
        above = values[self.rows] > np.repeat(level, self.length)
        return _between(values, self._earliest(above), self.start, level)

    def centre(self, weights: Floats) -> Floats:
        """Mean row, weighted."""
        inside = weights[self.rows]
        total = np.add.reduceat(inside, self.first)
        moment = np.add.reduceat(inside * self.rows, self.first)
        return np.asarray(np.divide(moment, total, out=np.full(len(total), np.nan), where=total > 0.0))

    def _earliest(self, mask: Bools) -> Indices:
        """First row of each window where the mask is true, −1 where it is nowhere."""
        found = np.minimum.reduceat(np.where(mask, self.rows, _NONE), self.first)
        return np.where(found == _NONE, -1, found)


def _between(values: Floats, row: Indices, start: Indices, level: Floats) -> Floats:
    """Where the values pass the level between the row before and this one; NaN where there is none."""
    known = row > start
    after = np.where(known, row, 1)
    low, high = values[after - 1], values[after]
    step = np.where(high == low, 1.0, high - low)
    return np.where(known, after - 1 + (level - low) / step, np.nan)


def refined(values: Floats, row: Indices) -> Floats:
    """Vertex of the parabola through the values at each row, a maximum or minimum, and its neighbours."""
    middle = np.clip(row, 1, len(values) - 2)
    before, here, after = values[middle - 1], values[middle], values[middle + 1]
    bend = before - 2.0 * here + after
    shift = np.divide(0.5 * (before - after), bend, out=np.zeros(len(row)), where=bend != 0.0)
    return np.asarray(row + np.where(row == middle, np.clip(shift, -0.5, 0.5), 0.0))
