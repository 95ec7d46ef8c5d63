"""``gaitlab methods``: what the catalogue holds."""

from __future__ import annotations

import argparse
import json
import textwrap
from collections.abc import Sequence
from typing import Any

from gaitlab.methods.catalogue import catalogue, named
from gaitlab.methods.model import Method

WIDTH = 110


def run(chosen: argparse.Namespace) -> int:
    """Print the catalogue, or everything about the methods of one name."""
    methods = named(chosen.name) if chosen.name else tuple(catalogue().values())
    if chosen.json:
        print(json.dumps({"methods": [as_table(one) for one in methods]}, ensure_ascii=False, indent=2))
    elif chosen.name:
        print("\n\n".join(described(one) for one in methods))
    else:
        print(listed(methods))
    return 0


def as_table(method: Method) -> dict[str, Any]:
    """A method as JSON holds it."""
    return {
        "name": method.name,
        "question": method.question.value,
        "title": method.title,
        "reference": method.reference,
        "needs": [need.value for need in method.needs],
        "constants": [vars(constant) for constant in method.constants],
        "deviations": list(method.deviations),
    }


def listed(methods: Sequence[Method]) -> str:
    """A text table, the methods of each question under it."""
    rows = [(one.name, one.title, ", ".join(one.needs), one.reference) for one in methods]
    widths = [max((len(row[k]) for row in rows), default=0) for k in range(3)]
    lines: list[str] = []
    question = None
    for method, row in zip(methods, rows, strict=True):
        if method.question is not question:
            question = method.question
            lines += ["", question.value] if lines else [question.value]
        cells = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False))
        lines.append(f"  {cells}  {row[3]}")
    return "\n".join(lines)


def described(method: Method) -> str:
    """Everything about one method."""
    lines = [f"{method.name}: {method.question}", f"  {method.title}"]
    lines += [f"  reference  {method.reference}", f"  needs      {', '.join(method.needs) or 'nothing'}"]
    if method.constants:
        lines.append("  constants")
        lines += [
            f"    {one.name} = {one.value:g}{f' {one.unit}' if one.unit else ''}  ({one.source})"
            for one in method.constants
        ]
    lines.append("  deviations" if method.deviations else "  deviations none")
    for text in method.deviations:
        lines.append(textwrap.fill(text, WIDTH, initial_indent="    - ", subsequent_indent="      "))
    return "\n".join(lines)
