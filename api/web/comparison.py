"""Every published method on a trial, beside ours."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from api.call import CurrentCall
from api.guard import GuardedRoute
from api.params import Id
from api.policy import person
from api.web.forms import Typed, decimal
from api.web.templates import page
from gaitlab.clinic import comparisons
from gaitlab.clinic.access import Permission
from gaitlab.comparison.comparing import LONGEST_WALK_M, SHORTEST_WALK_M
from gaitlab.comparison.model import Answer, Comparison, Line, is_ours
from gaitlab.comparison.text import difference_text, number
from gaitlab.recording import Side

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

_RANGE = re.compile(r"(?<=\d)–(?=\d)")
_NO_LENGTH = f"This must be a number from {SHORTEST_WALK_M:g} to {LONGEST_WALK_M:g}."


@dataclass(frozen=True)
class Row:
    """A method that ran: its answers for left and right."""

    line: Line
    ours: bool
    answers: tuple[tuple[str, Answer | None], ...]
    difference: str
    time: str


@dataclass(frozen=True)
class Table:
    """A question; ``of`` is what its differences are of, ``left_out`` the methods that did not run, by reason."""

    title: str
    of: str
    rows: tuple[Row, ...]
    left_out: dict[str, list[str]]


def question_tables(comparison: Comparison) -> list[Table]:
    """The tables as the page shows them."""
    tables = []
    for table in comparison.tables:
        left_out: dict[str, list[str]] = {}
        for line in table.lines:
            if not line.answers:
                left_out.setdefault(line.reason, []).append(line.method.name)
        rows = tuple(_row(line) for line in table.lines if line.answers)
        of = next((line.difference.of for line in table.lines if line.difference is not None), "")
        tables.append(Table(table.question.value.capitalize(), of, rows, left_out))
    return tables


def _row(line: Line) -> Row:
    answers = tuple((side.value, line.answer(side)) for side in Side)
    return Row(
        line,
        is_ours(line.method),
        answers,
        difference_text(line.difference),
        f"{1000.0 * line.seconds:.1f} ms",
    )


@router.get("/trials/{trial_id}/compare")
@person(Permission.SESSION_READ)
def show(trial_id: Id, call: CurrentCall, length: Annotated[str, Query(max_length=40)] = "") -> Response:
    known_m, error = _length(length.strip())
    form = Typed({"length": length.strip()}, {"length": error} if error else {})
    with call.desk() as desk:
        found = comparisons.compare_trial(desk, trial_id, known_m)
    return page(
        call,
        "sessions/compare.html",
        found=found,
        comparison=found.comparison,
        figures=found.figures(),
        tables=question_tables(found.comparison),
        form=form,
        number=number,
        unbroken=unbroken,
    )


def unbroken(text: str) -> str:
    """The text with its ranges (``7–8``) each on one line."""
    return _RANGE.sub("\u2060–\u2060", text)


def _length(text: str) -> tuple[float | None, str]:
    """Metres as typed, and what is wrong with them; None where nothing was typed."""
    if not text:
        return None, ""
    try:
        metres = float(decimal(text) or "nan")
    except ValueError:
        metres = math.nan
    return (metres, "") if SHORTEST_WALK_M <= metres <= LONGEST_WALK_M else (None, _NO_LENGTH)
