"""Numbers in words: the one place where a value gets its digits."""

from __future__ import annotations

import math
from collections.abc import Sequence

from gaitlab.result import Parameter

MINUS, NO_BREAK = "−", "\u00a0"
STATUS_LABELS = {"ok": "ok", "attention": "attention", "not_determinable": "not determinable"}
UNIT_LABELS = {"1": "", "deg": "°", "percent": "%", "m/s2": "m/s²"}


def decimals_for(sd: float | None, most: int) -> int:
    """Decimals that show two digits of the uncertainty, and never more than ``most`` (GUM 7.2.6)."""
    if sd is None or not math.isfinite(sd) or sd <= 0:
        return max(most, 0)
    return max(0, min(most, 1 - math.floor(math.log10(sd))))


def number(value: float, decimals: int) -> str:
    """Fixed decimals, a real minus sign, and no minus before a zero."""
    text = f"{value:.{decimals}f}"
    if float(text) == 0:
        text = f"{0:.{decimals}f}"
    return text.replace("-", MINUS)


def uncertainty(sd: float | None, decimals: int) -> str:
    """``± 0.02``; never shown as zero: at least one unit of the last decimal."""
    if sd is None:
        return ""
    least = 0.0 if sd == 0 else 10.0**-decimals
    return f"±{NO_BREAK}{number(max(sd, least), decimals)}"


def interval(ci95: tuple[float, float] | None, decimals: int) -> str:
    """``1.28 to 1.34``, rounded outwards so that the printed interval is never the narrower one."""
    if ci95 is None:
        return ""
    scale = 10.0**decimals
    low, high = (
        edge(round(bound * scale, 6)) / scale for edge, bound in ((math.floor, ci95[0]), (math.ceil, ci95[1]))
    )
    return f"{number(low, decimals)} to {number(high, decimals)}"


def unit_label(unit: str) -> str:
    """The unit as people write it."""
    return UNIT_LABELS.get(unit, unit)


def with_unit(text: str, unit: str) -> str:
    """A number and its unit on one line; ``°`` stands close."""
    label = unit_label(unit)
    if not label:
        return text
    return f"{text}{label}" if label == "°" else f"{text}{NO_BREAK}{label}"


def common_decimals(same: Sequence[Parameter]) -> int:
    """Decimals for one parameter's values on all sides: those that the least certain of them warrants."""
    known = [decimals_for(p.sd, p.decimals) for p in same if p.value is not None]
    return min(known, default=0)


def spoken(parameter: Parameter, decimals: int) -> str | None:
    """``1.31 ± 0.02 m`` for a sentence; None where it is not determinable."""
    if parameter.value is None:
        return None
    spread = uncertainty(parameter.sd, decimals)
    text = number(parameter.value, decimals)
    return with_unit(f"{text}{NO_BREAK}{spread}" if spread else text, parameter.unit)


def count(n: int, one: str, many: str = "") -> str:
    """``1 stride``, ``14 strides``."""
    return f"{n} {one if n == 1 else many or one + 's'}"


def listed(words: list[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def percent(part: int, whole: int) -> str:
    """A share that says "none" only where there is none."""
    if part == 0 or whole == 0:
        return f"0{NO_BREAK}%"
    share = 100 * part / whole
    return f"under 0.1{NO_BREAK}%" if share < 0.1 else f"{share:.1f}{NO_BREAK}%"
