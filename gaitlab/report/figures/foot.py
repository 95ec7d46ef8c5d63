"""A foot's acceleration, velocity and position over time: figures 1, 2 and 3 of İkizoğlu et al. 2018."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.recording.model import Floats, Placement
from gaitlab.report.figures.canvas import Panel, Sheet, padded, time_range
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.report.figures.style import AXES, HALF_WIDTH_PT, INK, LOST_KEY, REST_KEY, SMALL_PT, Stroke
from gaitlab.series import SensorSeries

_LEFT_PT = 30.0
_WIDE_PT = HALF_WIDTH_PT - _LEFT_PT - 7
_BOTTOM_PT, _HIGH_PT, _PITCH_PT, _KEYS_PT = 16.0, 66.0, 94.0, 14.0
_SOLID = tuple(Stroke(axis.label, axis.colour, "-") for axis in AXES)


def acceleration(scene: Scene, placement: Placement) -> Figure | None:
    """Figure 1: free acceleration with the rests found in it."""
    series = scene.sensor(placement)
    if series is None:
        return None
    foot = scene.result.feet.get(placement.side.value)
    alt = (
        f"Free acceleration of the {placement.label} along x, y and z from {series.t_s[0]:.1f} s to "
        f"{series.t_s[-1]:.1f} s, at most {np.abs(series.acceleration_mps2).max():.0f} m/s² in one "
        f"component, with {len(foot.rests) if foot else 0} rests marked as bands."
    )
    sheet = Sheet(HALF_WIDTH_PT, 164)
    panel = _montage(sheet, series.t_s, series.acceleration_mps2, time_range(*scene.feet))
    panel.scale_x("s")
    panel.bands(series)
    sheet.keys(154, _SOLID, band_keys(series))
    return sheet.to_figure(
        scene,
        name=f"{placement}_acceleration",
        title=f"{placement.label.capitalize()}: free acceleration and rests",
        caption="Acceleration without gravity and without the offset; the three components one below the "
        "other, on one scale. Bands: the foot rests, and its velocity is set to zero.",
        alt=alt,
    )


def _montage(sheet: Sheet, t_s: Floats, values: Floats, time: tuple[float, float]) -> Panel:
    """Three components one below the other, each about its own zero, on one scale; and the scale as a bar."""
    low, high = values.min(axis=0), values.max(axis=0)
    gap = 0.12 * max(float(np.mean(high - low)), 1e-9)
    zeros = np.concatenate(([0.0], np.cumsum(low[:-1] - gap - high[1:])))
    reach = padded(float(zeros[2] + low[2]), float(high[0]), 0.04)
    panel = Panel(sheet, (_LEFT_PT, _BOTTOM_PT, _WIDE_PT - 4, 122), time, reach)
    for stroke, zero, value in zip(_SOLID, zeros, values.T, strict=True):
        y = float(panel.up(zero))
        panel.trace(t_s, zero + value, stroke, 0.7)
        sheet.text(_LEFT_PT - 6, y - 3, stroke.label[0], across="right", colour=stroke.colour, bold=True)
    bar = _round_step(float(np.max(high - low)) / 2)
    foot, head = float(panel.up(high[0] - bar)), float(panel.up(high[0]))
    sheet.line([panel.right + 3] * 2, [foot, head], Stroke("", INK, "-"), 2)
    sheet.text(panel.right, head - 6, f"{bar:g} m/s²", across="right", size=SMALL_PT)
    return panel


def _round_step(rough: float) -> float:
    """The next 1, 2 or 5 times a power of ten at or below ``rough``."""
    if not rough > 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(rough))
    return float(max(step for step in (1, 2, 5) if step * power <= rough * (1 + 1e-9)) * power)


def velocity(scene: Scene, placement: Placement) -> Figure | None:
    """Figure 2: velocity, above without the reset at each rest, below with it."""
    series = scene.sensor(placement)
    if series is None:
        return None
    return above_and_below(
        scene,
        placement,
        [("uncorrected", series, series.raw_velocity_mps), ("corrected", series, series.velocity_mps)],
        quantity="velocity",
        unit="m/s",
        how="Below: corrected, set to zero at every rest (bands).",
    )


def position(scene: Scene, placement: Placement) -> Figure | None:
    """Figure 3: position, above without the reset at each rest, below with it."""
    series = scene.sensor(placement)
    if series is None:
        return None
    return above_and_below(
        scene,
        placement,
        [("uncorrected", series, series.raw_position_m), ("corrected", series, series.position_m)],
        quantity="position",
        unit="m",
        how="Below: from the velocity that is set to zero at every rest (bands).",
    )


Row = tuple[str, SensorSeries, Floats]


def above_and_below(
    scene: Scene, placement: Placement, rows: Sequence[Row], *, quantity: str, unit: str, how: str
) -> Figure:
    """Panels one above the other on one time axis, each with x, y and z, the rests and the lost samples."""
    time = time_range(*scene.feet, *(series for _, series, _ in rows))
    sheet = Sheet(HALF_WIDTH_PT, _BOTTOM_PT + _PITCH_PT * len(rows) + _KEYS_PT - 10)
    for at, (label, series, values) in enumerate(rows):
        below = len(rows) - 1 - at
        box = (_LEFT_PT, _BOTTOM_PT + _PITCH_PT * below, _WIDE_PT, _HIGH_PT)
        panel = Panel(sheet, box, time, padded(float(values.min()), float(values.max())))
        panel.scale_y(unit)
        panel.scale_x("s", labels=below == 0)
        panel.bands(series)
        for stroke, value in reversed(list(zip(AXES, values.T, strict=True))):
            panel.trace(series.t_s, value, stroke)
        panel.name(label)
    sheet.keys(sheet.height_pt - 9, AXES, band_keys(*(series for _, series, _ in rows)))
    drift, kept = rows[0][2], rows[1][2]
    alt = (
        f"{quantity.capitalize()} of the {placement.label} along x, y and z. Uncorrected, it ends at "
        f"{_xyz(drift[-1], unit)}; corrected, at {_xyz(kept[-1], unit)}."
    )
    return sheet.to_figure(
        scene,
        name=f"{placement}_{quantity}",
        title=f"{placement.label.capitalize()}: {quantity}",
        caption=f"Above: {quantity} integrated without any correction. {how}",
        alt=alt,
    )


def band_keys(*series: SensorSeries) -> list[tuple[str, str]]:
    """Keys of the bands; lost samples only where there are some."""
    return [REST_KEY, LOST_KEY] if any(bool(one.lost.any()) for one in series) else [REST_KEY]


def _xyz(values: Floats, unit: str) -> str:
    return ", ".join(
        f"{axis} {v + 0.0:.2f} {unit}".replace("-", "−") for axis, v in zip("xyz", values, strict=True)
    )
