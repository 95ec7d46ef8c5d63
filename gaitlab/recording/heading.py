"""The header of an MT Manager text file: comment lines, delimiter, headings and what each column holds."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording.decoding import line_text
from gaitlab.recording.file import LIMITS, Limits

_COUNTER = re.compile(rb"packet[ _]?counter", re.IGNORECASE)
_DELIMITERS = (";", "\t", "|", ",", " ", ":")
_RATE = re.compile(r"(?:rate|frequency)\s*:\s*([0-9]+(?:[.,][0-9]+)?)\s*(?:Hz|$)", re.IGNORECASE)
_DEVICE = re.compile(r"\bDevice\s?Id\s*:\s*([0-9A-F]{6,16})\b", re.IGNORECASE)
_FRAME = re.compile(r"\bCoordinate system\s*:\s*([A-Z]{3})\b", re.IGNORECASE)
_UNIT = re.compile(r"\(([^()]*)\)$|\[([^\[\]]*)\]$")

COUNTER = "packetcounter"
STAMP = "sampletimefine"
ACC = ("acc_x", "acc_y", "acc_z")
GYR = ("gyr_x", "gyr_y", "gyr_z")
MAG = ("mag_x", "mag_y", "mag_z")
FREE_ACC = ("freeacc_x", "freeacc_y", "freeacc_z")
QUATERNION = ("quat_q0", "quat_q1", "quat_q2", "quat_q3")
EULER = ("roll", "pitch", "yaw")
MATRIX = tuple(f"mat[{row}][{column}]" for row in (1, 2, 3) for column in (1, 2, 3))
PRESSURE = ("pressure",)
SPELLING = {
    COUNTER: "PacketCounter",
    STAMP: "SampleTimeFine",
    **{name: name.capitalize()[:-1] + name[-1].upper() for name in (*ACC, *GYR, *MAG)},
    **{name: f"FreeAcc_{name[-1].upper()}" for name in FREE_ACC},
    **{name: name.capitalize() for name in (*QUATERNION, *EULER, *MATRIX, *PRESSURE)},
}
"""The known columns, each with the heading MT Manager gives it."""
_ALIASES = {
    "packet_counter": COUNTER,
    "packet counter": COUNTER,
    "freeacc_e": "freeacc_x",
    "freeacc_n": "freeacc_y",
    "freeacc_u": "freeacc_z",
    "quat_w": "quat_q0",
    "quat_x": "quat_q1",
    "quat_y": "quat_q2",
    "quat_z": "quat_q3",
}


@dataclass(frozen=True)
class Column:
    """One column: heading as written, the name it is known by, and the unit if the heading states one."""

    heading: str
    name: str
    unit: str


@dataclass(frozen=True)
class Header:
    """Where the table begins and how it is written.

    Attributes
    ----------
    line : int
        Line of the headings, counted from 1.
    body : int
        Offset of the first line after them.
    """

    file: str
    comments: tuple[str, ...]
    line: int
    body: int
    delimiter: str
    columns: tuple[Column, ...]

    @cached_property
    def index(self) -> dict[str, int]:
        """Position of each known column; a repeated heading is refused."""
        places: dict[str, int] = {}
        for position, column in enumerate(self.columns):
            if column.name in places and column.name in SPELLING:
                raise InputError(
                    "duplicate_column",
                    f"The heading {column.heading} occurs twice.",
                    "Export the recording again.",
                    file=self.file,
                    line=self.line,
                    column=column.heading,
                )
            places.setdefault(column.name, position)
        return places

    def has(self, names: tuple[str, ...]) -> bool:
        return all(name in self.index for name in names)

    def heading(self, name: str) -> str:
        """The heading as the file writes it, else as MT Manager would."""
        return self.columns[self.index[name]].heading if name in self.index else SPELLING.get(name, name)

    @property
    def rate_hz(self) -> float | None:
        rate_hz = self.stated_hz
        return rate_hz if rate_hz is not None and 1.0 <= rate_hz <= 10_000.0 else None

    @property
    def stated_hz(self) -> float | None:
        """The number that the header gives as the rate, be it possible or not."""
        found = self._comment(_RATE)
        return float(found.replace(",", ".")) if found else None

    @property
    def device(self) -> str | None:
        found = self._comment(_DEVICE)
        return found.upper() if found else None

    @property
    def frame(self) -> str | None:
        """World frame of the device's orientation, such as ENU; None if not said."""
        found = self._comment(_FRAME)
        return found.upper() if found else None

    def _comment(self, pattern: re.Pattern[str]) -> str | None:
        return next((match[1] for match in map(pattern.search, self.comments) if match), None)


def device_in_comments(head: str) -> str | None:
    """The device number that the beginning of a file states."""
    match = _DEVICE.search(head)
    return match[1].upper() if match else None


def has_header(text: str) -> bool:
    """Does this beginning of a file hold a line with a packet counter?"""
    return _COUNTER.search(text.encode("utf-8", errors="replace")) is not None


def find_header(file: str, content: bytes, limits: Limits = LIMITS) -> Header | None:
    """Find the line of headings by ``PacketCounter``, never by counting lines; None where there is none.

    Raises
    ------
    InputError
        ``line_too_long``, ``too_many_columns``, ``duplicate_column``.
    """
    for match in _COUNTER.finditer(content, 0, limits.header_bytes):
        start = content.rfind(b"\n", 0, match.start()) + 1
        end = content.find(b"\n", match.end())
        if content[start:end].lstrip().startswith((b"//", b"#")):
            continue
        if end - start > limits.line_bytes:
            raise TooLarge("line_too_long", "The line of headings is too long.", file=file)
        comments = tuple(line_text(line).strip() for line in content[:start].split(b"\n")[:-1])
        delimiter, columns = _split(line_text(content[start:end]))
        if len(columns) > limits.columns:
            raise TooLarge(
                "too_many_columns",
                f"The table has {len(columns)} columns; at most {limits.columns} are read.",
                "Export one sensor a file.",
                file=file,
                line=len(comments) + 1,
            )
        return Header(file, comments, len(comments) + 1, end + 1, delimiter, columns)
    return None


def _split(line: str) -> tuple[str, tuple[Column, ...]]:
    """Split by the delimiter that gives the most known headings (units inside headings may hold others)."""
    best: tuple[Column, ...] = ()
    best_known, best_delimiter = -1, "\t"
    for delimiter in _DELIMITERS:
        columns = tuple(_column(part) for part in line.split(delimiter))
        known = sum(column.name in SPELLING for column in columns)
        if known > best_known:
            best, best_known, best_delimiter = columns, known, delimiter
    return best_delimiter, best


def _column(heading: str) -> Column:
    heading = heading.strip()
    unit = ""
    bare = heading
    match = _UNIT.search(heading)
    if match is not None and not (match[2] or "").isdigit():  # Mat[1][1] ends in an index, not in a unit
        bare = heading[: match.start()]
        unit = (match[1] or match[2] or "").strip().removeprefix("in ").strip()
    name = bare.strip().lower()
    return Column(heading, _ALIASES.get(name, name), unit)
