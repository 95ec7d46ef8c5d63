"""Files as they come in: from disk, from a folder, out of a zip; bounded before anything is parsed."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath

from gaitlab.errors import InputError, TooLarge

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
PLACEMENT_FILE = "placement.json"
_TEXT_SUFFIXES = {".txt", ".csv", ".tsv"}
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


def load(paths: Iterable[Path | str], limits: Limits = LIMITS) -> list[InputFile]:
    """Read files, and of each folder the text files and ``placement.json`` that lie directly in it.

    Raises
    ------
    InputError
        ``no_such_file``, ``unreadable_file``.
    TooLarge
        ``file_too_large``, ``folder_too_large``.
    """
    files: list[InputFile] = []
    for path in map(Path, paths):
        if path.is_dir():
            files += _load_folder(path, limits)
        else:
            files.append(_load_file(path, limits))
    return files


def expand(files: Sequence[InputFile], limits: Limits = LIMITS) -> list[InputFile]:
    """Replace each zip by the files in it, unpacked in memory; leave the others as they are.

    Raises
    ------
    InputError, TooLarge
        As :func:`gaitlab.recording.archive.unpack`, and ``file_too_large``.
    """
    from gaitlab.recording.archive import unpack  # zipfile is not needed to read plain files

    expanded: list[InputFile] = []
    for file in files:
        check_size(file.name, len(file.content), limits)
        expanded += unpack(file, limits) if file.is_zip else [file]
    return expanded


def check_size(name: str, size: int, limits: Limits = LIMITS) -> None:
    """Refuse a file over the limit."""
    if size > limits.file_bytes:
        raise TooLarge(
            "file_too_large",
            f"The file has {size / MIB:.0f} MiB; at most {limits.file_bytes / MIB:.0f} MiB are read.",
            "Export a shorter part of the recording.",
            file=clean_name(name),
        )


def _load_file(path: Path, limits: Limits) -> InputFile:
    try:
        check_size(path.name, path.stat().st_size, limits)
        return InputFile(path.name, path.read_bytes())
    except FileNotFoundError:
        raise InputError(
            "no_such_file", "There is no such file.", "Check the path.", file=clean_name(path.name)
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a file"
        raise InputError(
            "unreadable_file",
            f"The file cannot be read ({reason}).",
            "Check the path and the permissions.",
            file=clean_name(path.name),
        ) from None


def _load_folder(folder: Path, limits: Limits) -> list[InputFile]:
    try:
        inside = sorted(path for path in folder.iterdir() if not path.name.startswith(".") and path.is_file())
        wanted = [p for p in inside if p.suffix.lower() in _TEXT_SUFFIXES or p.name.lower() == PLACEMENT_FILE]
        total = sum(path.stat().st_size for path in wanted)
    except OSError as error:
        raise InputError(
            "unreadable_file",
            f"The folder cannot be read ({error.strerror}).",
            "Check the permissions.",
            file=clean_name(folder.name),
        ) from None
    if len(wanted) > limits.folder_files or total > limits.folder_bytes:
        raise TooLarge(
            "folder_too_large",
            f"The folder holds {len(wanted)} text files of {total / MIB:.0f} MiB together.",
            "Put the files of one trial into a folder of their own, or name them with --left-foot and so on.",
            file=clean_name(folder.name),
        )
    return [_load_file(path, limits) for path in wanted]
