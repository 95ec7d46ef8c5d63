"""Folders and files of a validation set: listed, read, and refused in words."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording.file import InputFile, clean_name
from gaitlab.recording.intake import load
from gaitlab.recording.model import Floats


def files_in(folder: Path) -> list[Path]:
    """Files that lie directly in a folder, sorted by name.

    Raises
    ------
    InputError
        Where there is no such folder.
    """
    try:
        return sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no usable path"
        raise InputError(
            "no_such_folder",
            f"The folder cannot be read ({reason}).",
            "Give the folder of the recordings.",
            file=clean_name(str(folder)),
        ) from None


def folders_in(folder: Path) -> list[Path]:
    """The folder itself and the folders directly in it."""
    files_in(folder)
    return [folder, *sorted(one for one in folder.iterdir() if one.is_dir() and not one.name.startswith("."))]


def not_this_set(name: str, folder: Path, wanted: str) -> InputError:
    """The refusal of a folder that holds none of the recordings of a set."""
    found = [path.name for path in files_in(folder)]
    shown = ", ".join(found[:6]) + (f" and {len(found) - 6} more" if len(found) > 6 else "")
    return InputError(
        "not_this_set",
        f"Nothing of {name} is here. Looked for: {wanted}. Found: {shown or 'no file'}.",
        "Give the folder in which these files lie.",
        file=clean_name(str(folder)),
    )


def read_file(path: Path) -> InputFile:
    """One file, bounded like any other input."""
    return load([path])[0]


def read_json(path: Path) -> Mapping[str, object]:
    """A JSON object."""
    try:
        value = json.loads(read_file(path).content.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        raise InputError("not_json", "It is not valid JSON.", "Export it again.", file=path.name) from None
    if not isinstance(value, dict):
        raise InputError("not_json", "It holds no JSON object.", "Export it again.", file=path.name)
    return value


def read_csv(file: InputFile, n_headings: int = 1) -> tuple[list[list[str]], Floats]:
    """Headings (one list a row of them) and numbers, shape (n, columns); empty fields are NaN.

    Raises
    ------
    InputError
        ``not_a_table`` where rows are of different lengths or there is none.
    """
    lines = file.content.decode("utf-8-sig", errors="replace").splitlines()
    if len(lines) <= n_headings:
        raise _no_table(file)
    headings = [[word.strip() for word in line.split(",")] for line in lines[:n_headings]]
    try:
        values = np.loadtxt(lines[n_headings:], delimiter=",", ndmin=2, encoding=None)
    except ValueError:
        values = _with_gaps(file, lines, n_headings)
    if not len(values) or values.shape[1] != len(headings[-1]):
        raise _no_table(file)
    return headings, values


def _with_gaps(file: InputFile, lines: Sequence[str], n_headings: int) -> Floats:
    try:
        return np.atleast_2d(np.genfromtxt(lines[n_headings:], delimiter=",", encoding=None))
    except ValueError:
        raise _no_table(file) from None


def _no_table(file: InputFile) -> InputError:
    return InputError(
        "not_a_table",
        "It is no table of numbers under a heading, separated by commas.",
        "Use the file as it was published.",
        file=file.name,
    )
