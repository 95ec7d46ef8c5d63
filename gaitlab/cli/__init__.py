"""The command line: ``gaitlab analyze``, ``doctor``, ``demo``, ``serve``, ``user``, ``token``, ``db``, ``audit``.

Exit status: 0 done · 1 the input cannot be used (one message on standard error) · 2 wrong usage.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence

from gaitlab.errors import GaitlabError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    from gaitlab.cli.parser import build_parser

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "—" gets a "?", not a traceback
    chosen = build_parser().parse_args(arguments)
    try:
        status: int = chosen.run(chosen)
    except GaitlabError as error:
        print(f"gaitlab: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        sys.stderr.close()  # whoever read the output has stopped reading
        return 1
    except KeyboardInterrupt:
        return 130
    return status
