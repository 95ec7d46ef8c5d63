"""Which of the given files belong to the trial, and which sensor each is."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording.families import read_samples
from gaitlab.recording.file import InputFile, clean_name
from gaitlab.recording.foreign import is_sensor_text
from gaitlab.recording.intake import PLACEMENT_FILE, expand, load
from gaitlab.recording.model import Finding, Placement
from gaitlab.recording.placing import Guess, guess_one, placed_twice

_HOW = (
    "Name them with --left-foot, --right-foot, --left-knee and --right-knee, or put a placement.json beside "
    'them: {"left_foot": "file.txt", …}.'
)


@dataclass(frozen=True)
class Selection:
    """The files of a trial by placement, and the sensors that were left aside since they were worn elsewhere."""

    files: dict[Placement, InputFile]
    elsewhere: tuple[Guess, ...] = ()

    @property
    def findings(self) -> tuple[Finding, ...]:
        return tuple(
            Finding(
                "sensor_not_used",
                f"{guess.file.name} ({guess.elsewhere}) is not used; only sensors on feet and knees are.",
            )
            for guess in self.elsewhere
        )


def select_files(
    paths: Sequence[Path | str],
    placements: Mapping[Placement, Path | str],
    known_devices: Mapping[str, Placement] | None = None,
) -> Selection:
    """Load paths and place the files: named ones first, then ``placement.json``, then what names and devices tell.

    Raises
    ------
    InputError
        As :func:`place_files`, :func:`load` and :func:`expand`.
    """
    files = expand(load(paths))
    named = {Placement(placement): _named_file(path, files) for placement, path in placements.items()}
    return place_files(files, named, known_devices)


def place_files(
    files: Sequence[InputFile],
    named: Mapping[Placement, InputFile] | None = None,
    known_devices: Mapping[str, Placement] | None = None,
) -> Selection:
    """Decide which file is which sensor; files that were already unpacked come in, placed files come out.

    Files without a sensor's header are left aside unless they are all there is for a placement, so that a damaged
    one is refused and not overlooked.

    Raises
    ------
    InputError
        ``placement_twice``, ``placement_unknown``, ``no_sensor_files``, ``placement_file``; where the only file is no
        recording, what its reader says of it.
    """
    placed = dict(named or {})
    if from_json := _placement_json(files):
        return Selection({**from_json, **placed})
    taken = [id(file) for file in placed.values()]
    free = [file for file in files if id(file) not in taken and not _is_json(file)]
    guesses = [guess_one(file, known_devices or {}) for file in free]
    sensors = [guess for guess in guesses if is_sensor_text(guess.file)]
    unknown = [guess.file.name for guess in sensors if guess.placement is None and guess.elsewhere is None]
    if unknown and not placed:
        raise _unknown(unknown)
    candidates = _candidates(sensors, placed)
    candidates |= _candidates([guess for guess in guesses if guess not in sensors], {**placed, **candidates})
    for placement, found in candidates.items():
        if len(found) > 1:
            raise placed_twice(placement, [guess.file.name for guess in found])
        placed[placement] = found[0].file
    if not placed:
        raise _no_sensors(files, free, guesses)
    return Selection(placed, tuple(guess for guess in sensors if guess.elsewhere))


def _candidates(guesses: Sequence[Guess], taken: Mapping[Placement, object]) -> dict[Placement, list[Guess]]:
    found: dict[Placement, list[Guess]] = {}
    for guess in guesses:
        if guess.placement is not None and guess.placement not in taken:
            found.setdefault(guess.placement, []).append(guess)
    return found


def _named_file(path: Path | str, files: Sequence[InputFile]) -> InputFile:
    """The file on disk, else the one of that name among those given (in a zip, say)."""
    wanted = str(path).replace("\\", "/")
    if not os.path.exists(path):  # noqa: PTH110 Path.exists raises for a path too long
        match = next((file for file in files if file.name == wanted), None) or _by_basename(files, wanted)
        if match is not None:
            return match
    loaded = expand(load([path]))
    if len(loaded) != 1:
        raise InputError(
            "placement_unknown",
            "One sensor's file is wanted here, not a folder or an archive of several.",
            "Give the path of the file itself.",
            file=clean_name(str(path)),
        )
    return next((file for file in files if file.sha256 == loaded[0].sha256), loaded[0])


def _placement_json(files: Sequence[InputFile]) -> dict[Placement, InputFile]:
    """Placements by ``placement.json``, empty without one. Its names are looked up, never opened."""
    found = [file for file in files if _is_json(file) and file.basename.lower() == PLACEMENT_FILE]
    if not found:
        return {}
    if len(found) > 1:
        raise InputError(
            "placement_file",
            "There are several files placement.json.",
            "Give the files of one trial only.",
            file=found[1].name,
        )
    table = _json_object(found[0])
    folder = found[0].name.replace("\\", "/").rpartition("/")[0]
    placed = {}
    for key, name in table.items():
        if key not in list(Placement) or not isinstance(name, str):
            raise _bad_placement(
                found[0], f"“{clean_name(str(key))[:40]}” is not a placement with a file name."
            )
        wanted = f"{folder}/{name}" if folder else name
        match = next((f for f in files if f.name == wanted), None) or _by_basename(files, name)
        if match is None:
            raise _bad_placement(
                found[0], f"It names “{clean_name(name)[:80]}”, which is not among the files."
            )
        placed[Placement(key)] = match
    if not placed:
        raise _bad_placement(found[0], "It names no file.")
    return placed


def _json_object(file: InputFile) -> dict[str, object]:
    try:
        table = json.loads(
            file.content.decode("utf-8-sig"), object_pairs_hook=lambda pairs: _once(file, pairs)
        )
    except json.JSONDecodeError as error:
        raise _bad_placement(file, f"It is not valid JSON: {error.msg}.", error.lineno) from None
    except (UnicodeDecodeError, RecursionError, ValueError):
        raise _bad_placement(file, "It is not valid JSON.") from None
    if not isinstance(table, dict):
        raise _bad_placement(file, "It holds no JSON object.")
    return table


def _once(file: InputFile, pairs: Sequence[tuple[str, object]]) -> dict[str, object]:
    table: dict[str, object] = {}
    for key, value in pairs:
        if key in table:
            raise _bad_placement(file, f"It names “{clean_name(key)[:40]}” twice.")
        table[key] = value
    return table


def _by_basename(files: Sequence[InputFile], name: str) -> InputFile | None:
    same = [file for file in files if file.basename == name]
    return same[0] if len(same) == 1 else None


def _bad_placement(file: InputFile, message: str, line: int | None = None) -> InputError:
    hint = (
        'It should read {"left_foot": "file.txt", "right_foot": "other.txt"}; also left_knee and right_knee.'
    )
    return InputError("placement_file", message, hint, file=file.name, line=line)


def _unknown(names: Sequence[str]) -> InputError:
    shown = ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
    return InputError(
        "placement_unknown",
        f"It cannot be told where these sensors were worn: {shown}.",
        _HOW,
        file=names[0] if len(names) == 1 else None,
    )


def _no_sensors(
    files: Sequence[InputFile], free: Sequence[InputFile], guesses: Sequence[Guess]
) -> InputError:
    for guess in guesses:
        if guess.elsewhere:
            return InputError("no_sensor_files", guess.why, _HOW, file=guess.file.name)
    if len(free) == 1:
        read_samples(free[0])  # it has no header, so its reader says what it is instead
    if not files:
        return InputError("no_files", "There is no file in what was given.", "Give the files of one trial.")
    names = ", ".join(file.name for file in files[:6])
    return InputError(
        "no_sensor_files",
        f"None of the files is a sensor recording: {names}{' …' if len(files) > 6 else ''}.",
        "Export the recordings from MT Manager as text (ASCII), one file a sensor.",
        file=files[0].name if len(files) == 1 else None,
    )


def _is_json(file: InputFile) -> bool:
    return file.basename.lower().endswith(".json")
