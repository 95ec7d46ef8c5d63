"""One leg under cameras: stride length against the mid-foot, the knee's path against the knee joint."""

from __future__ import annotations

from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording import Side
from gaitlab.validation.folder import files_in, folders_in, not_this_set
from gaitlab.validation.leg_vicon_check import LegCheck, check_leg, optical_files
from gaitlab.validation.leg_vicon_rows import details_of, rows_of
from gaitlab.validation.model import KnownSet, Problem, Table

NAME = "leg-vicon"
WANTED = (
    "vicon-left-leg.csv or vicon-right-leg.csv, and beside it the text file of each sensor (…_00B40C55.txt, or"
    " placement.json)"
)


def fits(folder: Path) -> bool:
    """Whether a folder holds such a recording."""
    return bool(optical_files(folder)) and any(path.suffix.lower() == ".txt" for path in files_in(folder))


def validate(folder: Path) -> Table:
    """Rows 1, 8 and 9, of the folder and the folders directly in it."""
    homes = [one for one in folders_in(folder) if fits(one)]
    if not homes:
        raise not_this_set(NAME, folder, WANTED)
    legs: list[LegCheck] = []
    problems: list[Problem] = []
    for home in homes:
        for optical in optical_files(home):
            name = f"{home.name}: {optical.name}"
            try:
                found = [leg for side in Side if (leg := check_leg(home, optical, side))]
            except InputError as error:
                problems.append(Problem(name, str(error)))
                continue
            if not found:
                problems.append(Problem(name, "No side has both optical joints and a foot sensor."))
            legs += found
            problems += [problem for leg in found for problem in leg.problems]
    return Table(NAME, folder.name, len(homes), rows_of(legs), details_of(legs), tuple(problems))


SET = KnownSet(NAME, WANTED, fits, validate)
