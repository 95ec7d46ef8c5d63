"""Ten metres and back: what two feet say of the same walk, and events against those checked by hand."""

from __future__ import annotations

from pathlib import Path

from gaitlab.validation.folder import not_this_set
from gaitlab.validation.model import KnownSet, Problem, Table
from gaitlab.validation.ten_metres_details import details_of
from gaitlab.validation.ten_metres_events import event_rows
from gaitlab.validation.ten_metres_paths import path_rows, way_of
from gaitlab.validation.ten_metres_trials import Trial, analysed_trials, feet_of, find_trials

NAME = "10m-walk"
WANTED = "S-T_lf.txt, S-T_rf.txt (one or both) and S-T.json of each trial"


def fits(folder: Path) -> bool:
    """Whether a folder holds such trials."""
    return any(trial.feet and trial.truth for trial in find_trials(folder))


def validate(folder: Path) -> Table:
    """Rows 3 to 7."""
    if not fits(folder):
        raise not_this_set(NAME, folder, WANTED)
    outcomes = list(analysed_trials(folder))
    trials = [one for one in outcomes if isinstance(one, Trial)]
    problems = [one for one in outcomes if isinstance(one, Problem)]
    problems += [
        Problem(trial.name, f"The {side} foot has fewer than two rests; it has no path.")
        for trial, side, foot in feet_of(trials)
        if way_of(foot, trial.labels, side) is None
    ]
    rows = (*path_rows(trials), *event_rows(trials))
    return Table(NAME, folder.name, len(find_trials(folder)), rows, details_of(trials), tuple(problems))


SET = KnownSet(NAME, WANTED, fits, validate)
