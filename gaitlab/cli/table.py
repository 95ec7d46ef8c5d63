"""A result as text in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from gaitlab.gait.definitions import GROUPS
from gaitlab.result import Parameter, Result

SIDES = ("left", "right", "both")


def print_result(result: Result) -> None:
    """Print the parameters by group, and the warnings."""
    for group, title in GROUPS.items():
        names = list(dict.fromkeys(p.name for p in result.parameters if p.group == group))
        if not names:
            continue
        print(f"\n{title:<30}{'left':>18}{'right':>18}{'both':>18}")
        for name in names:
            _print_row([p for p in result.parameters if p.name == name])
    _print_reasons(result)
    for warning in result.warnings:
        worn = (warning.placement or "").replace("_", " ")
        print(f"! {warning.message}" if worn in warning.message else f"! {worn}: {warning.message}")


def _print_row(same: Sequence[Parameter]) -> None:
    by_side: dict[str, Parameter] = {p.side: p for p in same}
    unit = same[0].unit
    cells = "".join(f"{_cell(by_side.get(side)):>18}" for side in SIDES)
    print(f"  {f'{same[0].label} [{unit}]':<28}{cells}")


def _cell(parameter: Parameter | None) -> str:
    if parameter is None:
        return ""
    if parameter.value is None:
        return "—"
    mark = "*" if parameter.status == "attention" else ""
    digits = parameter.decimals
    shown = max(parameter.sd or 0.0, 10.0**-digits)  # never as zero
    return f"{parameter.value:.{digits}f} ± {shown:.{digits}f}{mark}"


def _print_reasons(result: Result) -> None:
    """Once for each reason: which parameters it concerns."""
    concerned: dict[tuple[str, str], list[str]] = {}
    for p in result.parameters:
        if p.status != "ok" and p.reason:
            mark = "—" if p.value is None else "*"
            side = "" if p.side == "both" else f" {p.side}"
            concerned.setdefault((mark, p.reason), []).append(f"{p.label.lower()}{side}")
    if concerned:
        print()
    for (mark, reason), names in concerned.items():
        print(f"{mark} {', '.join(names)}: {reason}")
