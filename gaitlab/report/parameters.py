"""The parameter tables: one row a parameter, with left, right and both beside each other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from gaitlab.gait.definitions import GROUPS
from gaitlab.report.document import Cell, Note, ParameterRow, ParameterTable, StatusCode
from gaitlab.report.wording import (
    STATUS_LABELS,
    common_decimals,
    interval,
    listed,
    number,
    uncertainty,
    unit_label,
)
from gaitlab.result import Parameter, Result

KEY_PARAMETERS = (
    "walk_time",
    "steady_speed",
    "stride_length",
    "step_length",
    "cadence",
    "stride_time",
    "stance_share",
    "double_support_share",
)
"""What the first page shows, in this order."""

Letters = Mapping[tuple[StatusCode, str], str]

_REASON_LABELS = {"ok": "Assumption", "attention": "Attention", "not_determinable": "Not determinable"}
_NOTE_ORDER = {"not_determinable": 0, "attention": 1, "ok": 2}


def key_names(result: Result) -> tuple[str, ...]:
    """Names on the first page: of a free walk, without the time over a course that nobody asked for."""
    free = result.provenance.settings.get("course_m") is None
    return tuple(name for name in KEY_PARAMETERS if not (free and name == "walk_time"))


def key_table(result: Result) -> ParameterTable:
    """The first page's table, reasons as lettered notes below it; other names: the first parameters there are."""
    names = [name for name in key_names(result) if any(p.name == name for p in result.parameters)]
    names = names or list(dict.fromkeys(p.name for p in result.parameters))[: len(KEY_PARAMETERS)]
    chosen = [p for name in names for p in result.parameters if p.name == name]
    reasons = list(dict.fromkeys((p.status, p.reason) for p in chosen if p.reason))
    letters = {reason: _letter(at) for at, reason in enumerate(reasons)}
    footnotes = tuple(
        Note(status, _REASON_LABELS[status], text, letter) for (status, text), letter in letters.items()
    )
    return ParameterTable("Key values", _rows(chosen, letters), footnotes)


def _letter(at: int) -> str:
    """a to z, then aa, ab …"""
    return (_letter(at // 26 - 1) if at >= 26 else "") + "abcdefghijklmnopqrstuvwxyz"[at % 26]


def group_tables(result: Result) -> tuple[ParameterTable, ...]:
    """All parameters by group: known groups in the order in which people read them, then any other."""
    names = [*GROUPS, *dict.fromkeys(p.group for p in result.parameters if p.group not in GROUPS)]
    by_group = ((name, [p for p in result.parameters if p.group == name]) for name in names)
    return tuple(parameter_table(GROUPS.get(name, name), found) for name, found in by_group if found)


def parameter_table(title: str, parameters: Sequence[Parameter]) -> ParameterTable:
    """Any parameters as one table, reasons with their rows."""
    return ParameterTable(title, _rows(parameters), ())


def _rows(parameters: Sequence[Parameter], letters: Letters | None = None) -> tuple[ParameterRow, ...]:
    """Rows by name; with ``letters`` the reasons stand elsewhere and the cells point to them."""
    names = dict.fromkeys(p.name for p in parameters)
    return tuple(_row([p for p in parameters if p.name == name], letters) for name in names)


def _row(same: Sequence[Parameter], letters: Letters | None) -> ParameterRow:
    first, decimals = same[0], common_decimals(same)
    cells = {p.side: _cell(p, decimals, (letters or {}).get((p.status, p.reason), "")) for p in same}
    return ParameterRow(
        label=first.label,
        unit=unit_label(first.unit),
        definition=first.definition,
        reference=f"Source: {first.reference}" if first.reference else "",
        left=cells.get("left"),
        right=cells.get("right"),
        both=cells.get("both"),
        notes=() if letters is not None else tuple(_notes(same)),
    )


def _cell(parameter: Parameter, decimals: int, note: str) -> Cell:
    label, n = STATUS_LABELS[parameter.status], str(parameter.n)
    if parameter.value is None:
        return Cell(label, "", "", n, "not_determinable", label, note)
    return Cell(
        value=number(parameter.value, decimals),
        uncertainty=uncertainty(parameter.sd, decimals),
        interval=interval(parameter.ci95, decimals),
        n=n,
        status=parameter.status,
        status_label=label,
        note=note,
    )


def _notes(same: Iterable[Parameter]) -> list[Note]:
    """Reasons, each said once with its sides; what is missing first, then reserves, then assumptions."""
    sides: dict[tuple[StatusCode, str], list[str]] = {}
    for parameter in same:
        if parameter.reason:
            sides.setdefault((parameter.status, parameter.reason), []).append(parameter.side)
    notes = []
    for (status, reason), found in sorted(sides.items(), key=lambda item: _NOTE_ORDER[item[0][0]]):
        where = "" if len(sides) == 1 and found == ["both"] else f", {listed(found)}"
        notes.append(Note(status, _REASON_LABELS[status] + where, reason, ""))
    return notes
