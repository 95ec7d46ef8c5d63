"""The catalogue: every ``METHOD`` or ``METHODS`` that a file of this package defines. A further method is a further file."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache

import gaitlab.methods
from gaitlab.errors import InputError
from gaitlab.methods.model import Method, Question


@cache
def catalogue() -> dict[str, Method]:
    """All methods by name, in the order of their questions."""
    found: list[Method] = []
    for module in pkgutil.walk_packages(gaitlab.methods.__path__, "gaitlab.methods."):
        loaded = importlib.import_module(module.name)
        found += [loaded.METHOD] if hasattr(loaded, "METHOD") else []
        found += getattr(loaded, "METHODS", ())
    order = list(Question)
    found.sort(key=lambda method: (order.index(method.question), method.name))
    by_name = {method.name: method for method in found}
    if len(by_name) != len(found):
        raise RuntimeError("two methods of one name")
    return by_name


def of(question: Question) -> tuple[Method, ...]:
    """The methods that answer a question."""
    return tuple(method for method in catalogue().values() if method.question is question)


def method(name: str) -> Method:
    """The method of that name.

    Raises
    ------
    InputError
        ``unknown_method``, naming those there are.
    """
    known = catalogue()
    if name not in known:
        raise InputError(
            "unknown_method", f"There is no method {name!r}.", f"Choose from: {', '.join(known)}."
        )
    return known[name]
