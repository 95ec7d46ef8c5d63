"""What a session says of its strides: those that may not be used as they are, and their variability over all trials."""

from __future__ import annotations

from collections.abc import Sequence

from gaitlab.gait.variability import Spread, pooled, variability
from gaitlab.outcome import parameter_of
from gaitlab.recording.model import Side
from gaitlab.report.document import ParameterTable, StatusCode, StrideRow
from gaitlab.report.parameters import parameter_table
from gaitlab.report.wording import decimals_for, number, uncertainty, with_unit
from gaitlab.result import Quality, Result, StrideSpread

STATUS_OF: dict[Quality, StatusCode] = {
    "valid": "ok",
    "attention": "attention",
    "invalid": "not_determinable",
}
"""How a quality is drawn."""
MOST_STRIDES = 20


def stride_rows(result: Result) -> tuple[StrideRow, ...]:
    """The strides that want attention or are invalid, in order of time, the first ``MOST_STRIDES``."""
    rows = []
    for side, foot in result.feet.items():
        for stride in foot.strides:
            if stride.quality == "valid":
                continue
            decimals = decimals_for(stride.length_sd_m, 3)
            length = f"{number(stride.length_m, decimals)} {uncertainty(stride.length_sd_m, decimals)}"
            row = StrideRow(
                foot=side,
                time=with_unit(f"{number(stride.start_s, 2)} to {number(stride.end_s, 2)}", "s"),
                length=with_unit(length, "m"),
                status=STATUS_OF[stride.quality],
                label=stride.quality,
                reason=stride.reason,
            )
            rows.append((stride.start_s, row))
    return tuple(row for _, row in sorted(rows, key=lambda one: one[0])[:MOST_STRIDES])


def pooled_table(results: Sequence[Result]) -> ParameterTable | None:
    """Variability over all trials of a session; None for one trial, or where no trial brings what pooling needs."""
    brought = [one for result in results for one in result.spreads]
    if len(results) < 2 or not brought:
        return None
    kinds = dict.fromkeys((one.name, one.side) for one in brought)
    found: dict[str, dict[Side, Spread]] = {}
    for name, side in kinds:
        same = [_spread(one) for one in brought if (one.name, one.side) == (name, side)]
        found.setdefault(name, {})[Side(side)] = pooled(same)
    title = f"Variability, pooled over the {len(results)} trials"
    return parameter_table(title, [parameter_of(one) for one in variability(found)])


def _spread(one: StrideSpread) -> Spread:
    return Spread(one.n, one.freedom, one.mean, one.observed_sd**2, one.measurement_sd**2)
