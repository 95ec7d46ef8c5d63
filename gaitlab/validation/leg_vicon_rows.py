"""The rows of one leg under cameras."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.validation.knee_path import KneeCheck, rms
from gaitlab.validation.leg_vicon_check import METHODS, SEGMENTS, LegCheck
from gaitlab.validation.model import Cell, Column, Details, Goal, Row
from gaitlab.validation.optical import STRIDE_COLUMNS, coverage_row, joined, length_row
from gaitlab.validation.statistics import CM, figure

_PLACE = {"shank": "upper shank", "thigh": "thigh"}


def rows_of(legs: Sequence[LegCheck]) -> tuple[Row, ...]:
    """Rows 1, 8 and 9."""
    own = [leg.strides for leg in legs]
    device = [leg.device_strides.error_m for leg in legs if leg.device_strides is not None]
    what = "stride length against the optical mid-foot"
    goals = (Goal("MAE", high=0.8), Goal("SD", high=1.2))
    rows = [length_row("stride_length", what, joined([one.error_m for one in own]), 1, goals)]
    straight = joined([one.error_m[~one.turning] for one in own])
    rows.append(length_row("stride_length_straight", "  the same, strides that do not turn", straight))
    lever = joined([one.at_point_m - one.optical_m for one in own])
    rows.append(
        length_row("stride_length_lever", "  the same, one constant lever arm to the mid-foot", lever)
    )
    if device:
        rows.append(
            length_row("stride_length_device", "  the same with the device's orientation", joined(device))
        )
    rows.append(coverage_row("stride_length_covered", own))
    for segment in SEGMENTS:
        for method in METHODS:
            checks = [leg.knees[segment, method] for leg in legs if (segment, method) in leg.knees]
            if checks:
                rows += _knee_rows(segment, method, checks)
    return tuple(rows)


def _knee_rows(segment: str, method: str, checks: Sequence[KneeCheck]) -> list[Row]:
    """Row 9 for one sensor and method; the method of the paper is shown beside it and has no goal."""
    ours = method == METHODS[0]
    first = joined([check.first.error_m for check in checks])
    mean = joined([check.mean.error_m for check in checks])
    what = f"knee path against the optical knee, {_PLACE[segment]}" if ours else f"  the same by {method}"
    figures = (
        figure("3D RMS", rms(first), CM),
        figure("horizontal", rms(first[:, :2]), CM),
        figure("3D about the mean", rms(mean), CM),
    )
    goals = (Goal("3D RMS", high=3.0),) if ours else ()
    n = sum(len(check) for check in checks)
    return [Row(f"knee_{segment}_{method}", what, figures, n, "cycles", 9 if ours else None, goals)]


def details_of(legs: Sequence[LegCheck]) -> tuple[Details, ...]:
    """One row a stride, one row a gait cycle of each knee."""
    span = (Column("start", "s", 2), Column("end", "s", 2))
    knee_columns = (
        Column("recording"),
        Column("side"),
        Column("sensor"),
        Column("method"),
        *span,
        Column("3D RMS", "cm", 2),
        Column("horizontal", "cm", 2),
        Column("3D about the mean", "cm", 2),
        Column("lever arm", "cm", 1),
    )
    strides: list[tuple[Cell, ...]] = []
    knees: list[tuple[Cell, ...]] = []
    for leg in legs:
        here = (leg.recording, leg.side.value)
        strides += [(*here, *leg.strides.detail(k)) for k in range(len(leg.strides.length_m))]
        for (segment, method), check in leg.knees.items():
            knees += [(*here, segment, method, *_cycle(check, k)) for k in range(len(check))]
    return (
        Details("strides", STRIDE_COLUMNS, tuple(strides)),
        Details("gait cycles of the knee", knee_columns, tuple(knees)),
    )


def _cycle(check: KneeCheck, k: int) -> tuple[Cell, ...]:
    rows = check.cycle == k
    first, mean = check.first.error_m[rows], check.mean.error_m[rows]
    lever = float(np.linalg.norm(check.first.lever_m))
    numbers = (rms(first), rms(first[:, :2]), rms(mean), lever)
    return (float(check.start_s[k]), float(check.end_s[k]), *(100.0 * number for number in numbers))
