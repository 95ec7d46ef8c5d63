"""Forms that people fill in: what was typed stays; each problem stands beside its field in plain words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from starlette.datastructures import FormData

from api.errors import Problem

Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class Typed:
    """A form as it was typed: values and problems by field name, and a problem of the whole."""

    values: Mapping[str, str] = field(default_factory=dict)
    errors: Mapping[str, str] = field(default_factory=dict)
    problem: Problem | None = None

    def value(self, name: str) -> str:
        return self.values.get(name, "")

    def error(self, name: str) -> str:
        return self.errors.get(name, "")

    def with_problem(self, problem: Problem) -> Typed:
        """The same form with a problem, beside its field if it has that field."""
        if problem.column is not None and problem.column in self.values and problem.file is None:
            message = f"{problem.detail} {problem.hint}".strip()
            return Typed(self.values, {**self.errors, problem.column: message}, self.problem)
        return Typed(self.values, self.errors, problem)


def typed(form: FormData, names: tuple[str, ...], *, never_kept: tuple[str, ...] = ()) -> Typed:
    """The text fields of a form, without blanks around them; fields ``never_kept`` are known, but come back empty."""
    kept = {name: str(form.get(name, "")).strip() for name in names}
    return Typed({**kept, **dict.fromkeys(never_kept, "")})


def decimal(text: str) -> str | None:
    """A number as typed, with a decimal point or comma; None where the field is empty."""
    # Python's own digit groups (1_70) are no way in which people write numbers.
    return text.replace(",", ".").replace("−", "-").replace("_", "?") or None


def check(model: type[Model], data: Mapping[str, Any]) -> tuple[Model | None, dict[str, str]]:
    """Validate a form: the model, or what is wrong with each field."""
    try:
        return model.model_validate(dict(data)), {}
    except ValidationError as problem:
        found = problem.errors(include_url=False, include_input=False)
        return None, {str(one["loc"][0]) if one["loc"] else "": _in_words(one) for one in found}


_WORDS = {
    "missing": "Please fill this in.",
    "string_too_short": "Please fill this in.",
    "string_too_long": "At most {max_length} characters.",
    "float_parsing": "This must be a number.",
    "float_type": "Please fill this in.",
    "int_parsing": "This must be a whole number.",
    "int_from_float": "This must be a whole number.",
    "greater_than_equal": "At least {ge:g}.",
    "less_than_equal": "At most {le:g}.",
    "finite_number": "This must be a number.",
    "date_from_datetime_parsing": "This must be a day, such as 2026-11-21.",
    "date_parsing": "This must be a day, such as 2026-11-21.",
    "literal_error": "Choose one of the list.",
}


def _in_words(error: Any) -> str:
    words = _WORDS.get(error["type"])
    if words is not None:
        return words.format(**error.get("ctx", {}))
    message: str = error["msg"].removeprefix("Value error, ")
    return f"This {message}." if message.startswith("must") else f"{message}."
