"""One recording by every method of the catalogue, each beside ours."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from types import MappingProxyType

import numpy as np

from gaitlab.analysis import Settings, analyze
from gaitlab.comparison import feet, legs, lengths
from gaitlab.comparison.feet import Said, Timed
from gaitlab.comparison.inputs import Inputs, inputs_of, missing
from gaitlab.comparison.model import Answer, Comparison, Line, QuestionTable, is_ours
from gaitlab.comparison.pairs import Compared, difference_of
from gaitlab.errors import InputError
from gaitlab.methods.catalogue import catalogue, named
from gaitlab.methods.model import Method, Question
from gaitlab.methods.steps_signals import Person
from gaitlab.recording.model import Recording, Side

SHORTEST_WALK_M, LONGEST_WALK_M = 0.5, 10_000.0
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Asker:
    """How a question is put to a method, and what its pairs with ours are."""

    ask: Callable[[Inputs, Method, Side, Timed], Said]
    compared: Compared


ASKERS: Mapping[Question, Asker] = MappingProxyType(
    {
        Question.REST: Asker(feet.rest, feet.REST),
        Question.STEP: Asker(feet.step, feet.STEP),
        Question.LENGTH: Asker(lengths.length, lengths.LENGTH),
        Question.HEADING: Asker(feet.heading, feet.HEADING),
        Question.HEIGHT: Asker(feet.height, feet.HEIGHT),
        Question.POSITION: Asker(feet.position, feet.POSITION),
        Question.KNEE: Asker(legs.knee, legs.KNEE),
        Question.POSTURE: Asker(legs.posture, legs.POSTURE),
        Question.THIGH: Asker(legs.thigh, legs.THIGH),
    }
)
"""A calibration needs a reference displacement, which no recording of a walk brings."""


def compare(
    recording: Recording,
    settings: Settings | None = None,
    known_length_m: float | None = None,
    person: Person | None = None,
    names: Sequence[str] | None = None,
) -> Comparison:
    """Run every method on a recording and lay what it says beside ours.

    Parameters
    ----------
    settings : Settings or None
        Of our own analysis; its method is always gaitlab's.
    known_length_m : float or None
        How far each foot went from its first rest to its last, measured otherwise: it sets the factors of the step-length
        models, whose sum it then is by definition.
    person : Person or None
    names : sequence of str or None
        Only the methods of these names, and ours.

    Raises
    ------
    InputError
        ``unknown_method``, ``known_length``, ``height``; and as ``analyze``.
    """
    began = perf_counter()
    person = person or Person()
    _check(known_length_m, person)
    chosen = _chosen(names)
    analysis = analyze(recording, replace(settings or Settings(), method="gaitlab"))
    inputs = inputs_of(analysis, person, known_length_m)
    said = {id(method): _ask(inputs, method) for method in chosen}
    tables = tuple(
        QuestionTable(question, tuple(said[id(one)][0] for one in chosen if one.question is question))
        for question in Question
        if any(one.question is question for one in chosen)
    )
    every = [one for _, sides in said.values() for one in sides]
    return Comparison(
        analysis,
        tables,
        tuple(one.path for one in every if one.path is not None),
        tuple(one.lengths for one in every if one.lengths is not None),
        known_length_m,
        perf_counter() - began,
    )


def _check(known_length_m: float | None, person: Person) -> None:
    if known_length_m is not None and not SHORTEST_WALK_M <= known_length_m <= LONGEST_WALK_M:
        raise InputError(
            "known_length", "The known length must be between 0.5 m and 10 km.", "Give it in metres."
        )
    if person.height_m is not None and not 0.4 <= person.height_m <= 2.6:
        raise InputError("height", "The height must be between 0.4 m and 2.6 m.", "Give it in metres.")


def _chosen(names: Sequence[str] | None) -> tuple[Method, ...]:
    """The methods asked for and ours of the same questions; by question, ours first, then as in the catalogue."""
    order = list(Question)
    everything = sorted(
        catalogue().values(), key=lambda method: (order.index(method.question), not is_ours(method))
    )
    if names is None:
        return tuple(everything)
    wanted = {id(method) for name in names for method in named(name)}
    questions = {method.question for method in everything if id(method) in wanted}
    return tuple(
        method
        for method in everything
        if id(method) in wanted or (is_ours(method) and method.question in questions)
    )


def _ask(inputs: Inputs, method: Method) -> tuple[Line, list[Said]]:
    """A method on each side that has what it needs. One that breaks does not hide the others."""
    lacking = {side: missing(method, inputs, side) for side in inputs.feet}
    asker = ASKERS.get(method.question)
    ready = [side for side, needs in lacking.items() if not needs]
    if asker is None or not ready:
        needs = dict.fromkeys(need for one in lacking.values() for need in one)
        return Line(method, (), None, np.nan, f"Missing: {', '.join(needs)}."), []
    clock = _Clock()
    try:
        said = [asker.ask(inputs, method, side, clock) for side in ready]
    except Exception as error:
        _log.exception("method %s (%s) failed", method.name, method.question)
        reason = f"The method failed on this recording ({type(error).__name__}); the others are not affected."
        return Line(method, (), None, np.nan, reason, failed=True), []
    answers = [Answer(side, one.values, one.reason) for side, one in zip(ready, said, strict=True)]
    answers += [Answer(side, (), f"Missing: {', '.join(needs)}.") for side, needs in lacking.items() if needs]
    pairs = [one.pairs for one in said if one.pairs is not None]
    difference = difference_of(asker.compared, pairs) if pairs and not is_ours(method) else None
    return Line(method, tuple(answers), difference, clock.seconds), said


class _Clock:
    """Calls methods and adds up the time they take."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def __call__(self, method: Method, *given: object) -> object:
        began = perf_counter()
        try:
            return method.run(*given)
        finally:
            self.seconds += perf_counter() - began
