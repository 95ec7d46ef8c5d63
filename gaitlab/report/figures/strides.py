"""Every stride at a glance: its length with its uncertainty, left and right."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.gait.measurement import TWO_SIDED_95
from gaitlab.recording.model import Floats, Side
from gaitlab.report.figures.canvas import Panel, Sheet, padded
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.report.figures.style import FULL_WIDTH_PT, SIDES, Stroke
from gaitlab.result import Stride

MOST_STRIDES = 120
_LEFT_PT, _BOTTOM_PT, _HIGH_PT = 30.0, 16.0, 76.0


def strides(scene: Scene) -> Figure | None:
    """Stride lengths over time with their 95 % intervals; strides of a turn are hollow."""
    feet = {Side(side): foot.strides for side, foot in sorted(scene.result.feet.items())}
    feet = {side: found for side, found in feet.items() if found}
    if not feet:
        return None
    together = max(1, -(-max(len(found) for found in feet.values()) // MOST_STRIDES))
    points = {side: _points(found, together) for side, found in feet.items()}
    time, length, half, _ = np.vstack(list(points.values())).T
    sheet = Sheet(FULL_WIDTH_PT, _BOTTOM_PT + _HIGH_PT + 28)
    box = (_LEFT_PT, _BOTTOM_PT, FULL_WIDTH_PT - _LEFT_PT - 12, _HIGH_PT)
    panel = Panel(
        sheet, box, padded(*_range(time), 0.02), padded(*_range(np.append(length - half, length + half)))
    )
    panel.scale_y("m")
    panel.scale_x("s")
    for side, rows in points.items():
        _draw(panel, rows, SIDES[side])
    sheet.keys(sheet.height_pt - 9, [SIDES[side] for side in points])
    each = (
        "Each mark is one stride, at the middle of its time"
        if together == 1
        else f"Each mark is the mean of {together} neighbouring strides"
    )
    return sheet.to_figure(
        scene,
        name="strides",
        title="Stride lengths",
        caption=f"{each}; the bar is its 95 % interval. Hollow: strides that belong to a turn.",
        alt=" ".join(_sentence(side, found) for side, found in feet.items()),
        wide=True,
    )


def _range(values: Floats) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _points(found: Sequence[Stride], together: int) -> Floats:
    """Rows of (time, length, half interval, turning), the means of ``together`` strides a row.

    The intervals are averaged, not shrunk: strides share a part of their error.
    """
    rows = np.array(
        [
            ((s.start_s + s.end_s) / 2, s.length_m, TWO_SIDED_95 * s.length_sd_m, float(s.turning))
            for s in found
        ]
    )
    groups = np.arange(0, len(rows), together)
    count = np.diff(np.append(groups, len(rows)))[:, None]
    means: Floats = np.add.reduceat(rows, groups, axis=0) / count
    return means


def _draw(panel: Panel, rows: Floats, stroke: Stroke) -> None:
    x, turning = panel.across(rows[:, 0]), rows[:, 3] > 0.5
    panel.sheet.segments(x, panel.up(rows[:, 1] - rows[:, 2]), panel.up(rows[:, 1] + rows[:, 2]), stroke)
    for chosen, hollow in ((~turning, False), (turning, True)):
        if chosen.any():
            panel.sheet.marks(x[chosen], panel.up(rows[chosen, 1]), stroke, hollow=hollow, size=4.2)


def _sentence(side: Side, found: Sequence[Stride]) -> str:
    straight = [s.length_m for s in found if not s.turning]
    turning = len(found) - len(straight)
    spread = f", lengths from {min(straight):.2f} m to {max(straight):.2f} m" if straight else ""
    return f"{side.capitalize()} foot: {len(straight)} strides straight on{spread}, and {turning} in turns."
