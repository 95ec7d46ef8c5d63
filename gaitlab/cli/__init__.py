"""The command line: ``gaitlab analyze``, ``doctor``, ``validate``, ``demo``, ``serve``, ``user``, ``token``, ``db``,
``audit``.

Exit status: 0 done · 1 the input cannot be used or the output cannot be written (one message on standard error;
none where whoever read standard output stopped reading) · 2 wrong usage.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence
from contextlib import suppress

from gaitlab.errors import GaitlabError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "—" gets a "?", not a traceback
    try:
        status = _run(arguments)
    except SystemExit:  # of argparse, after --help too
        with suppress(OSError):
            _flush()
        raise
    except GaitlabError as error:
        with suppress(OSError):
            _flush()
        print(f"gaitlab: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        return _say_failed_output(error)
    except KeyboardInterrupt:
        return 130
    try:
        _flush()
    except OSError as error:
        return _say_failed_output(error)
    return status


def _run(arguments: Sequence[str] | None) -> int:
    from gaitlab.cli.parser import build_parser

    chosen = build_parser().parse_args(arguments)
    status: int = chosen.run(chosen)
    return status


def _flush() -> None:
    """Write what standard output still holds; what it refuses is given up, or Python would try again at its end."""
    if sys.stdout is None:
        return
    try:
        sys.stdout.flush()
    except OSError:
        _give_up_output()
        raise


def _give_up_output() -> None:
    with suppress(OSError, ValueError):
        handle = os.open(os.devnull, os.O_WRONLY)
        os.dup2(handle, sys.stdout.fileno())
        os.close(handle)


def _say_failed_output(error: OSError) -> int:
    _give_up_output()
    if not isinstance(error, BrokenPipeError):
        place = error.filename or "standard output"
        print(f"gaitlab: {place} cannot be used: {error.strerror or error}.", file=sys.stderr)
    return 1
