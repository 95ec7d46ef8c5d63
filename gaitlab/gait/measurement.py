"""One number of a report: value, uncertainty, evidence and definition together."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import StrEnum

TWO_SIDED_95 = 1.959964


class Status(StrEnum):
    """May the value be used?"""

    OK = "ok"
    ATTENTION = "attention"
    NOT_DETERMINABLE = "not_determinable"


class MeasuredSide(StrEnum):
    """What a value speaks of: one side, or both together."""

    LEFT = "left"
    RIGHT = "right"
    BOTH = "both"


@dataclass(frozen=True)
class Definition:
    """What a parameter means, the same for every patient.

    ``decimals`` bounds how finely people read the value; ``group`` is its place in a table; only ``signed`` values and
    intervals can lie below zero.
    """

    name: str
    label: str
    unit: str
    group: str
    text: str
    reference: str
    decimals: int
    signed: bool = False


@dataclass(frozen=True)
class Measurement:
    """A parameter's value for one side.

    Attributes
    ----------
    value : float or None
        In the definition's unit; None where it is not determinable.
    sd : float or None
        Standard uncertainty of ``value`` (not the scatter between strides).
    n : int
        How many strides, steps or instants it rests on.
    reason : str
        Why it wants attention or is not determinable; or the assumption it rests on.
    interval : tuple of 2 floats or None
        Its 95 % interval where that is not ``value`` ± 1.96 ``sd``.
    common_sd : float
        The part of ``sd`` that more strides do not make smaller.
    """

    definition: Definition
    side: MeasuredSide
    value: float | None
    sd: float | None
    n: int
    status: Status = Status.OK
    reason: str = ""
    interval: tuple[float, float] | None = None
    common_sd: float = 0.0

    @property
    def ci95(self) -> tuple[float, float] | None:
        """The interval that holds the true value with a probability of 95 %."""
        if self.value is None or self.sd is None:
            return None
        if self.interval is not None:
            return self.interval
        low, high = self.value - TWO_SIDED_95 * self.sd, self.value + TWO_SIDED_95 * self.sd
        return (low if self.definition.signed else max(low, min(0.0, self.value))), high

    def with_attention(self, reason: str) -> Measurement:
        """The same value, marked: it may be used with the stated reserve."""
        if self.status is Status.NOT_DETERMINABLE:
            return self
        joined = f"{self.reason} {reason}".strip() if self.reason else reason
        return replace(self, status=Status.ATTENTION, reason=joined)


def not_determinable(definition: Definition, side: MeasuredSide, reason: str, n: int = 0) -> Measurement:
    """A parameter that cannot be known from this recording, with the reason."""
    return Measurement(definition, side, None, None, n, Status.NOT_DETERMINABLE, reason)


def measured(
    definition: Definition, side: MeasuredSide, value: float, sd: float | None, n: int, reason: str = ""
) -> Measurement:
    """A parameter with its value; a value that is not finite becomes "not determinable"."""
    if not math.isfinite(value):
        return not_determinable(definition, side, reason or "The computation has no finite result.", n)
    return Measurement(
        definition, side, float(value), None if sd is None else float(sd), n, Status.OK, reason
    )
