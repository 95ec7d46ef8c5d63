"""The way of both feet seen from above."""

from __future__ import annotations

import numpy as np

from gaitlab.recording.model import Floats, Placement, Side
from gaitlab.report.figures.canvas import Panel, Sheet, padded
from gaitlab.report.figures.decimate import thin
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.report.figures.style import FULL_WIDTH_PT, INK, SIDES, SMALL_PT, TURN_KEY, Stroke
from gaitlab.series import SensorSeries

MOST_POINTS, MOST_MARKERS, MOST_LABELS = 3000, 150, 6
_LEFT_PT, _RIGHT_PT, _BOTTOM_PT, _TOP_PT = 24.0, 12.0, 16.0, 20.0
_LOWEST_PT, _HIGHEST_PT = 56.0, 300.0
_AIR_M = 0.25
_TURN = Stroke(*TURN_KEY, "-")
_START = Stroke("start", INK, "none", "+")
_END = Stroke("end", INK, "none", "x")

Feet = dict[Side, SensorSeries]


def route(scene: Scene) -> Figure | None:
    """Both feet on the floor, axes equal, with the ends of strides and the turns marked."""
    found = {side: scene.sensor(Placement.foot(side)) for side in Side}
    feet: Feet = {side: one for side, one in found.items() if one is not None}
    if not feet:
        return None
    panel = _floor(feet)
    for side, one in feet.items():
        keep = thin(len(one.t_s), MOST_POINTS)
        panel.sheet.line(*_on(panel, one.position_m[keep]), SIDES[side])
        _stride_ends(panel, scene, one, side)
    _turns(panel, scene, feet)
    _start_and_end(panel, feet)
    boxes = [TURN_KEY] if scene.result.walk.turns else []
    panel.sheet.keys(panel.sheet.height_pt - 9, [*(SIDES[side] for side in feet), _START, _END], boxes)
    return panel.sheet.to_figure(
        scene,
        name="route",
        title="Route from above",
        caption="The way of each foot on the floor, both axes on one scale: x along the first straight part, "
        "y to its left. Marks: where each stride ended, hollow where it belongs to a turn.",
        alt=_description(scene, feet),
        wide=True,
    )


def _floor(feet: Feet) -> Panel:
    """A panel on which a metre is as long in x as in y; room left over is shared out on both sides."""
    floor = np.vstack([one.position_m[:, :2] for one in feet.values()])
    (west, south), (east, north) = floor.min(axis=0), floor.max(axis=0)
    west, east = padded(float(west), float(east), 0.02)
    south, north = float(south) - _AIR_M, float(north) + _AIR_M
    wide_pt = FULL_WIDTH_PT - _LEFT_PT - _RIGHT_PT
    per_metre = min(wide_pt / (east - west), _HIGHEST_PT / (north - south))
    high_pt = max(_LOWEST_PT, (north - south) * per_metre)
    sheet = Sheet(FULL_WIDTH_PT, high_pt + _BOTTOM_PT + _TOP_PT)
    x, y = (
        (middle - room / 2, middle + room / 2)
        for middle, room in (
            ((west + east) / 2, wide_pt / per_metre),
            ((south + north) / 2, high_pt / per_metre),
        )
    )
    panel = Panel(sheet, (_LEFT_PT, _BOTTOM_PT, wide_pt, high_pt), x, y)
    panel.scale_y("", most=3 if high_pt < wide_pt / 3 else 6)
    panel.scale_x("m", most=8)
    return panel


def _on(panel: Panel, position_m: Floats) -> tuple[Floats, Floats]:
    return panel.across(position_m[:, 0]), panel.up(position_m[:, 1])


def _at(one: SensorSeries, t_s: Floats) -> Floats:
    return np.column_stack([np.interp(t_s, one.t_s, one.position_m[:, k]) for k in (0, 1)])


def _stride_ends(panel: Panel, scene: Scene, one: SensorSeries, side: Side) -> None:
    foot = scene.result.feet.get(side.value)
    if foot is None or not foot.strides or len(foot.strides) > MOST_MARKERS:
        return
    place = _at(one, np.array([stride.end_s for stride in foot.strides]))
    turning = np.array([stride.turning for stride in foot.strides])
    for chosen, hollow in ((~turning, False), (turning, True)):
        if chosen.any():
            panel.sheet.marks(*_on(panel, place[chosen]), SIDES[side], hollow=hollow)


def _turns(panel: Panel, scene: Scene, feet: Feet) -> None:
    turns = scene.result.walk.turns
    for turn in turns:
        lines = []
        for one in feet.values():
            inside = np.flatnonzero((one.t_s >= turn.start_s) & (one.t_s < turn.end_s))
            if len(inside):
                lines.append(_on(panel, one.position_m[inside[thin(len(inside), 200)]]))
                panel.sheet.line(*lines[-1], _TURN, 9, 1)
        if lines and len(turns) <= MOST_LABELS:
            x, y = np.concatenate([line[0] for line in lines]), np.concatenate([line[1] for line in lines])
            text = f"{abs(turn.angle_deg):.0f}° {'left' if turn.angle_deg > 0 else 'right'}"
            middle = float(np.clip(x.mean(), panel.left + 22, panel.right - 18))
            panel.sheet.text(
                middle, min(float(y.max()) + 7, panel.top - 7), text, across="center", size=SMALL_PT
            )


def _start_and_end(panel: Panel, feet: Feet) -> None:
    for stroke, row in ((_START, 0), (_END, -1)):
        place = np.mean([one.position_m[row, :2] for one in feet.values()], axis=0)
        panel.sheet.marks(*_on(panel, place[None]), stroke, size=6)


def _description(scene: Scene, feet: Feet) -> str:
    sentences = []
    for side, one in feet.items():
        far = float(np.abs(one.position_m[:, 0]).max())
        gap = float(np.hypot(*(one.position_m[-1, :2] - one.position_m[0, :2])))
        sentences.append(
            f"The {side} foot goes up to {far:.2f} m along x and ends {gap:.2f} m from where it began."
        )
    turns = scene.result.walk.turns
    if turns:
        angles = ", ".join(f"{turn.angle_deg:.0f}°".replace("-", "−") for turn in turns[:MOST_LABELS])
        more = f" and {len(turns) - MOST_LABELS} more" if len(turns) > MOST_LABELS else ""
        sentences.append(f"Turns, positive to the left: {angles}{more}.")
    return " ".join(sentences)
