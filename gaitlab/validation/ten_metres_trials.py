"""The trials of ten metres and back: files, hand-checked events, analyses.

Voisard et al., IPOL 2023, article 497: ``S-T_lf.txt``, ``S-T_rf.txt``, ``S-T.json``; the events are packet counters.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.errors import InputError
from gaitlab.gait.strides import FootGait
from gaitlab.recording import Placement, Side, read_recording
from gaitlab.recording.model import Floats, Recording
from gaitlab.validation.folder import files_in, read_json
from gaitlab.validation.model import Problem

_FILE = re.compile(r"(.+-.+?)(?:_([lr])f\.txt|\.json)", re.IGNORECASE)
OFF, CONTACT = 0, 1
"""Columns of labelled swings."""
_SUFFIX = {Side.LEFT: "l", Side.RIGHT: "r"}


@dataclass(frozen=True)
class TrialFiles:
    """Files of one trial; a foot that was not recorded is missing."""

    name: str
    feet: Mapping[Side, Path]
    truth: Path | None


@dataclass(frozen=True, eq=False)
class Labels:
    """What was checked by hand, in seconds on the recording's clock.

    Attributes
    ----------
    swings : mapping of ndarray (k, 2)
        Foot off and initial contact of each swing of each foot that was recorded. Some lie after the trial's end: steps
        out of it.
    trial, turn : tuple of float
        Boundaries of the trial and of the turn; NaN where there is no turn.
    """

    swings: Mapping[Side, Floats]
    trial: tuple[float, float]
    turn: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Trial:
    """One analysed trial."""

    name: str
    feet: Mapping[Side, FootGait]
    labels: Labels


def find_trials(folder: Path) -> list[TrialFiles]:
    """The trials of a folder, by the pattern of their names; subjects and trials in the order of their numbers."""
    found: dict[str, dict[str, Path]] = {}
    for path in files_in(folder):
        if match := _FILE.fullmatch(path.name):
            found.setdefault(match[1], {})[(match[2] or "truth").lower()] = path
    return [
        TrialFiles(
            name,
            {side: files[letter] for side, letter in _SUFFIX.items() if letter in files},
            files.get("truth"),
        )
        for name, files in sorted(found.items(), key=lambda one: _number(one[0]))
    ]


def _number(name: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in name.split("-")]


def read_trial(files: TrialFiles) -> tuple[Recording, Labels]:
    """One trial's recording and its labels."""
    if not files.feet:
        raise InputError("no_foot", "There is no file of a foot.", "", file=f"{files.name}.json")
    if files.truth is None:
        raise InputError("no_truth", "There is no file of events.", "", file=f"{files.name}.json")
    recording = read_recording(placements={Placement.foot(side): path for side, path in files.feet.items()})
    return recording, read_labels(files.truth, recording)


def read_labels(path: Path, recording: Recording) -> Labels:
    """Hand-checked events of a trial, from packets to seconds."""
    table = read_json(path)

    def seconds(key: str, shape: tuple[int, ...]) -> Floats:
        try:
            packets = np.array(table[key], dtype=np.float64).reshape(shape)
        except (KeyError, TypeError, ValueError):
            packets = np.array([np.nan])
        if not np.isfinite(packets).all():
            wanted = "pairs of packets" if len(shape) == 2 else "two packets"
            raise InputError("bad_truth", f"{key} should hold {wanted}.", "", file=path.name)
        return np.asarray((packets - recording.first_packet) / recording.rate_hz)

    trial = seconds("TrialBoundaries", (2,))
    turn = seconds("UTurnBoundaries", (2,)) if "UTurnBoundaries" in table else np.full(2, np.nan)
    sides = [placement.side for placement in recording.sensors]
    swings = {side: seconds(f"{side.capitalize()}FootEvents", (-1, 2)) for side in sides}
    return Labels(swings, (float(trial[0]), float(trial[1])), (float(turn[0]), float(turn[1])))


def analysed_trials(folder: Path) -> Iterator[Trial | Problem]:
    """Each trial of a folder analysed with default settings, or why not."""
    for files in find_trials(folder):
        try:
            recording, labels = read_trial(files)
            yield Trial(files.name, analyze(recording).gait.feet, labels)
        except InputError as error:
            yield Problem(files.name, str(error))
            continue
        for side in Side:
            if side not in files.feet:
                yield Problem(files.name, f"The {side} foot is missing; the other one counts.")


def feet_of(trials: Sequence[Trial]) -> Iterator[tuple[Trial, Side, FootGait]]:
    """Every foot of every trial."""
    for trial in trials:
        for side, foot in trial.feet.items():
            yield trial, side, foot
