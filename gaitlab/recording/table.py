"""Numbers out of a delimited text table: fast while all is well, and the fault's place only when not."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording.decoding import line_text
from gaitlab.recording.file import LIMITS, Limits, clean_name
from gaitlab.recording.heading import Header
from gaitlab.recording.model import Floats

_CHUNK = 8 * 1024 * 1024
_LINE_FEED = 10
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?inf(inity)?", re.IGNORECASE)
_MISSING = {"", "nan", "-nan", "+nan", "nan(ind)", "-nan(ind)", "n/a", "na", "null", "none",
            "1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind"}  # fmt: skip
_MISSING_SPELLINGS = sorted(
    {form for word in _MISSING for form in (word, word.upper(), word.capitalize())} | {"NaN", "-NaN", "+NaN"}
)


@dataclass(frozen=True, eq=False)
class Table:
    """The wanted columns of a table.

    Attributes
    ----------
    values : ndarray (n_rows, n_wanted)
    lines : ndarray (n_rows,) or None
        Line of each row in the file; None where they follow the headings without a break.
    """

    header: Header
    values: Floats
    lines: NDArray[np.int64] | None

    def line_of(self, row: int) -> int:
        """Line of a row in the file, counted from 1."""
        return int(self.lines[row]) if self.lines is not None else self.header.line + 1 + row


@dataclass(frozen=True)
class _Layout:
    """Where the rows lie and how many fields each has."""

    start: int
    end: int
    n_fields: int
    n_rows: int


def read_table(content: bytes, header: Header, wanted: Sequence[int], limits: Limits = LIMITS) -> Table:
    """Parse the columns at the ascending positions ``wanted``; empty fields and NaN become NaN.

    Raises
    ------
    InputError
        ``no_rows``, ``wrong_field_count``, ``not_a_number``, each with its line.
    TooLarge
        ``too_many_rows``, ``line_too_long``.
    """
    lines = None
    layout = _layout(content, header, limits)
    if layout is None:
        content, lines = _without_blank_lines(content, header)
        header_free = Header(header.file, (), header.line, 0, header.delimiter, header.columns)
        layout = _layout(content, header_free, limits)
        assert layout is not None
    decimal = _decimal_mark(content, header, layout, wanted)
    values = _parse(content, header, layout, wanted, decimal)
    if values is None or len(values) != layout.n_rows:
        raise _bad_number(content, header, layout, wanted, decimal, lines)
    return Table(header, values, lines)


def _layout(content: bytes, header: Header, limits: Limits) -> _Layout | None:
    """Check that every line has as many fields as the first; None where one has not."""
    start, end = header.body, len(content)
    while end > start and content[end - 1] == _LINE_FEED:
        end -= 1
    if end == start:
        raise InputError(
            "no_rows",
            "The table has headings but no rows.",
            "Export the recording again; it may have been stopped before it began.",
            file=header.file,
            line=header.line,
        )
    end += 1
    delimiter = ord(header.delimiter)
    first = content[start : content.find(b"\n", start)]
    n_fields = first.count(header.delimiter.encode()) + 1
    n_rows = 0
    regular = _is_expected(first, header)
    while start < end:
        stop = end if end - start <= _CHUNK else content.rfind(b"\n", start, start + _CHUNK) + 1
        if stop == 0:
            raise _line_too_long(header, header.line + 1 + n_rows)
        rows, same = _count_rows(content, start, stop, delimiter, n_fields, header, n_rows, limits)
        n_rows += rows
        regular = regular and same
        start = stop
        if n_rows > limits.rows:
            raise TooLarge(
                "too_many_rows",
                f"The table has more than {limits.rows} rows.",
                "Export a shorter part of the recording.",
                file=header.file,
            )
    return _Layout(header.body, end, n_fields, n_rows) if regular else None


def _is_expected(line: bytes, header: Header) -> bool:
    """As many fields as headings; a delimiter at the end of the headings or of the rows may differ."""
    fields = line.split(header.delimiter.encode())
    surplus = len(fields) - len(header.columns)
    if surplus == 1:
        return not fields[-1].strip()
    return surplus == 0 or (surplus == -1 and not header.columns[-1].heading)


def _count_rows(
    content: bytes,
    start: int,
    stop: int,
    delimiter: int,
    n_fields: int,
    header: Header,
    before: int,
    limits: Limits,
) -> tuple[int, bool]:
    data = np.frombuffer(content, np.uint8, count=stop - start, offset=start)
    ends_line = data == _LINE_FEED
    marks = np.flatnonzero(ends_line | (data == delimiter))
    n_rows = int(np.count_nonzero(ends_line))
    ends = marks[n_fields - 1 :: n_fields]
    regular = len(marks) == n_rows * n_fields and bool(ends_line[ends].all())
    line_ends = ends if regular else np.flatnonzero(ends_line)
    lengths = np.diff(line_ends, prepend=-1)
    if lengths.max() > limits.line_bytes:
        raise _line_too_long(header, header.line + 1 + before + int(lengths.argmax()))
    return n_rows, regular


def _line_too_long(header: Header, line: int) -> TooLarge:
    return TooLarge(
        "line_too_long",
        "The line is too long to be a row of numbers.",
        "Check that this is a text export of MT Manager.",
        file=header.file,
        line=line,
    )


def _without_blank_lines(content: bytes, header: Header) -> tuple[bytes, NDArray[np.int64]]:
    """Leave out lines of blanks; refuse the first line with a wrong number of fields."""
    delimiter = header.delimiter.encode()
    kept = bytearray()
    numbers: list[int] = []
    n_fields = 0
    for number, line in enumerate(_lines(content, header.body), start=header.line + 1):
        if not line.strip():
            continue
        found = line.count(delimiter) + 1
        if not n_fields and _is_expected(line, header):
            n_fields = found
        if found != n_fields:
            raise InputError(
                "wrong_field_count",
                f"The line has {found} fields where the headings have {len(header.columns)}.",
                "The file was cut off or edited; export the recording again.",
                file=header.file,
                line=number,
            )
        kept += line
        numbers.append(number)
    if not numbers:
        raise InputError(
            "no_rows",
            "The table has headings but no rows.",
            "Export again.",
            file=header.file,
            line=header.line,
        )
    return bytes(kept), np.array(numbers, dtype=np.int64)


def _lines(content: bytes, start: int) -> Iterator[bytes]:
    """The lines from an offset on, one at a time, so that an error in a large file does not double it."""
    stream = io.BytesIO(content)
    stream.seek(start)
    return iter(stream)


def _decimal_mark(content: bytes, header: Header, layout: _Layout, wanted: Sequence[int]) -> str:
    """Comma if the first row's numbers have commas and no points, and fields are not parted by commas."""
    if header.delimiter == ",":
        return "."
    first = content[layout.start : content.find(b"\n", layout.start)].split(header.delimiter.encode())
    numbers = b" ".join(first[position] for position in wanted)
    return "," if b"," in numbers and b"." not in numbers else "."


def _parse(
    content: bytes, header: Header, layout: _Layout, wanted: Sequence[int], decimal: str
) -> Floats | None:
    """The wanted columns by pandas' C parser; None where a field is not a number."""
    settings: dict[str, Any] = {
        "sep": header.delimiter,
        "decimal": decimal,
        "names": range(layout.n_fields),
        "usecols": None if len(wanted) == layout.n_fields else list(wanted),
        "low_memory": len(content) > _CHUNK,
    }
    # First without looking for missing values: most files have none, and it saves a third of the time.
    values = _parse_once(content, layout, {**settings, "na_filter": False})
    if values is None:
        missing = {"na_values": _MISSING_SPELLINGS, "skipinitialspace": header.delimiter != " "}
        values = _parse_once(content, layout, {**settings, **missing})
    return values


def _parse_once(content: bytes, layout: _Layout, settings: dict[str, Any]) -> Floats | None:
    import pandas as pd  # heavy; whoever only wants the model does not pay for it

    stream = io.BytesIO(content)
    stream.seek(layout.start)
    fixed: dict[str, Any] = {
        "engine": "c",
        "header": None,
        "index_col": False,
        "quoting": csv.QUOTE_NONE,
        "keep_default_na": False,
    }
    try:
        frame: pd.DataFrame = pd.read_csv(stream, dtype=np.float64, **fixed, **settings)
    except (ValueError, OverflowError, pd.errors.ParserError):
        return None
    return np.asarray(frame.to_numpy(), dtype=np.float64)


def _bad_number(
    content: bytes, header: Header, layout: _Layout, wanted: Sequence[int], decimal: str,
    lines: NDArray[np.int64] | None,
) -> InputError:  # fmt: skip
    """Search line by line for the field that the fast parser stumbled over."""
    delimiter = header.delimiter.encode()
    for row, line in enumerate(_lines(content, layout.start)):
        fields = line.split(delimiter)
        if len(fields) < layout.n_fields:
            break  # the lines of line feeds at the end
        for position in wanted:
            token = line_text(fields[position]).strip()
            number = token.replace(",", ".") if decimal == "," and "." not in token else token
            if not _NUMBER.fullmatch(number) and token.lower() not in _MISSING:
                return InputError(
                    "not_a_number",
                    f"“{clean_name(token)[:40]}” is not a number.",
                    "Correct the field or export the recording again.",
                    file=header.file,
                    line=int(lines[row]) if lines is not None else header.line + 1 + row,
                    column=header.columns[position].heading,
                )
    return InputError(
        "unreadable_table",
        "The table cannot be read as numbers.",
        "Export the recording again.",
        file=header.file,
    )
