"""The sets of public recordings by name."""

from __future__ import annotations

from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording.file import clean_name
from gaitlab.validation import foot_loop, foot_mocap, leg_vicon, ten_metres
from gaitlab.validation.folder import folders_in
from gaitlab.validation.model import KnownSet, Table

SETS: dict[str, KnownSet] = {one.SET.name: one.SET for one in (ten_metres, leg_vicon, foot_mocap, foot_loop)}


def validate(name: str, folder: Path) -> Table:
    """The table of one set.

    Raises
    ------
    InputError
        Where the folder holds none of its recordings.
    """
    return SETS[name].validate(folder)


def validate_all(folder: Path) -> list[Table]:
    """The tables of all sets found in a folder or in the folders directly in it, told by their content."""
    homes = folders_in(folder)
    found = [one.validate(home) for one in SETS.values() for home in homes if one.fits(home)]
    if not found:
        wanted = "; ".join(f"{one.name}: {one.wanted}" for one in SETS.values())
        raise InputError(
            "no_known_set",
            f"No folder in it holds a known set. Looked for {wanted}.",
            "Give the folder in which the folders of the sets lie.",
            file=clean_name(str(folder)),
        )
    return found
