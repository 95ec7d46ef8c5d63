"""A comparison as text for people and as JSON for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence

from gaitlab import __version__
from gaitlab.comparison.cohorts import Cohort
from gaitlab.comparison.model import Answer, Comparison, Difference, Line, Value
from gaitlab.recording.model import Side

SCHEMA = "gaitlab.comparison/1"


def number(value: float, decimals: int, *, signed: bool = False) -> str:
    """With fixed decimals; a dash where nothing determines it, and no minus before a zero."""
    if not math.isfinite(value):
        return "–"
    rounded = round(value, decimals) + 0.0
    text = f"{rounded:+.{decimals}f}" if signed else f"{rounded:.{decimals}f}"
    return text.replace("-", "−")


def value_text(one: Value) -> str:
    """``mean stride 1.42 m``."""
    return " ".join(p for p in (one.name, number(one.value, one.decimals, signed=one.signed), one.unit) if p)


def answer_text(answer: Answer | None) -> str:
    """All numbers of one side, or why there are none."""
    if answer is None:
        return ""
    return ", ".join(value_text(one) for one in answer.values) or answer.reason


def difference_text(one: Difference | None) -> str:
    """``+1.2 ± 0.4 cm``, the interval being 95 %; a dash where there are no pairs, no interval for one."""
    if one is None:
        return ""
    if not math.isfinite(one.mean):
        return "–"
    mean = number(one.mean, one.decimals, signed=True)
    if not math.isfinite(one.half_width):
        return f"{mean} {one.unit}"
    return f"{mean} ± {number(one.half_width, one.decimals)} {one.unit}"


def to_text(comparison: Comparison) -> str:
    """All tables."""
    parts = []
    for table in comparison.tables:
        what = next((line.difference for line in table.lines if line.difference is not None), None)
        over = f"; difference to ours: {what.of}, mean and 95 % interval over {what.pairs}" if what else ""
        lines = [f"{table.question}{over}", ""]
        for line in table.lines:
            lines += _line(line)
        parts.append("\n".join(lines))
    known = comparison.known_length_m
    told = "" if known is None else f", factors of step-length models from a walk of {known:g} m"
    return "\n\n".join(parts) + f"\n\n{comparison.seconds:.2f} s in all{told}\n"


def _line(line: Line) -> list[str]:
    took = "" if math.isnan(line.seconds) else f"{1000.0 * line.seconds:.1f} ms"
    head = f"  {line.method.name:<28}{difference_text(line.difference):<22}{took:>9}  {line.reason}".rstrip()
    rows = [head]
    for side in Side:
        answer = line.answer(side)
        if answer is not None:
            rows.append(f"    {side:<6} {answer_text(answer)}")
            if answer.values and answer.reason:
                rows.append(f"           {answer.reason}")
    return rows


def to_json(comparison: Comparison) -> str:
    """The same, with the places and the stride lengths; null where nothing determines a number."""
    document = {
        "schema": SCHEMA,
        "gaitlab": __version__,
        "known_length_m": comparison.known_length_m,
        "seconds": _finite(comparison.seconds),
        "questions": {
            table.question.value: [_line_json(line) for line in table.lines] for table in comparison.tables
        },
        "paths": [
            {"method": one.method, "side": one.side.value, "place_m": _finite(one.place_m.tolist())}
            for one in comparison.paths
        ],
        "stride_lengths": [
            {"method": one.method, "side": one.side.value, "length_m": _finite(one.length_m.tolist())}
            for one in comparison.lengths
        ],
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _line_json(line: Line) -> dict[str, object]:
    difference = line.difference
    return {
        "method": line.method.name,
        "title": line.method.title,
        "reference": line.method.reference,
        "deviations": list(line.method.deviations),
        "sides": {
            answer.side.value: {
                "values": {
                    one.name: {"value": _finite(one.value), "unit": one.unit} for one in answer.values
                },
                "reason": answer.reason,
            }
            for answer in line.answers
        },
        "difference_to_ours": None
        if difference is None
        else {
            "of": difference.of,
            "mean": _finite(difference.mean),
            "half_width_95": _finite(difference.half_width),
            "unit": difference.unit,
            "n": difference.n,
            "pairs": difference.pairs,
        },
        "seconds": _finite(line.seconds),
        "reason": line.reason,
        "failed": line.failed,
    }


def _finite(value: object) -> object:
    if isinstance(value, list):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def cohort_text(found: Cohort) -> str:
    """Mean, SD and relative error of every method (İkizoğlu et al. 2018, eq. 4–6)."""
    head = ("question", "method", "mean", "SD", "error", "feet")
    rows: list[Sequence[str]] = [head]
    for one in found.rows:
        rows.append(
            (
                one.method.question.value,
                one.method.name,
                f"{number(one.mean_m, 2)} m",
                f"{number(one.sd_m, 2)} m",
                f"{number(one.error_percent, 1, signed=True)} %",
                f"{one.n} of {one.of}",
            )
        )
    widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
    lines = [f"{found.recordings} recordings of {found.known_length_m:g} m", ""]
    for row in rows:
        cells = [
            c.rjust(w) if k > 1 else c.ljust(w) for k, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    lines += [f"! {name}: {reason}" for name, reason in found.problems]
    return "\n".join(lines) + "\n"


def cohort_json(found: Cohort) -> dict[str, object]:
    """The same for JSON."""
    return {
        "schema": "gaitlab.cohort/1",
        "gaitlab": __version__,
        "known_length_m": found.known_length_m,
        "recordings": found.recordings,
        "methods": [
            {
                "question": one.method.question.value,
                "method": one.method.name,
                "mean_m": _finite(one.mean_m),
                "sd_m": _finite(one.sd_m),
                "error_percent": _finite(one.error_percent),
                "n": one.n,
                "of": one.of,
            }
            for one in found.rows
        ],
        "problems": [{"recording": name, "reason": reason} for name, reason in found.problems],
    }
