"""Files as they come in: from disk, from a folder, out of a zip; bounded before anything is parsed."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Sequence
from pathlib import Path

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording.file import LIMITS, MIB, InputFile, Limits, check_size, clean_name

PLACEMENT_FILE = "placement.json"
_TEXT_SUFFIXES = {".txt", ".csv", ".tsv"}


def load(paths: Iterable[Path | str], limits: Limits = LIMITS) -> list[InputFile]:
    """Read files, and of each folder the text files and ``placement.json`` that lie directly in it.

    Raises
    ------
    InputError
        ``no_such_file``, ``not_a_file`` (a device, a pipe), ``unreadable_file``.
    TooLarge
        ``file_too_large``, ``folder_too_large``.
    """
    files: list[InputFile] = []
    for path in map(Path, paths):
        if os.path.isdir(path):  # noqa: PTH112 is_dir raises for a path too long
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


def _load_file(path: Path, limits: Limits) -> InputFile:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # a pipe may never end
            raise InputError(
                "not_a_file",
                "This is a device or a pipe, not a file.",
                "Save the recording as a file and give its path.",
                file=clean_name(str(path)),
            )
        check_size(str(path), status.st_size, limits)
        return InputFile(path.name, path.read_bytes())
    except FileNotFoundError:
        raise InputError(
            "no_such_file", "There is no such file.", "Check the path.", file=clean_name(str(path))
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a file"
        raise InputError(
            "unreadable_file",
            f"The file cannot be read ({reason}).",
            "Check the path and the permissions.",
            file=clean_name(str(path)),
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
            file=clean_name(str(folder)),
        ) from None
    if len(wanted) > limits.folder_files or total > limits.folder_bytes:
        raise TooLarge(
            "folder_too_large",
            f"The folder holds {len(wanted)} text files of {total / MIB:.0f} MiB together.",
            "Put the files of one trial into a folder of their own, or name them with --left-foot and so on.",
            file=clean_name(str(folder)),
        )
    return [_load_file(path, limits) for path in wanted]
