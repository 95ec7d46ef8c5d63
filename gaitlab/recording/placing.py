"""Where was each sensor worn? Told from file names, and from the device numbers of earlier choices."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from gaitlab.errors import InputError
from gaitlab.recording.decoding import head_text
from gaitlab.recording.file import LIMITS, InputFile
from gaitlab.recording.heading import device_in_comments
from gaitlab.recording.model import Placement, Side
from gaitlab.recording.mtmanager import device_in_name

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_SIDES = {"left": Side.LEFT, "l": Side.LEFT, "right": Side.RIGHT, "r": Side.RIGHT}
_FOOT = {"foot", "feet", "shoe", "heel", "instep", "forefoot", "f"}
_KNEE = {"knee", "k"}
_SHANK = {"shank", "tibia", "shin", "calf", "lowerleg"}
_ELSEWHERE = {
    "lb": "low back", "lowback": "low back", "lumbar": "low back", "back": "back", "he": "head", "head": "head",
    "pelvis": "pelvis", "sacrum": "sacrum", "waist": "waist", "trunk": "trunk", "sternum": "sternum",
    "chest": "chest", "thigh": "thigh", "femur": "thigh", "upperleg": "thigh", "hand": "hand", "wrist": "wrist",
    "forearm": "forearm", "arm": "arm", "upperarm": "arm", "shoulder": "shoulder",
}  # fmt: skip
_SHORT = re.compile(r"(l|r)(f|k)")


@dataclass(frozen=True)
class Guess:
    """What can be told of one file's placement.

    Attributes
    ----------
    placement : Placement or None
        None where it cannot be told, or where the sensor was worn elsewhere.
    device : str or None
        The device number, from the header or the end of the file's name.
    why : str
        One sentence for people: what the guess rests on, or why there is none.
    elsewhere : str or None
        The part of the body that the name states where it is neither foot nor knee.
    """

    file: InputFile
    placement: Placement | None
    device: str | None
    why: str
    elsewhere: str | None = None


def guess_placements(
    files: Sequence[InputFile], known_devices: Mapping[str, Placement] | None = None
) -> list[Guess]:
    """Guess each file's placement, in the order of the files.

    Parameters
    ----------
    known_devices : mapping, optional
        Placements that were chosen earlier for these device numbers; a file's name goes before them.

    Raises
    ------
    InputError
        ``placement_twice`` where two files claim one placement; it names both.
    """
    guesses = [guess_one(file, known_devices or {}) for file in files]
    taken: dict[Placement, Guess] = {}
    for guess in guesses:
        if guess.placement is None:
            continue
        if guess.placement in taken:
            raise placed_twice(guess.placement, [taken[guess.placement].file.name, guess.file.name])
        taken[guess.placement] = guess
    return guesses


def guess_one(file: InputFile, known_devices: Mapping[str, Placement]) -> Guess:
    """Guess one file's placement by its name, else by its device, else by the folder it lies in."""
    device = device_of(file)
    folders, _, base = file.name.replace("\\", "/").rpartition("/")
    for part, name in (("file name", base), ("folder name", folders.rpartition("/")[2])):
        placement, word, elsewhere = _place_in_name(name)
        if placement is not None:
            why = f"The {part} says {placement.label}."
            if word in _SHANK:
                why = f"The {part} says {placement.side} {word}; a sensor there counts as the knee's."
            return Guess(file, placement, device, why)
        if elsewhere is not None:
            why = f"The {part} says {elsewhere}; only sensors on feet and knees are used."
            return Guess(file, None, device, why, elsewhere)
        if part == "file name" and device is not None and device in known_devices:
            placement = known_devices[device]
            return Guess(
                file, placement, device, f"Sensor {device} was worn at the {placement.label} before."
            )
    return Guess(file, None, device, "Neither the file name nor the device number tells the placement.")


def device_of(file: InputFile) -> str | None:
    """The device number from the header, else from the end of the file's name."""
    return device_in_comments(head_text(file.content, LIMITS.header_bytes)) or device_in_name(file.name)


def placed_twice(placement: Placement, names: Sequence[str]) -> InputError:
    """The refusal of several files for one placement."""
    shown = ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")
    option = f"--{placement.value.replace('_', '-')}"
    return InputError(
        "placement_twice",
        f"{len(names)} files claim the {placement.label}: {shown}.",
        f"Give the files of one trial only, or name the right one with {option} (and the others likewise) "
        "or in a placement.json.",
        file=names[-1],
    )


def _place_in_name(name: str) -> tuple[Placement | None, str, str | None]:
    """Placement, the word for the part of the body, and the part where it is another one.

    Words go before the short forms ``lf``, ``rk``, which may be a person's initials.
    """
    stem = name.rpartition(".")[0] or name
    words = [word.lower() for word in _WORDS.findall(stem)]
    words += [first + second for first, second in pairwise(words)]
    spelled = [word for word in words if not _SHORT.fullmatch(word)]
    placement, part = _decide(spelled)
    if not part:
        placement, part = _decide(words)
    elsewhere = next((_ELSEWHERE[word] for word in words if word in _ELSEWHERE), None)
    return placement, part, None if part else elsewhere


def _decide(words: Sequence[str]) -> tuple[Placement | None, str]:
    """The one placement these words tell, None where they contradict; and the word for the body part."""
    found = [_side_and_part(word) for word in words]
    sides = {side for side, _ in found if side is not None}
    parts = {part in _FOOT: part for _, part in reversed(found) if part}
    if len(sides) != 1 or len(parts) != 1:
        return None, next(iter(parts.values()), "")
    (is_foot, part), side = next(iter(parts.items())), sides.pop()
    return (Placement.foot(side) if is_foot else Placement.knee(side)), part


def _side_and_part(word: str) -> tuple[Side | None, str]:
    """``left`` → left; ``foot`` → foot; ``lf``, ``leftfoot``, ``footleft``, ``rtibia`` → both."""
    if short := _SHORT.fullmatch(word):
        return _SIDES[short[1]], short[2]
    long_parts = (_FOOT | _KNEE | _SHANK) - {"f", "k"}
    if word in _SIDES:
        return _SIDES[word], ""
    if word in long_parts:
        return None, word
    for side_word, side in _SIDES.items():
        if word.startswith(side_word) and word[len(side_word) :] in long_parts:
            return side, word[len(side_word) :]
        if word.endswith(side_word) and word[: -len(side_word)] in long_parts:
            return side, word[: -len(side_word)]
    return None, ""
