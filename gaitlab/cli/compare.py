"""``gaitlab compare``."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from gaitlab.cli.parser import PLACEMENTS
from gaitlab.comparison import cohort, cohort_json, cohort_text, compare, to_json, to_text
from gaitlab.errors import InputError
from gaitlab.methods.steps_signals import Person, Sex
from gaitlab.recording import Placement, Recording, read_recording

_SEX = {"m": Sex.MALE, "f": Sex.FEMALE, None: None}


def run(chosen: argparse.Namespace) -> int:
    """Compare the methods on one recording, or on several of one known length."""
    worn = {Placement(name): getattr(chosen, name) for name in PLACEMENTS if getattr(chosen, name)}
    if not chosen.paths and not worn:
        chosen.wrong_usage("give a folder, a zip or the files of a recording")
    person = Person(chosen.height, _SEX[chosen.sex])
    if chosen.cohort:
        return _cohort(chosen, worn, person)
    recording = read_recording(*chosen.paths, placements=worn or None, rate_hz=chosen.rate)
    names = None if chosen.methods is None else _names(chosen.methods)
    found = compare(recording, None, chosen.known_length, person, names)
    sys.stdout.write(to_json(found) if chosen.json else to_text(found))
    return 0


def _names(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise InputError("no_method", "--methods names none.", "Give names separated by commas.")
    return names


def _cohort(chosen: argparse.Namespace, worn: dict[Placement, str], person: Person) -> int:
    if chosen.known_length is None:
        chosen.wrong_usage("--cohort takes --known-length")
    if worn or chosen.methods:
        chosen.wrong_usage("--cohort takes recordings only: a folder or a zip each")

    def read(path: str) -> Recording:
        return read_recording(path, rate_hz=chosen.rate)

    recordings = [(Path(path).name, lambda path=path: read(path)) for path in chosen.paths]
    found = cohort(recordings, chosen.known_length, person)
    if chosen.json:
        print(json.dumps(cohort_json(found), indent=1, ensure_ascii=False, allow_nan=False))
    else:
        sys.stdout.write(cohort_text(found))
    return 0
