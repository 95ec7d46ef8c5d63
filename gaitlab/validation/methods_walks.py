"""The walks that methods are judged on: feet as methods see them, with the labels of their trials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.comparison.inputs import Inputs, inputs_of, missing
from gaitlab.errors import InputError
from gaitlab.methods.model import FootView, Method, Track
from gaitlab.methods.steps_signals import Person, Sex
from gaitlab.recording.model import Floats, Side
from gaitlab.validation.folder import read_json
from gaitlab.validation.model import Problem
from gaitlab.validation.ten_metres_paths import HALT_S
from gaitlab.validation.ten_metres_trials import CONTACT, OFF, Labels, find_trials, read_trial

WAY_M = 10.0
"""Each way of the trials of ten metres and back."""


@dataclass(frozen=True, eq=False)
class LabelledFoot:
    """One foot of a trial of ten metres and back."""

    trial: str
    subject: str
    side: Side
    view: FootView
    inputs: Inputs
    labels: Labels

    @property
    def swings(self) -> Floats:
        """Hand-checked foot off and contact, shape (k, 2)."""
        return self.labels.swings[self.side]

    def track(self, method: Method) -> Track | None:
        """The trial's part of a position method's track; None where an input is missing or it has fewer than two places."""
        if missing(method, self.inputs, self.side):
            return None
        return trial_part(method.run(self.view), self.labels, self.side)


def labelled_feet(folder: Path) -> tuple[list[LabelledFoot], list[Problem]]:
    """All feet of a folder of ten metres and back, and what could not be used."""
    feet: list[LabelledFoot] = []
    problems: list[Problem] = []
    for files in find_trials(folder):
        try:
            recording, labels = read_trial(files)
            assert files.truth is not None
            inputs = inputs_of(analyze(recording), _person(read_json(files.truth)), None)
        except InputError as error:
            problems.append(Problem(files.name, str(error)))
            continue
        subject = files.name.split("-")[0]
        feet += [
            LabelledFoot(files.name, subject, side, view, inputs, labels)
            for side, view in inputs.feet.items()
            if len(labels.swings[side])
        ]
    return feet, problems


def _person(table: Mapping[str, object]) -> Person:
    height, gender = table.get("Height"), table.get("Gender")
    sex = {"F": Sex.FEMALE, "M": Sex.MALE}.get(str(gender).upper())
    return Person(float(height) / 100.0 if isinstance(height, (int, float)) else None, sex)


def trial_part(track: Track, labels: Labels, side: Side) -> Track | None:
    """From the last place before the first labelled swing to the first after the swing that ends the trial."""
    swings = labels.swings[side]
    ended = int(np.searchsorted(swings[:, OFF], labels.trial[1] + HALT_S)) - 1
    contact = swings[max(ended, 0), CONTACT]
    first = max(int(np.searchsorted(track.time_s, swings[0, OFF])) - 1, 0)
    last = min(int(np.searchsorted(track.time_s, contact)), len(track.time_s) - 1)
    if last <= first:
        return None
    rows = slice(first, last + 1)
    return Track(track.time_s[rows], track.place_m[rows] - track.place_m[first])
