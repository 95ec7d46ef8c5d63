"""Tables as text for people and as JSON for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence

from gaitlab import __version__
from gaitlab.validation.model import Cell, Column, Details, Figure, Goal, Row, Table

SCHEMA = "gaitlab.validation/1"
HEADINGS = ("#", "what", "ours", "n", "to reach", "reached")


def to_text(tables: Sequence[Table], *, trials: bool = False) -> str:
    """All tables; with ``trials`` also the rows behind each."""
    parts = []
    for table in tables:
        noun = "recording" if table.recordings == 1 else "recordings"
        lines = [f"{table.name}: {table.recordings} {noun} in {table.folder}", ""]
        lines += _aligned([HEADINGS, *(_row(row) for row in table.rows)], right=(0, 3))
        lines += [f"! {problem.recording}: {problem.reason}" for problem in table.problems]
        if trials:
            for details in table.details:
                lines += ["", f"{table.name}, {details.title}", "", *_details(details)]
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _row(row: Row) -> tuple[str, ...]:
    reached = {None: "", True: "yes", False: "no"}[row.reached]
    target = "" if row.target is None else str(row.target)
    goals = ", ".join(_goal(goal, row) for goal in row.goals)
    of = row.of.removesuffix("s") if row.n == 1 else row.of
    return target, row.what, ", ".join(_figures(row.figures)), f"{row.n} {of}", goals, reached


def _figures(figures: Sequence[Figure]) -> list[str]:
    """Each as ``MAE 0.84 cm``; a mean and the standard deviation after it as ``+0.21 ± 1.10 cm``."""
    texts: list[str] = []
    before: Figure | None = None
    for one in figures:
        if one.name == "SD" and before is not None and before.name == "mean":
            mean = number(before.value, before.decimals, signed=True)
            texts[-1] = f"{mean} ± {number(one.value, one.decimals)} {one.unit}"
        else:
            texts.append(_figure(one))
        before = one
    return texts


def _figure(one: Figure) -> str:
    value = number(one.value, one.decimals, signed=one.signed)
    return " ".join(part for part in (one.name, value, one.unit) if part)


def _goal(goal: Goal, row: Row) -> str:
    unit = next(one.unit for one in row.figures if one.name == goal.figure)
    if goal.low is not None and goal.high is not None:
        limits = f"{goal.low:g}–{goal.high:g}"
    elif goal.high is not None:
        limits = f"≤ {goal.high:g}"
    else:
        limits = f"≥ {goal.low:g}"
    return f"{goal.figure} {limits} {unit}".strip()


def number(value: float, decimals: int, *, signed: bool = False) -> str:
    """With fixed decimals; a dash where nothing determines it, and no minus before a zero."""
    if not math.isfinite(value):
        return "–"
    rounded = round(value, decimals) + 0.0
    return f"{rounded:+.{decimals}f}" if signed else f"{rounded:.{decimals}f}"


def _details(details: Details) -> list[str]:
    heads = tuple(f"{one.name} [{one.unit}]" if one.unit else one.name for one in details.columns)
    cells = [
        tuple(_cell(value, column) for value, column in zip(row, details.columns, strict=True))
        for row in details.rows
    ]
    right = tuple(k for k, one in enumerate(details.columns) if one.decimals is not None)
    return _aligned([heads, *cells], right)


def _cell(value: Cell, column: Column) -> str:
    if value is None:
        return "–"
    return value if isinstance(value, str) else number(value, column.decimals or 0)


def _aligned(rows: Sequence[Sequence[str]], right: Sequence[int]) -> list[str]:
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [
            text.rjust(width) if k in right else text.ljust(width)
            for k, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return lines


def to_json(tables: Sequence[Table], *, trials: bool = False) -> str:
    """The same as JSON; numbers rounded to two decimals more than in the text, null where nothing determines them."""
    document = {
        "schema": SCHEMA,
        "gaitlab": __version__,
        "sets": [_table_json(table, trials) for table in tables],
    }
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def _table_json(table: Table, trials: bool) -> dict[str, object]:
    found: dict[str, object] = {
        "set": table.name,
        "folder": table.folder,
        "recordings": table.recordings,
        "rows": [_row_json(row) for row in table.rows],
        "problems": [{"recording": one.recording, "reason": one.reason} for one in table.problems],
    }
    if trials:
        found["trials"] = {details.title: _details_json(details) for details in table.details}
    return found


def _row_json(row: Row) -> dict[str, object]:
    return {
        "target": row.target,
        "key": row.key,
        "what": row.what.strip(),
        "figures": {
            one.name: {"value": _rounded(one.value, one.decimals), "unit": one.unit} for one in row.figures
        },
        "n": row.n,
        "of": row.of,
        "to_reach": {goal.figure: {"low": goal.low, "high": goal.high} for goal in row.goals},
        "reached": row.reached,
    }


def _details_json(details: Details) -> list[dict[str, object]]:
    names = [f"{one.name} [{one.unit}]" if one.unit else one.name for one in details.columns]
    return [
        {
            name: _rounded(value, column.decimals or 0) if isinstance(value, float) else value
            for name, value, column in zip(names, row, details.columns, strict=True)
        }
        for row in details.rows
    ]


def _rounded(value: float, decimals: int) -> float | None:
    return round(value, decimals + 2) + 0.0 if math.isfinite(value) else None
