"""One file as it comes in, and what a recording may measure at most."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath

from gaitlab.errors import TooLarge

MIB = 1024 * 1024


@dataclass(frozen=True)
class Limits:
    """What a recording may measure at most; generous for hours of walking, small enough to refuse an attack.

    ``ratio`` is unpacked over packed size of a zip entry; it is asked only of entries above
    ``ratio_floor_bytes``, since a tiny file of blanks packs better than any recording.
    """

    file_bytes: int = 256 * MIB
    folder_bytes: int = 1024 * MIB
    folder_files: int = 1000
    header_bytes: int = 64 * 1024
    line_bytes: int = 16 * 1024
    rows: int = 5_000_000
    columns: int = 64
    zip_entries: int = 200
    unpacked_bytes: int = 1024 * MIB
    ratio: float = 100.0
    ratio_floor_bytes: int = 64 * 1024


LIMITS = Limits()
# Control characters could forge lines in a log; bidirectional marks make a name read as another.
_UNSAFE = re.compile("[\x00-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")


def clean_name(name: str) -> str:
    """The name as a label for people: no folders above it, no control characters, at most 255 characters."""
    return _UNSAFE.sub("\ufffd", name).strip()[:255] or "(no name)"


@dataclass(frozen=True)
class InputFile:
    """One file: its name as given (a label, never used as a path) and its content."""

    name: str
    content: bytes

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", clean_name(self.name))

    def __repr__(self) -> str:
        return f"InputFile({self.name!r}, {len(self.content)} bytes)"

    @cached_property
    def sha256(self) -> str:
        return hashlib.sha256(self.content).hexdigest()

    @property
    def basename(self) -> str:
        return PurePosixPath(self.name.replace("\\", "/")).name

    @property
    def is_zip(self) -> bool:
        return self.content[:4] in (b"PK\x03\x04", b"PK\x05\x06", b"PK\x07\x08") or (
            self.name.lower().endswith(".zip") and bool(self.content)
        )


def check_size(name: str, size: int, limits: Limits = LIMITS) -> None:
    """Refuse a file over the limit."""
    if size > limits.file_bytes:
        raise TooLarge(
            "file_too_large",
            f"The file has {size / MIB:.0f} MiB; at most {limits.file_bytes / MIB:.0f} MiB are read.",
            "Export a shorter part of the recording.",
            file=clean_name(name),
        )
