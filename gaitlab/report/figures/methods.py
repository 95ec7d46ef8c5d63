"""Figures of a comparison of methods: paths over each other, stride lengths as dots, agreement with ours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.comparison import Comparison
from gaitlab.comparison.model import MethodLengths, MethodPath
from gaitlab.gait.measurement import TWO_SIDED_95
from gaitlab.recording.model import Floats, Side
from gaitlab.report.figures.canvas import Panel, Sheet, padded
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.report.figures.style import FULL_WIDTH_PT, INK, MUTED, SIDES, SMALL_PT, Stroke

OURS = "gaitlab"
_OURS = Stroke(OURS, INK, "-", "o")
_OTHERS = (
    ("#0072b2", (0, (5, 1.5)), "s"),
    ("#d55e00", (0, (1.5, 1)), "^"),
    ("#009e73", (0, (6, 1, 1, 1)), "D"),
    ("#b0578d", (0, (3, 1.2)), "v"),
    ("#56b4e9", "-", "x"),
    ("#8a6d00", (0, (8, 2)), "+"),
    ("#566270", (0, (1, 2)), "*"),
)
"""Okabe and Ito's colours; dashes and marks differ too, so that no method is told by its colour alone."""
_LEFT_PT, _RIGHT_PT, _BOTTOM_PT, _KEY_PT = 26.0, 12.0, 16.0, 12.0
_LOWEST_PT, _HIGHEST_PT = 60.0, 260.0
_NAMES_PT, _ROW_PT = 100.0, 15.0
_CELL_PT, _PER_ROW = 74.0, 3
MOST_DOTS = 400
MOST_AWAY = 0.2
"""A path is drawn as far as this share of our own path's extent beyond it: one method that fails must not hide the others."""


def comparison_figures(comparison: Comparison, *, prefix: str = "") -> list[Figure]:
    """The figures that a comparison has data for."""
    scene = Scene(comparison.analysis.result, comparison.analysis.series, prefix)
    made = [paths(scene, comparison, side) for side in Side]
    made += [lengths(scene, comparison), agreement(scene, comparison)]
    return [figure for figure in made if figure is not None]


def paths(scene: Scene, comparison: Comparison, side: Side) -> Figure | None:
    """One foot from above by every position method, axes equal."""
    found = [one for one in comparison.paths if one.side is side]
    if not found:
        return None
    strokes = _strokes([one.method for one in found])
    rows = _key_rows(list(strokes.values()))
    panel = _floor(found, _KEY_PT * len(rows) + 8)
    cut = []
    for one in found:
        ours = one.method == OURS
        x, y = _within(panel, one.place_m, 40)
        panel.sheet.line(x, y, strokes[one.method], 1.5 if ours else 0.9, 3 if ours else 2)
        x, y = _within(panel, one.place_m, 1)
        panel.sheet.marks(x, y, strokes[one.method], size=2.6, hollow=not ours)
        if np.isnan(x).any():
            cut.append(one.method)
    leaves = f" {', '.join(cut)} {'leaves' if len(cut) == 1 else 'leave'} the picture." if cut else ""
    for k, row in enumerate(rows):
        panel.sheet.keys(panel.sheet.height_pt - 9 - _KEY_PT * k, row)
    ends = [f"{one.method} {np.hypot(*one.place_m[-1]):.2f} m" for one in found]
    return panel.sheet.to_figure(
        scene,
        name=f"methods_{side}_foot",
        title=f"Path of the {side} foot by every position method",
        caption="From above, in metres, both axes on one scale, all from one start; marks are the method's own"
        f" stances.{leaves}",
        alt=f"Distance from start to end of the {side} foot: {', '.join(ends)}.",
        wide=True,
    )


def _strokes(names: Sequence[str]) -> dict[str, Stroke]:
    others = [name for name in names if name != OURS]
    strokes = {OURS: _OURS} if OURS in names else {}
    return strokes | {name: Stroke(name, *_OTHERS[k % len(_OTHERS)]) for k, name in enumerate(others)}


def _key_rows(strokes: Sequence[Stroke]) -> list[list[Stroke]]:
    """Strokes in rows that fit the sheet."""
    rows: list[list[Stroke]] = [[]]
    used = 0.0
    for stroke in strokes:
        wide = 30 + 0.57 * SMALL_PT * len(stroke.label)
        if used + wide > FULL_WIDTH_PT and rows[-1]:
            rows.append([])
            used = 0.0
        rows[-1].append(stroke)
        used += wide
    return rows


def _floor(found: Sequence[MethodPath], above_pt: float) -> Panel:
    """A panel on which a metre is as long in x as in y; ours lies in it whole, and what is near to it."""
    floor = np.vstack([one.place_m for one in found])
    ours = np.vstack([one.place_m for one in found if one.method == OURS])
    air = max(0.5, MOST_AWAY * float(np.ptp(ours, axis=0).max()))
    (west, south) = np.maximum(floor.min(axis=0) - 0.3, ours.min(axis=0) - air)
    (east, north) = np.minimum(floor.max(axis=0) + 0.3, ours.max(axis=0) + air)
    wide_pt = FULL_WIDTH_PT - _LEFT_PT - _RIGHT_PT
    per_metre = min(wide_pt / (east - west), _HIGHEST_PT / (north - south))
    high_pt = max(_LOWEST_PT, (north - south) * per_metre)
    room = (0.5 * wide_pt / per_metre, 0.5 * high_pt / per_metre)
    middle = (0.5 * float(west + east), 0.5 * float(south + north))
    x, y = ((m - r, m + r) for m, r in zip(middle, room, strict=True))
    sheet = Sheet(FULL_WIDTH_PT, high_pt + _BOTTOM_PT + above_pt)
    panel = Panel(sheet, (_LEFT_PT, _BOTTOM_PT, wide_pt, high_pt), x, y)
    panel.scale_y("", most=3 if high_pt < wide_pt / 3 else 6)
    panel.scale_x("m", most=8)
    return panel


def _within(panel: Panel, place_m: Floats, parts: int) -> tuple[Floats, Floats]:
    """Points of a path on the sheet, each way between two cut into ``parts``; NaN where they lie outside the panel."""
    steps = np.arange((len(place_m) - 1) * parts + 1) / parts
    x, y = (np.interp(steps, np.arange(len(place_m)), axis) for axis in place_m.T)
    outside = (x < panel.x[0]) | (x > panel.x[1]) | (y < panel.y[0]) | (y > panel.y[1])
    across, up = panel.across(x), panel.up(y)
    return np.where(outside, np.nan, across), np.where(outside, np.nan, up)


def lengths(scene: Scene, comparison: Comparison) -> Figure | None:
    """Stride lengths of both feet as dots, one row a method."""
    names = _names(comparison.lengths)
    if not names:
        return None
    values = np.concatenate([one.length_m for one in comparison.lengths])
    high = _ROW_PT * len(names)
    sheet = Sheet(FULL_WIDTH_PT, high + _BOTTOM_PT + 22)
    box = (_NAMES_PT, _BOTTOM_PT, FULL_WIDTH_PT - _NAMES_PT - _RIGHT_PT, high)
    panel = Panel(sheet, box, padded(*_range(values), 0.03), (0.0, float(len(names))))
    panel.scale_x("m")
    for row, name in enumerate(names):
        y = len(names) - row - 0.5
        level = float(panel.up(y))
        sheet.line([panel.left, panel.right], [level, level], Stroke("", "#dfe4ea", "-"), 0.6, 0.5)
        sheet.text(panel.left - 5, level - 3, name, across="right", size=SMALL_PT, bold=name == OURS)
        for one in comparison.lengths:
            if one.method == name:
                off = 0.17 if one.side is Side.LEFT else -0.17
                known = one.length_m[np.isfinite(one.length_m)][:MOST_DOTS]
                sheet.marks(
                    panel.across(known), panel.up(np.full(len(known), y + off)), SIDES[one.side], size=2.6
                )
    sides = dict.fromkeys(one.side for one in comparison.lengths)
    sheet.keys(sheet.height_pt - 9, [SIDES[side] for side in sides])
    return sheet.to_figure(
        scene,
        name="methods_lengths",
        title="Stride lengths by every model",
        caption="Each mark is one stride from rest to rest, strides of turns among them.",
        alt=" ".join(_sentence(comparison.lengths, name) for name in names),
        wide=True,
    )


def _names(found: Sequence[MethodLengths]) -> list[str]:
    """Methods with at least one length."""
    return list(dict.fromkeys(one.method for one in found if np.isfinite(one.length_m).any()))


def _sentence(found: Sequence[MethodLengths], name: str) -> str:
    values = np.concatenate([one.length_m for one in found if one.method == name])
    low, high = _range(values)
    return f"{name}: {int(np.isfinite(values).sum())} strides from {low:.2f} to {high:.2f} m."


def _range(values: Floats) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if len(known) else (np.nan, np.nan)


def agreement(scene: Scene, comparison: Comparison) -> Figure | None:
    """Difference to ours against the mean of both, a small panel for each model, all on one scale."""
    names = [name for name in _names(comparison.lengths) if name != OURS]
    if not names:
        return None
    rows = -(-len(names) // _PER_ROW)
    sheet = Sheet(FULL_WIDTH_PT, rows * (_CELL_PT + 30) + 16)
    points = {name: _points(comparison.lengths, name) for name in names}
    every = np.vstack([point for sides in points.values() for point in sides.values()])
    limits = [at for name in names for at in _limits(points[name])]
    x, y = padded(*_range(every[:, 0]), 0.05), padded(*_range(np.append(every[:, 1], limits)), 0.05)
    wide = (FULL_WIDTH_PT - _LEFT_PT - 4) / _PER_ROW
    for k, name in enumerate(names):
        left = _LEFT_PT + wide * (k % _PER_ROW)
        bottom = sheet.height_pt - 26 - (k // _PER_ROW) * (_CELL_PT + 30) - _CELL_PT
        _one_agreement(Panel(sheet, (left, bottom, wide - 14, _CELL_PT), x, y), name, points[name], k)
    sheet.keys(
        sheet.height_pt - 9, [SIDES[side] for side in dict.fromkeys(o.side for o in comparison.lengths)]
    )
    return sheet.to_figure(
        scene,
        name="methods_agreement",
        title="Agreement with ours, stride by stride",
        caption="Upwards: the model's stride less ours, in metres; to the right: the mean of both, in metres. Line: mean"
        " difference; dashed: limits within which 95 % of the strides differ.",
        alt=" ".join(_limits_sentence(name, points[name]) for name in names),
        wide=True,
    )


def _points(found: Sequence[MethodLengths], name: str) -> dict[Side, Floats]:
    """(mean, difference) of each stride, by side."""
    points = {}
    for one in found:
        if one.method == name:
            both = np.column_stack([0.5 * (one.length_m + one.ours_m), one.length_m - one.ours_m])
            points[one.side] = both[np.isfinite(both).all(axis=1)]
    return points


def _limits(points: dict[Side, Floats]) -> tuple[float, float, float]:
    """Lower limit of agreement, mean difference, upper limit (Bland and Altman 1986)."""
    apart = np.concatenate([one[:, 1] for one in points.values()])
    mean = float(apart.mean())
    half = TWO_SIDED_95 * float(apart.std(ddof=1)) if len(apart) > 1 else 0.0
    return mean - half, mean, mean + half


def _limits_sentence(name: str, points: dict[Side, Floats]) -> str:
    low, mean, high = _limits(points)
    return f"{name} less ours: {mean:+.2f} m, 95 % from {low:+.2f} to {high:+.2f} m.".replace("-", "−")


def _one_agreement(panel: Panel, name: str, points: dict[Side, Floats], k: int) -> None:
    if k % _PER_ROW == 0:
        panel.scale_y("", most=4)
    else:
        zero = float(panel.up(0.0))
        panel.sheet.line([panel.left, panel.right], [zero, zero], Stroke("", "#dfe4ea", "-"), 0.6, 0.5)
    panel.scale_x("", most=3)
    panel.sheet.text(panel.left, panel.top + 4, name, size=SMALL_PT, bold=True)
    for side, one in points.items():
        panel.sheet.marks(panel.across(one[:, 0]), panel.up(one[:, 1]), SIDES[side], size=2.4, hollow=True)
    low, mean, high = _limits(points)
    for at, stroke, width in (
        (mean, Stroke("", INK, "-"), 1.3),
        (low, Stroke("", MUTED, (0, (3, 2))), 0.8),
        (high, Stroke("", MUTED, (0, (3, 2))), 0.8),
    ):
        level = float(panel.up(at))
        panel.sheet.line([panel.left, panel.right], [level, level], stroke, width, 3)
