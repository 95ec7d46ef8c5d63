"""Writing results to files that people named."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording.file import LIMITS, InputFile
from gaitlab.recording.foreign import is_sensor_text
from gaitlab.recording.intake import PLACEMENT_FILE


def write_files(contents: Mapping[Path, bytes], inputs: Iterable[Path | str] = ()) -> None:
    """Write files, each whole, and none of them if one cannot be written; folders are made.

    A symbolic link is followed. A character device or a FIFO is opened and written to, never replaced.

    Parameters
    ----------
    inputs : iterable of Path or str
        What was read: it is not overwritten, nor is any other recording of a sensor.

    Raises
    ------
    InputError
        ``output_is_input``, ``output_twice``, ``not_a_file``; ``cannot_write`` with the system's reason.
    """
    targets = _targets(contents)
    _refuse_inputs(targets, inputs)
    _refuse_twice(targets)
    staged: list[tuple[Path, Path]] = []
    made: list[Path] = []
    try:
        for path, target in targets.items():
            with _Said(path):
                if not _is_stream(target):
                    _make_folder(target.parent, made)
                    staged.append((_stage(target, contents[path]), target))
        for path, target in targets.items():
            with _Said(path):
                if _is_stream(target):
                    _write_stream(target, contents[path])
        for temporary, target in staged:
            with _Said(target):
                temporary.replace(target)
    except BaseException:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)
        for folder in reversed(made):
            with suppress(OSError):
                folder.rmdir()
        raise


class _Said:
    """Turn the system's refusal into one sentence that names the file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> None: ...

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
        if isinstance(error, (OSError, ValueError, RuntimeError)):  # NUL in a name; a circle of links
            raise cannot_write(self.path, error) from error


def cannot_write(path: Path, error: Exception) -> InputError:
    """The refusal of a place that cannot be written, with the system's reason."""
    reason = getattr(error, "strerror", None) or "it is not a usable path"
    return InputError("cannot_write", f"{_short(path)} cannot be written: {reason}.", "Choose another place.")


def _short(path: Path) -> str:
    text = str(path)
    return text if len(text) <= 255 else f"{text[:255]}…"


def _targets(contents: Mapping[Path, bytes]) -> dict[Path, Path]:
    """Where each path leads: links followed; a device stays as it was named."""
    targets: dict[Path, Path] = {}
    for path in contents:
        with _Said(path):
            mode = _mode(path)
            if mode is None or stat.S_ISREG(mode):
                targets[path] = path.resolve()
            elif stat.S_ISCHR(mode) or stat.S_ISFIFO(mode):
                targets[path] = path
            else:
                kind = "a folder" if stat.S_ISDIR(mode) else "no file that can be written"
                raise InputError("not_a_file", f"{_short(path)} is {kind}.", "Give the path of a file.")
    return targets


def _mode(path: Path) -> int | None:
    """Kind and permissions of what a path leads to; None where nothing is there."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def _is_stream(path: Path) -> bool:
    mode = _mode(path)
    return mode is not None and not stat.S_ISREG(mode)


def _refuse_inputs(targets: Mapping[Path, Path], inputs: Iterable[Path | str]) -> None:
    read = [Path(one) for one in inputs]
    read += [folder / PLACEMENT_FILE for folder in read if os.path.isdir(folder)]  # noqa: PTH112 never raises
    for path, target in targets.items():
        with _Said(path):
            if _is_stream(target) or not target.exists():
                continue
            if any(_same(target, one) for one in read) or _is_recording(target):
                raise InputError(
                    "output_is_input",
                    f"{_short(path)} is a recording or was read for this result; it is not overwritten.",
                    "Choose another name.",
                )


def _refuse_twice(targets: Mapping[Path, Path]) -> None:
    seen: list[Path] = []
    for path, target in targets.items():
        if any(target == one or _same(target, one) for one in seen):
            raise InputError(
                "output_twice", f"{_short(path)} would be written twice.", "Give each output its own name."
            )
        if not _is_stream(target):
            seen.append(target)


def _same(a: Path, b: Path) -> bool:
    try:
        return a.samefile(b)
    except (OSError, ValueError):
        return False


def _is_recording(path: Path) -> bool:
    with path.open("rb") as file:
        return is_sensor_text(InputFile(path.name, file.read(LIMITS.header_bytes)))


def _make_folder(folder: Path, made: list[Path]) -> None:
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    for one in reversed(missing):
        one.mkdir()
        made.append(one)
    folder.mkdir(parents=True, exist_ok=True)


def _stage(target: Path, content: bytes) -> Path:
    """The content in a temporary file beside its target, with the mode of what it will replace."""
    mode = _mode(target)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=".gaitlab-")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        temporary.chmod(0o644 & ~_umask() if mode is None else stat.S_IMODE(mode))
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return temporary


def _write_stream(path: Path, content: bytes) -> None:
    handle = os.open(path, os.O_WRONLY | os.O_NOCTTY)
    with os.fdopen(handle, "wb", buffering=0) as file:
        left = memoryview(content)
        while left:
            left = left[file.write(left) or 0 :]


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
