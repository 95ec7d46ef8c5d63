"""What a report says: every word and number as the reader sees it, once, for page and paper alike.

``build_report`` (in ``build.py``) does all wording and rounding; templates only lay out. So HTML and PDF cannot
differ in a number. All texts are plain text: nothing in them is markup.
"""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass
from typing import Literal

from gaitlab.report.figures.model import Figure
from gaitlab.result import Result
from gaitlab.series import Series

StatusCode = Literal["ok", "attention", "not_determinable"]


@dataclass(frozen=True)
class Subject:
    """The person, as far as the reader of this report may know them."""

    code: str = ""
    sex: str = ""
    birth_year: int | None = None
    height_m: float | None = None
    weight_kg: float | None = None
    leg_length_m: float | None = None
    diagnosis: str = ""
    note: str = ""


@dataclass(frozen=True)
class SessionInfo:
    """The session: when, which test (``t25fw``, ``10mwt`` or ``walk``), over which course, where."""

    date: dt.date | None = None
    test: str = ""
    course_m: float | None = None
    note: str = ""
    site: str = ""


@dataclass(frozen=True, eq=False)
class TrialReport:
    """What a report is made from: one trial's result and the series behind it."""

    number: int
    result: Result
    series: Series


@dataclass(frozen=True)
class Fact:
    """A label and what is known under it."""

    label: str
    value: str


@dataclass(frozen=True)
class Cell:
    """One value: ``1.31``, ``± 0.02``, ``1.28 to 1.34``, ``14``; empty where there is no such thing.

    ``note`` is the letter of a note under the table.
    """

    value: str
    uncertainty: str
    interval: str
    n: str
    status: StatusCode
    status_label: str
    note: str


@dataclass(frozen=True)
class Note:
    """Why values want attention or are missing, or the assumption they rest on; ``letter`` where cells point to it."""

    status: StatusCode
    label: str
    text: str
    letter: str


@dataclass(frozen=True)
class ParameterRow:
    """A parameter with its values left, right and both; None where it has no value of that kind."""

    label: str
    unit: str
    definition: str
    reference: str
    left: Cell | None
    right: Cell | None
    both: Cell | None
    notes: tuple[Note, ...]


@dataclass(frozen=True)
class ParameterTable:
    """Parameters that belong together; ``footnotes`` where the reasons do not stand with the rows."""

    title: str
    rows: tuple[ParameterRow, ...]
    footnotes: tuple[Note, ...]


@dataclass(frozen=True)
class SensorRow:
    """How good one sensor's recording is, and the evidence for it."""

    label: str
    device: str
    samples: str
    lost: str
    saturated: str
    rests: str
    residual: str


@dataclass(frozen=True)
class FileRow:
    """A raw file by placement, name and hash."""

    placement: str
    name: str
    sha256: str


@dataclass(frozen=True)
class StrideRow:
    """A stride that is not valid as it is, and why."""

    foot: str
    time: str
    length: str
    status: StatusCode
    label: str
    reason: str


@dataclass(frozen=True)
class Verdict:
    """May this trial be used? In a word, in a sentence, and with the reasons where it is not simply valid."""

    status: StatusCode
    label: str
    text: str
    reasons: tuple[str, ...] = ()


@dataclass(frozen=True)
class TrialSection:
    """Everything about one trial. ``heading`` is empty where the report has a single one."""

    number: int
    heading: str
    verdict: Verdict
    summary: tuple[str, ...]
    key: ParameterTable
    groups: tuple[ParameterTable, ...]
    walk: tuple[Fact, ...]
    overview_figures: tuple[Figure, ...]
    figure_pairs: tuple[tuple[Figure, ...], ...]
    sensors: tuple[SensorRow, ...]
    headings: tuple[str, ...]
    strides: tuple[StrideRow, ...]
    warnings: tuple[str, ...]
    provenance: tuple[Fact, ...]
    files: tuple[FileRow, ...]
    command: str
    attachment: str


@dataclass(frozen=True)
class Comparison:
    """Key values of all trials beside each other: a heading a column, then (label, values…) a row."""

    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Attachment:
    """A file that goes with the report."""

    name: str
    text: str
    description: str


@dataclass(frozen=True)
class Report:
    """A whole report, ready to be laid out.

    ``fingerprint`` is the SHA-256 of the attached result (of several: of their hashes in order, one a line);
    ``pooled`` is what only all trials together tell; ``legend`` explains the tables, ``frame`` the figures' axes,
    ``residual_note`` the evidence of rests;
    ``created_at`` is kept for the PDF's metadata.
    """

    title: str
    person: str
    occasion: str
    subject: tuple[Fact, ...]
    session: tuple[Fact, ...]
    trials: tuple[TrialSection, ...]
    comparison: Comparison | None
    pooled: ParameterTable | None
    legend: tuple[str, ...]
    frame: str
    residual_note: str
    created: str
    created_at: dt.datetime
    fingerprint: str
    attachments: tuple[Attachment, ...]
