"""The rows of shoes under cameras."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.validation.foot_mocap_check import FootCheck, StairCheck
from gaitlab.validation.model import Cell, Column, Details, Figure, Goal, Row
from gaitlab.validation.optical import STRIDE_COLUMNS, coverage_row, joined, length_row
from gaitlab.validation.statistics import M, figure, share

_SATURATED = "strides with a saturated sample, and those of them marked"
LEVEL_M = 0.08
"""A foot that came to rest this much higher or lower than before has changed the level; a stair is about 0.17 m."""


def rows_of(feet: Sequence[FootCheck], stairs: Sequence[StairCheck]) -> tuple[Row, ...]:
    """Row 2 and the climb."""
    return (*(_length_rows(feet) if feet else ()), *(_stair_row(one) for one in stairs))


def _length_rows(feet: Sequence[FootCheck]) -> list[Row]:
    saturated = np.concatenate([foot.saturated for foot in feet])
    marked = np.concatenate([foot.strides.marked for foot in feet])
    reference = np.concatenate([foot.reference_m for foot in feet])
    strides = [foot.strides for foot in feet]
    errors = joined([one.error_m for one in strides])
    what = "stride length against the heel marker, between our rests"
    figures = (
        Figure("saturated", float(saturated.sum()), "", 0),
        share("marked", int((saturated & marked).sum()), int(saturated.sum())),
    )
    marking = (Goal("marked", low=100.0),) if saturated.any() else ()
    rows = [length_row("stride_length_heel", what, errors, 2, (Goal("MAE", high=3.0),))]
    if len(reference):
        apart = reference[:, 0] - reference[:, 1]
        rows.append(length_row("stride_length_published", "  between the published instants", apart))
    rows += [
        Row("stride_saturated", _SATURATED, figures, len(errors), "strides", 2, marking),
        coverage_row("stride_length_heel_covered", strides),
    ]
    return rows


def _stair_row(one: StairCheck) -> Row:
    levels = int(np.sum(np.abs(np.diff(one.height_m)) > LEVEL_M))
    figures = (
        figure("last rest", float(one.height_m[-1]), M, signed=True),
        figure("highest", float(one.height_m.max()), M, signed=True),
        Figure("level changes", float(levels), "", 0),
    )
    what = f"climb of the {one.side} foot above its first rest, {one.recording}"
    return Row(f"climb_{one.recording}_{one.side}", what, figures, len(one.height_m), "rests")


def details_of(feet: Sequence[FootCheck], stairs: Sequence[StairCheck]) -> tuple[Details, ...]:
    """One row a stride; one row a rest on the stairs."""
    stride_columns = (*STRIDE_COLUMNS, Column("saturated"))
    strides: list[tuple[Cell, ...]] = [
        (foot.recording, foot.side.value, *foot.strides.detail(k), "yes" if foot.saturated[k] else "no")
        for foot in feet
        for k in range(len(foot.strides.length_m))
    ]
    rest_columns = (Column("recording"), Column("side"), Column("rest", "", 0), Column("height", "m", 3))
    rests: list[tuple[Cell, ...]] = [
        (one.recording, one.side.value, k, float(height))
        for one in stairs
        for k, height in enumerate(one.height_m)
    ]
    found = [
        Details("strides", stride_columns, tuple(strides)),
        Details("rests on stairs", rest_columns, tuple(rests)),
    ]
    return tuple(one for one in found if one.rows)
