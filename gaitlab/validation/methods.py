"""Every published method on recordings that bring their truth, in the form of the papers' tables."""

from __future__ import annotations

from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording.file import clean_name
from gaitlab.validation import ten_metres
from gaitlab.validation.folder import folders_in
from gaitlab.validation.foot_loop import loops_in
from gaitlab.validation.methods_feet import closing_table, heading_table, lengths_table, steps_table
from gaitlab.validation.methods_model import PaperTable
from gaitlab.validation.methods_optical import calibration_table, lengths_by_class, seen_feet, thigh_table
from gaitlab.validation.methods_walks import LabelledFoot, labelled_feet
from gaitlab.validation.model import Problem


def methods_tables(folder: Path, *, everything: bool = False) -> tuple[list[PaperTable], list[Problem]]:
    """The tables that the recordings in a folder and in the folders directly in it allow, and what could not be used.

    Parameters
    ----------
    everything : bool
        The calibrations too, which take minutes.

    Raises
    ------
    InputError
        ``no_known_set`` where none is there.
    """
    homes = folders_in(folder)
    labelled: list[LabelledFoot] = []
    problems: list[Problem] = []
    for home in filter(ten_metres.fits, homes):
        found, failed = labelled_feet(home)
        labelled += found
        problems += failed
    seen, failed = seen_feet(homes)
    problems += failed
    tables: list[PaperTable] = []
    if labelled:
        loops = [path for home in homes for path in loops_in(home)]
        tables += [
            steps_table(labelled),
            closing_table(labelled, loops),
            heading_table(labelled),
            lengths_table(labelled),
        ]
    if seen:
        tables += [lengths_by_class(seen), thigh_table(seen)]
        tables += [calibration_table(seen)] if everything else []
    if not tables:
        raise InputError(
            "no_known_set",
            "No folder in it holds a known set whose recordings could be used.",
            "Give the folder in which the folders of the public recordings lie.",
            file=clean_name(str(folder)),
        )
    return tables, problems
