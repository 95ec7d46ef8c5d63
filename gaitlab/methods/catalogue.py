"""The catalogue: every ``METHOD`` or ``METHODS`` that a file of this package defines. A further method is a further file."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache

import gaitlab.methods
from gaitlab.errors import InputError
from gaitlab.methods.model import Method, Question


@cache
def catalogue() -> dict[tuple[Question, str], Method]:
    """All methods by question and name, in the order of their questions; a name says what is meant within a question."""
    found: list[Method] = []
    for module in pkgutil.walk_packages(gaitlab.methods.__path__, "gaitlab.methods."):
        loaded = importlib.import_module(module.name)
        found += [loaded.METHOD] if hasattr(loaded, "METHOD") else []
        found += getattr(loaded, "METHODS", ())
    order = list(Question)
    found.sort(key=lambda method: (order.index(method.question), method.name))
    by_name = {(method.question, method.name): method for method in found}
    if len(by_name) != len(found):
        raise RuntimeError("two methods of one name answer one question")
    return by_name


def of(question: Question) -> tuple[Method, ...]:
    """The methods that answer a question."""
    return tuple(method for method in catalogue().values() if method.question is question)


def named(name: str) -> tuple[Method, ...]:
    """The methods of that name: one paper may answer several questions.

    Raises
    ------
    InputError
        ``unknown_method``, naming those there are.
    """
    found = tuple(method for method in catalogue().values() if method.name == name)
    if not found:
        known = dict.fromkeys(method.name for method in catalogue().values())
        raise InputError(
            "unknown_method", f"There is no method {name!r}.", f"Choose from: {', '.join(known)}."
        )
    return found


def method(name: str, question: Question | None = None) -> Method:
    """The method of that name that answers a question; without a question the name must tell.

    Raises
    ------
    InputError
        ``unknown_method``, naming those there are; ``which_question`` where the name answers several.
    """
    found = tuple(one for one in named(name) if question in (None, one.question))
    if not found:
        choices = ", ".join(one.name for one in of(question)) if question else ""
        raise InputError(
            "unknown_method", f"No method {name!r} answers {question}.", f"Choose from: {choices}."
        )
    if len(found) > 1:
        answered = ", ".join(one.question for one in found)
        raise InputError("which_question", f"{name!r} answers several questions: {answered}.", "Say which.")
    return found[0]
