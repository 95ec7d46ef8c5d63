"""The rows of one leg under cameras."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.recording.model import Floats
from gaitlab.validation.knee_path import KneeCheck, rms
from gaitlab.validation.leg_vicon import METHODS, SEGMENTS, LegCheck
from gaitlab.validation.model import Cell, Column, Details, Goal, Row
from gaitlab.validation.optical import StrideCheck
from gaitlab.validation.statistics import CM, figure, mean_absolute, mean_and_sd, share

_PLACE = {"shank": "sensor on the upper shank", "thigh": "sensor on the thigh"}


def rows_of(legs: Sequence[LegCheck]) -> tuple[Row, ...]:
    """Rows 1, 8 and 9."""
    own = [leg.strides for leg in legs]
    device = [leg.device_strides for leg in legs if leg.device_strides is not None]
    what = "stride length against the optical mid-foot"
    goals = (Goal("MAE", high=0.8), Goal("SD", high=1.2))
    rows = [_length_row("stride_length", what, own, 1, goals)]
    if device:
        rows.append(_length_row("stride_length_device", "  the same with the device's orientation", device))
    rows.append(_coverage_row(own))
    for segment in SEGMENTS:
        for method in METHODS:
            checks = [leg.knees[segment, method] for leg in legs if (segment, method) in leg.knees]
            if checks:
                rows += _knee_rows(segment, method, checks)
    return tuple(rows)


def _length_row(
    key: str,
    what: str,
    checks: Sequence[StrideCheck],
    target: int | None = None,
    goals: tuple[Goal, ...] = (),
) -> Row:
    errors = _joined([check.error_m for check in checks])
    figures = (*mean_and_sd(errors, CM), mean_absolute(errors, CM))
    return Row(key, what, figures, len(errors), "strides", target, goals)


def _coverage_row(checks: Sequence[StrideCheck]) -> Row:
    covered = _joined([check.covered.astype(np.float64) for check in checks])
    sd = _joined([check.sd_m for check in checks])
    return Row(
        "stride_length_covered",
        "95 % interval of a stride length covers the optical one",
        (
            share("covered", int(covered.sum()), len(covered)),
            figure("median SD", float(np.median(sd)) if len(sd) else float("nan"), CM),
        ),
        len(covered),
        "strides",
        8,
        (Goal("covered", low=90.0, high=99.0),),
    )


def _knee_rows(segment: str, method: str, checks: Sequence[KneeCheck]) -> list[Row]:
    """Row 9 for one sensor and method; the method of the paper is shown beside it and has no goal."""
    ours = method == METHODS[0]
    first = _joined([check.first.error_m for check in checks])
    mean = _joined([check.mean.error_m for check in checks])
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
    place = (Column("recording"), Column("side"))
    span = (Column("start", "s", 2), Column("end", "s", 2))
    stride_columns = (
        *place,
        *span,
        Column("ours", "cm", 2),
        Column("SD", "cm", 2),
        Column("optical", "cm", 2),
        Column("error", "cm", 2),
        Column("covered"),
        Column("turning"),
    )
    knee_columns = (
        *place,
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
        Details("strides", stride_columns, tuple(strides)),
        Details("gait cycles of the knee", knee_columns, tuple(knees)),
    )


def _cycle(check: KneeCheck, k: int) -> tuple[Cell, ...]:
    rows = check.cycle == k
    first, mean = check.first.error_m[rows], check.mean.error_m[rows]
    lever = float(np.linalg.norm(check.first.lever_m))
    numbers = (rms(first), rms(first[:, :2]), rms(mean), lever)
    return (float(check.start_s[k]), float(check.end_s[k]), *(100.0 * number for number in numbers))


def _joined(parts: Sequence[Floats]) -> Floats:
    return np.concatenate(parts) if parts else np.zeros(0)
