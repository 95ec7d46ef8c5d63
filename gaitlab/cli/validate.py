"""``gaitlab validate``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gaitlab.cli.files import write_files
from gaitlab.errors import InputError
from gaitlab.validation import Table, coverage_table, to_json, to_text, validate, validate_all
from gaitlab.validation.folder import files_in, folders_in


def run(chosen: argparse.Namespace) -> int:
    """Print the table of one set, or of all that a folder holds."""
    to_stdout = chosen.json == "-"
    if to_stdout and sys.stdout is None:
        raise InputError("cannot_write", "Standard output is closed.", "Give --json the name of a file.")
    tables = _tables(chosen)
    document = to_json(tables, trials=chosen.trials) if chosen.json else ""
    if to_stdout:
        sys.stdout.write(document)
        return 0
    if document:
        write_files({Path(chosen.json): document.encode()}, _read(chosen.folder))
    sys.stdout.write(to_text(tables, trials=chosen.trials))
    if document:
        print(f"wrote {chosen.json}")
    return 0


def _tables(chosen: argparse.Namespace) -> list[Table]:
    if (chosen.set == "coverage") == (chosen.folder is not None):
        chosen.wrong_usage(f"{chosen.set} takes {'no folder' if chosen.folder else 'a folder'}")
    if chosen.set == "coverage":
        return [coverage_table()]
    folder = Path(chosen.folder)
    return validate_all(folder) if chosen.set == "all" else [validate(chosen.set, folder)]


def _read(given: str | None) -> list[Path]:
    """What was read, or could have been: it is not overwritten."""
    if given is None:
        return []
    folder = Path(given)
    return [path for home in folders_in(folder) for path in files_in(home)]
