"""A result laid out for the session page, in the report's own words and digits: the two cannot differ."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.report.document import ParameterRow
from gaitlab.report.parameters import group_tables
from gaitlab.report.wording import decimals_for, number, uncertainty, unit_label
from gaitlab.result import Parameter, Result

SUMMARY = (
    ("walk_time",),
    ("steady_speed", "stride_velocity", "walk_speed"),
    ("stride_length",),
    ("cadence",),
)
"""What stands at the top of a session: of each line the first that this result knows a value of."""

_WORST_FIRST = ("not_determinable", "attention", "ok")


@dataclass(frozen=True)
class Tile:
    """One number of the summary."""

    label: str
    value: str
    uncertainty: str
    unit: str
    side: str
    status: str
    reason: str


@dataclass(frozen=True)
class Mark:
    """A value and its 95 % interval in the small drawing beside it, in hundredths of its width."""

    side: str
    at: float
    low: float
    high: float


@dataclass(frozen=True)
class Row:
    """A parameter: the report's row, the worst status of its sides, and left and right on one scale."""

    cells: ParameterRow
    status: str
    marks: tuple[Mark, ...]


@dataclass(frozen=True)
class Table:
    """A named group of parameters."""

    title: str
    rows: tuple[Row, ...]


def summary(result: Result) -> list[Tile]:
    """The few numbers that answer the first question; a side is named where there is no value of both."""
    tiles = []
    for names in SUMMARY:
        known = [p for name in names for p in result.parameters if p.name == name]
        known.sort(key=lambda p: (p.value is None, names.index(p.name), p.side != "both"))
        if known:
            tiles += [_tile(p) for p in _same_kind(known)]
    return tiles


def _same_kind(known: list[Parameter]) -> list[Parameter]:
    """The best one; where it is one side's, the other side's of the same name with it."""
    best = known[0]
    if best.side == "both" or best.value is None:
        return [best]
    return [p for p in known if p.name == best.name and p.value is not None]


def _tile(parameter: Parameter) -> Tile:
    decimals = decimals_for(parameter.sd, parameter.decimals)
    missing = parameter.value is None
    return Tile(
        label=parameter.label,
        value="" if parameter.value is None else number(parameter.value, decimals),
        uncertainty="" if missing else uncertainty(parameter.sd, decimals),
        unit=unit_label(parameter.unit),
        side=parameter.side,
        status=parameter.status,
        reason=parameter.reason if parameter.status != "ok" else "",
    )


def parameter_tables(result: Result) -> list[Table]:
    """All parameters by group."""
    by_label: dict[tuple[str, str], Parameter] = {(p.label, p.side): p for p in result.parameters}
    return [
        Table(table.title, tuple(Row(row, _status(row), _marks(row.label, by_label)) for row in table.rows))
        for table in group_tables(result)
    ]


def _status(row: ParameterRow) -> str:
    found = {cell.status for cell in (row.left, row.right, row.both) if cell is not None}
    return next(status for status in _WORST_FIRST if status in found)


def _marks(label: str, parameters: dict[tuple[str, str], Parameter]) -> tuple[Mark, ...]:
    """Left and right with their intervals on one scale; nothing where one of them is missing."""
    spans = []
    for side in ("left", "right"):
        parameter = parameters.get((label, side))
        if parameter is None or parameter.value is None or parameter.ci95 is None:
            return ()
        spans.append((side, parameter.value, *parameter.ci95))
    low, high = min(span[2] for span in spans), max(span[3] for span in spans)
    if not high > low:
        return ()

    def place(value: float) -> float:
        return round(6 + 88 * (value - low) / (high - low), 1)

    return tuple(Mark(side, place(at), place(start), place(end)) for side, at, start, end in spans)
