"""Recordings of other families: recognised, so that the refusal can say what the file is."""

from __future__ import annotations

import re

from gaitlab.errors import InputError
from gaitlab.recording.decoding import head_text
from gaitlab.recording.file import LIMITS, InputFile
from gaitlab.recording.heading import Header, has_header

_HINT = (
    "Export the recording from MT Manager as text (ASCII), with packet counter, accelerometer and gyroscope."
)
_DOT = re.compile(
    r"^\s*(?:DeviceTag:|SyncStatus:|Measurement Mode:|OutputRate:)", re.IGNORECASE | re.MULTILINE
)
_SENSOR_HEADINGS = re.compile(r"\b(?:Acc|Gyr|FreeAcc)_X\b")
_KNOWN = (
    (re.compile(r"Gyroscope X \(deg/s\)", re.IGNORECASE), "an x-io sensor export"),
    (re.compile(r"(?:left|right)_sensor.*\n.*acc_x", re.IGNORECASE), "a gaitmap table of two sensors"),
    (re.compile(r"<mvnx\b", re.IGNORECASE), "an MVNX file of MVN Analyze"),
    (re.compile(r"^\s*[{\[]"), "a JSON file"),
    (re.compile(r"^\s*<"), "an XML or HTML file"),
)


def is_sensor_text(file: InputFile) -> bool:
    """Does the file carry the header of a sensor recording? Looks at the beginning only."""
    return has_header(head_text(file.content, LIMITS.header_bytes))


def refuse_foreign(file: InputFile, header: Header | None) -> None:
    """Refuse a Movella DOT export, whose table also counts packets."""
    above = "\n".join(header.comments) if header else head_text(file.content, 4096)
    if _DOT.search(above):
        raise InputError(
            "movella_dot",
            "This is a Movella DOT export; gaitlab does not read these yet.",
            _HINT,
            file=file.name,
            line=header.line if header else None,
        )


def not_mt_manager(file: InputFile) -> InputError:
    """The refusal of a text that has no line with ``PacketCounter``: ``missing_columns`` or ``not_mt_manager``."""
    head = head_text(file.content, 4096)
    headings = next(
        (line for line, text in enumerate(head.splitlines(), 1) if _SENSOR_HEADINGS.search(text)), None
    )
    if headings is not None:
        message = "The column PacketCounter is missing; it is the clock of the recording."
        return InputError(
            "missing_columns", message, _HINT, file=file.name, line=headings, column="PacketCounter"
        )
    kind = next((name for pattern, name in _KNOWN if pattern.search(head)), None)
    what = f"This looks like {kind}, not an MT Manager export" if kind else "This is not an MT Manager export"
    return InputError(
        "not_mt_manager",
        f"{what}: no line holds the heading PacketCounter.",
        _HINT,
        file=file.name,
        column="PacketCounter",
    )
