"""The constants of a method: written once, in the dataclass that its function uses, and listed from there."""

from __future__ import annotations

from dataclasses import field, fields
from typing import Any

from gaitlab.methods.model import Constant


def constant(value: float, unit: str, source: str) -> Any:
    """A field of a params dataclass: its default, its unit, and where it comes from."""
    return field(default=value, metadata={"unit": unit, "source": source})


def constants_of(*params: Any) -> tuple[Constant, ...]:
    """The constants that params dataclasses, or instances of them, hold; fields without a unit are none."""
    return tuple(
        Constant(one.name, getattr(kind, one.name), one.metadata["unit"], one.metadata["source"])
        for kind in params
        for one in fields(kind)
        if "unit" in one.metadata
    )
