"""Tables in the form of the papers, and how they are written."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass

from gaitlab import __version__
from gaitlab.validation.model import Cell, Column, Problem
from gaitlab.validation.text import number

SCHEMA = "gaitlab.methods/1"
PAPER = Column("paper")


@dataclass(frozen=True)
class PaperTable:
    """A table beside the paper's own figures.

    Attributes
    ----------
    key : str
        Stable name for programs.
    title : str
        Which table of which paper.
    note : str
        What is counted here on which recordings, and what the paper had.
    """

    key: str
    title: str
    note: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def cell(self, name: str, column: str) -> Cell:
        """The entry of a method's row (its first column) in a column."""
        k = [one.name for one in self.columns].index(column)
        return next(row[k] for row in self.rows if row[0] == name)


def _cell(value: Cell, column: Column) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else number(float(value), column.decimals or 0)


def _head(column: Column) -> str:
    return f"{column.name} [{column.unit}]" if column.unit else column.name


def _rows(table: PaperTable) -> list[list[str]]:
    heads = [_head(column) for column in table.columns]
    return [heads] + [
        [_cell(value, column) for value, column in zip(row, table.columns, strict=True)] for row in table.rows
    ]


def tables_text(tables: Sequence[PaperTable], problems: Sequence[Problem]) -> str:
    """For a terminal."""
    parts = []
    for table in tables:
        rows = _rows(table)
        widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
        lines = [table.title, table.note, ""]
        for row in rows:
            cells = [
                text.ljust(width) if column.decimals is None else text.rjust(width)
                for text, width, column in zip(row, widths, table.columns, strict=True)
            ]
            lines.append("  ".join(cells).rstrip())
        parts.append("\n".join(lines))
    told = "".join(f"! {one.recording}: {one.reason}\n" for one in problems)
    return "\n\n".join(parts) + "\n" + told


def tables_markdown(tables: Sequence[PaperTable], problems: Sequence[Problem], command: str) -> str:
    """A page: the command that made it, then each table under its heading."""
    parts = [
        "# Published methods on public recordings",
        (
            f"Made by `{command}`, gaitlab {__version__}; not written by hand. `gaitlab methods NAME` tells of each method"
            " its reference, its constants and each deviation from its paper; `gaitlab compare` runs all of them on a"
            " recording of your own."
        ),
    ]
    for table in tables:
        head, *rows = _rows(table)
        rule = ["---" if column.decimals is None else "--:" for column in table.columns]
        lines = [f"| {' | '.join(cells)} |" for cells in (head, rule, *rows)]
        parts += [f"## {table.title}", table.note, "\n".join(lines)]
    parts += [f"- {one.recording}: {one.reason}" for one in problems]
    return "\n\n".join(parts) + "\n"


def tables_json(tables: Sequence[PaperTable], problems: Sequence[Problem]) -> str:
    """For programs; null where nothing determines a number."""

    def plain(value: Cell) -> Cell:
        return None if isinstance(value, float) and not math.isfinite(value) else value

    document = {
        "schema": SCHEMA,
        "gaitlab": __version__,
        "tables": {
            table.key: {
                "title": table.title,
                "note": table.note,
                "rows": [
                    {_head(column): plain(value) for column, value in zip(table.columns, row, strict=True)}
                    for row in table.rows
                ],
            }
            for table in tables
        },
        "problems": [{"recording": one.recording, "reason": one.reason} for one in problems],
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
