"""Columns of a parsed table by name, with the line each row came from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording.heading import Header
from gaitlab.recording.model import Bools, Floats
from gaitlab.recording.table import Table


@dataclass(frozen=True, eq=False)
class Columns:
    """A table's wanted columns.

    Attributes
    ----------
    rows : ndarray (n,) or None
        Rows of the table that are left; None for all.
    """

    header: Header
    table: Table
    place: dict[str, int]
    rows: NDArray[np.intp] | None = None

    @staticmethod
    def of(header: Header, table: Table, names: Sequence[str]) -> Columns:
        return Columns(header, table, {name: place for place, name in enumerate(names)})

    def __contains__(self, name: str) -> bool:
        return name in self.place

    def __len__(self) -> int:
        return len(self.table.values) if self.rows is None else len(self.rows)

    def __getitem__(self, name: str) -> Floats:
        column = self.table.values[:, self.place[name]]
        return column if self.rows is None else column[self.rows]

    def group(self, names: tuple[str, ...]) -> Floats | None:
        """The columns side by side, shape (n, k); None where the file has not all of them."""
        if any(name not in self.place for name in names):
            return None
        first = self.place[names[0]]
        if [self.place[name] for name in names] != list(range(first, first + len(names))):
            return np.stack([self[name] for name in names], axis=1)
        block = self.table.values[:, first : first + len(names)]
        return np.ascontiguousarray(block if self.rows is None else block[self.rows])

    def keep(self, usable: Bools) -> Columns:
        """The same columns with only the rows where ``usable`` holds."""
        kept = np.flatnonzero(usable)
        return Columns(self.header, self.table, self.place, kept if self.rows is None else self.rows[kept])

    def line_of(self, row: int) -> int:
        """Line of a row in the file, counted from 1."""
        return self.table.line_of(row if self.rows is None else int(self.rows[row]))
