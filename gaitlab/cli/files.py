"""Writing results to files that people named."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from gaitlab.errors import InputError


def write_file(path: Path, content: bytes) -> None:
    """Write a file whole or not at all; folders are made.

    Raises
    ------
    InputError
        Where it cannot be written, with the system's reason.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".gaitlab-")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            Path(name).chmod(0o644 & ~_umask())
            Path(name).replace(path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        reason = error.strerror or "unknown reason"
        raise InputError(
            "cannot_write", f"{path} cannot be written: {reason}.", "Choose another place."
        ) from error


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
