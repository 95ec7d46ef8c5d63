"""``gaitlab validate``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gaitlab.cli.files import write_files
from gaitlab.errors import InputError
from gaitlab.validation import (
    Table,
    coverage_table,
    methods_tables,
    tables_json,
    tables_markdown,
    tables_text,
    to_json,
    to_text,
    validate,
    validate_all,
)
from gaitlab.validation.folder import files_in, folders_in


def run(chosen: argparse.Namespace) -> int:
    """Print the table of one set, or of all that a folder holds."""
    to_stdout = chosen.json == "-"
    if to_stdout and sys.stdout is None:
        raise InputError("cannot_write", "Standard output is closed.", "Give --json the name of a file.")
    text, document = _methods(chosen) if chosen.set == "methods" else _sets(chosen)
    if to_stdout:
        sys.stdout.write(document)
        return 0
    if document:
        write_files({Path(chosen.json): document.encode()}, _read(chosen.folder))
    sys.stdout.write(text)
    if document:
        print(f"wrote {chosen.json}")
    return 0


def _sets(chosen: argparse.Namespace) -> tuple[str, str]:
    """Tables of sets as text and, where it is wanted, as JSON."""
    if chosen.markdown or chosen.all:
        chosen.wrong_usage("--markdown and --all belong to the set methods")
    tables = _tables(chosen)
    text = "" if chosen.json == "-" else to_text(tables, trials=chosen.trials)
    return text, to_json(tables, trials=chosen.trials) if chosen.json else ""


def _methods(chosen: argparse.Namespace) -> tuple[str, str]:
    """Tables of the methods likewise."""
    if chosen.folder is None:
        chosen.wrong_usage("methods takes a folder")
    tables, problems = methods_tables(Path(chosen.folder), everything=chosen.all)
    document = tables_json(tables, problems) if chosen.json else ""
    if chosen.markdown:
        command = "gaitlab validate methods DIR --markdown" + (" --all" if chosen.all else "")
        return tables_markdown(tables, problems, command), document
    return tables_text(tables, problems), document


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
