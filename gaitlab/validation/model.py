"""What a validation hands on: rows of figures with what they should reach, the trials behind them, and what failed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Figure:
    """One number of a row: ``MAE 0.84 cm``. ``value`` is NaN where nothing determines it."""

    name: str
    value: float
    unit: str
    decimals: int
    signed: bool = False


@dataclass(frozen=True)
class Goal:
    """What a figure should reach: at least ``low``, at most ``high``, both in the figure's unit."""

    figure: str
    low: float | None = None
    high: float | None = None

    def holds(self, value: float) -> bool:
        """Whether a value reaches it; what is not determined does not."""
        return (
            math.isfinite(value)
            and (self.low is None or value >= self.low)
            and (self.high is None or value <= self.high)
        )


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    key : str
        Stable name for programs.
    what : str
        What is measured against which truth, for people.
    n, of : int and str
        How many of what it rests on.
    target : int or None
        Number of the figure to reach; None for a line that only explains.
    """

    key: str
    what: str
    figures: tuple[Figure, ...]
    n: int
    of: str
    target: int | None = None
    goals: tuple[Goal, ...] = ()

    @property
    def reached(self) -> bool | None:
        """Whether every goal is reached; None where there is none."""
        if not self.goals:
            return None
        return all(goal.holds(self.value(goal.figure)) for goal in self.goals)

    def value(self, figure: str) -> float:
        """The number of that name."""
        return next(one.value for one in self.figures if one.name == figure)


@dataclass(frozen=True)
class Column:
    """A column of the rows behind a table; ``decimals`` None for text."""

    name: str
    unit: str = ""
    decimals: int | None = None


Cell = str | float | int | None


@dataclass(frozen=True)
class Details:
    """The trials, strides or cycles behind some rows."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]


@dataclass(frozen=True)
class Problem:
    """A recording, or a part of one, that could not be used, and why. The others still count."""

    recording: str
    reason: str


@dataclass(frozen=True)
class Table:
    """All that one folder of recordings says.

    Attributes
    ----------
    name : str
        Of the set.
    recordings : int
        How many were found, with those that could not be used.
    """

    name: str
    folder: str
    recordings: int
    rows: tuple[Row, ...]
    details: tuple[Details, ...] = ()
    problems: tuple[Problem, ...] = field(default=())

    def row(self, key: str) -> Row:
        """The row of that name."""
        return next(row for row in self.rows if row.key == key)


@dataclass(frozen=True)
class KnownSet:
    """A set of public recordings: its name, what its files are called, whether a folder holds some, and its table."""

    name: str
    wanted: str
    fits: Callable[[Path], bool]
    validate: Callable[[Path], Table]
