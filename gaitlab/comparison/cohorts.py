"""Several walks of one known length by every method: mean, standard deviation and relative error.

İkizoğlu et al. 2018, §4, eq. 4–6: 42 people, 11.41 ± 0.36 m for 11.5 m, 0.8 %.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.comparison.comparing import LONGEST_WALK_M, SHORTEST_WALK_M
from gaitlab.comparison.inputs import Inputs, inputs_of, missing
from gaitlab.errors import InputError
from gaitlab.methods.catalogue import of
from gaitlab.methods.closing import closing_of
from gaitlab.methods.length_factors import KnownWalk, calibrate, distance_m
from gaitlab.methods.model import Method, Need, Question
from gaitlab.methods.steps_signals import Person
from gaitlab.recording.model import Floats, Recording, Side


@dataclass(frozen=True)
class CohortRow:
    """A method over all feet.

    Attributes
    ----------
    mean_m, sd_m : float
        Eq. 4 and 5; NaN where there are too few.
    error_percent : float
        Eq. 6: the known length less the mean, in % of the known length.
    n, of : int
        Feet that have a length, and all.
    """

    method: Method
    mean_m: float
    sd_m: float
    error_percent: float
    n: int
    of: int


@dataclass(frozen=True)
class Cohort:
    """All methods over several recordings; ``problems`` are recordings that could not be used, and why."""

    known_length_m: float
    recordings: int
    rows: tuple[CohortRow, ...]
    problems: tuple[tuple[str, str], ...] = ()

    def row(self, question: Question, name: str) -> CohortRow:
        """The row of a method."""
        return next(r for r in self.rows if r.method.question is question and r.method.name == name)


def row_of(method: Method, lengths_m: Floats, known_length_m: float) -> CohortRow:
    """Eq. 4–6 of measured lengths, shape (k,), NaN where a foot has none."""
    known = lengths_m[np.isfinite(lengths_m)]
    mean = float(known.mean()) if len(known) else np.nan
    sd = float(known.std(ddof=1)) if len(known) > 1 else np.nan
    error = 100.0 * (known_length_m - mean) / known_length_m
    return CohortRow(method, mean, sd, error, len(known), len(lengths_m))


def cohort(
    recordings: Iterable[tuple[str, Callable[[], Recording]]],
    known_length_m: float,
    person: Person | None = None,
) -> Cohort:
    """Path length of each foot by every method that gives places or lengths.

    The walk goes from the first rest to the last. The step-length models get their factors from the other recordings, so
    that no length is its own measure; with one recording they have none.

    Parameters
    ----------
    recordings : iterable of (name, function)
        The function reads the recording; its ``InputError`` becomes a problem, and the others count.
    """
    if not SHORTEST_WALK_M <= known_length_m <= LONGEST_WALK_M:
        raise InputError(
            "known_length", "The known length must be between 0.5 m and 10 km.", "Give it in metres."
        )
    person = person or Person()
    walks: list[Inputs] = []
    problems: list[tuple[str, str]] = []
    for name, read in recordings:
        try:
            walks.append(inputs_of(analyze(read()), person, known_length_m))
        except InputError as error:
            problems.append((name, str(error)))
    rows = [
        row_of(method, measure(method, walks), known_length_m)
        for question, measure in ((Question.POSITION, _paths), (Question.LENGTH, _sums))
        for method in of(question)
    ]
    return Cohort(known_length_m, len(walks) + len(problems), tuple(rows), tuple(problems))


def _feet(walks: Sequence[Inputs]) -> list[tuple[int, Inputs, Side]]:
    return [(k, walk, side) for k, walk in enumerate(walks) for side in walk.feet]


def _paths(method: Method, walks: Sequence[Inputs]) -> Floats:
    """Length of the path of every foot by a position method."""
    found = []
    for _, walk, side in _feet(walks):
        ready = not missing(method, walk, side)
        track = method.run(walk.feet[side]) if ready else None
        found.append(closing_of(track).path_m if track is not None and len(track.time_s) > 1 else np.nan)
    return np.array(found)


def _sums(method: Method, walks: Sequence[Inputs]) -> Floats:
    """Sum of the strides of every foot by a step-length model, its factors from the other recordings."""
    found = []
    for k, walk, side in _feet(walks):
        steps = walk.strides[side]
        others = [
            KnownWalk(other.strides[foot], walk.known_length_m or np.nan)
            for j, other, foot in _feet(walks)
            if j != k and len(other.strides[foot])
        ]
        lacks = missing(method, walk, side) or (Need.KNOWN_LENGTH in method.needs and not others)
        if lacks or not len(steps):
            found.append(np.nan)
            continue
        factors = calibrate(method, others, walk.person)
        found.append(distance_m(method.run(steps, walk.person, factors)))
    return np.array(found)
