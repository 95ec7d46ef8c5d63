"""A sheet to draw on in points, panels with a scale on it, and the way from there to SVG.

Matplotlib's own axes take 30 ms each, and a trial has 22 panels; so a panel here is a scale and a few lines,
and matplotlib places the text, simplifies the paths and writes the SVG. Only its object interface is used: no
pyplot, so threads do not meet.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure as Canvas
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import IdentityTransform

from gaitlab.recording.model import Floats
from gaitlab.report.figures.decimate import envelope, shares, spans
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.report.figures.style import INK, LOST_KEY, MUTED, REST_KEY, RULE, SMALL_PT, TEXT_PT, Stroke
from gaitlab.report.figures.svg import tidy
from gaitlab.series import SensorSeries

matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "gaitlab"})

_FONTS = {
    (size, bold): FontProperties(family="DejaVu Sans", size=size, weight="bold" if bold else "normal")
    for size in (TEXT_PT, SMALL_PT)
    for bold in (False, True)
}
_MARKER_PT = 3.8
_STRIP_PT = 3.0


class Sheet:
    """A figure measured in points from its lower left corner."""

    def __init__(self, width_pt: float, height_pt: float) -> None:
        self.width_pt, self.height_pt = width_pt, height_pt
        self._figure = Canvas(figsize=(width_pt / 72, height_pt / 72), dpi=72)
        self._figure.patch.set_visible(False)

    def add(self, artist: Any, order: float) -> None:
        """Put a matplotlib artist, in points, on the sheet."""
        artist.set_transform(IdentityTransform())
        artist.set_zorder(order)
        self._figure.add_artist(artist)

    def text(
        self,
        x: float,
        y: float,
        text: str,
        *,
        colour: str = INK,
        across: str = "left",
        up: str = "baseline",
        size: float = TEXT_PT,
        bold: bool = False,
    ) -> None:
        font = _FONTS[size, bold]
        self.add(Text(x, y, text, color=colour, ha=across, va=up, fontproperties=font, parse_math=False), 5)

    def line(self, x: Any, y: Any, stroke: Stroke, width: float = 0.9, order: float = 2) -> None:
        self.add(
            Line2D(x, y, color=stroke.colour, linestyle=stroke.line, linewidth=width, solid_capstyle="butt"),
            order,
        )

    def marks(
        self, x: Any, y: Any, stroke: Stroke, *, hollow: bool = False, size: float = _MARKER_PT
    ) -> None:
        self.add(
            Line2D(
                x,
                y,
                linestyle="none",
                marker=stroke.marker,
                markersize=size,
                markerfacecolor="white" if hollow else stroke.colour,
                markeredgecolor=stroke.colour,
                markeredgewidth=0.9,
            ),
            4,
        )

    def boxes(self, corners: Floats, colour: str, order: float) -> None:
        """Rectangles, rows of (left, right, bottom, top), as one path."""
        if len(corners) == 0:
            return
        left, right, low, high = corners.T
        points = np.stack(
            [
                np.column_stack(p)
                for p in ((left, low), (right, low), (right, high), (left, high), (left, low))
            ],
            axis=1,
        )
        codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(corners))
        self.add(PathPatch(Path(points.reshape(-1, 2), codes), facecolor=colour, edgecolor="none"), order)

    def segments(self, x: Floats, low: Floats, high: Floats, stroke: Stroke) -> None:
        """Upright strokes as one path."""
        points = np.stack([np.column_stack((x, low)), np.column_stack((x, high))], axis=1).reshape(-1, 2)
        codes = np.tile([Path.MOVETO, Path.LINETO], len(x))
        self.add(PathPatch(Path(points, codes), facecolor="none", edgecolor=stroke.colour, linewidth=0.9), 3)

    def keys(self, y: float, strokes: Sequence[Stroke], boxes: Sequence[tuple[str, str]] = ()) -> None:
        """One line that says what is drawn how: strokes, then boxes of (label, colour)."""
        x = 2.0
        for stroke in strokes:
            self.line([x, x + 16], [y + 3, y + 3], stroke, 1.3)
            if stroke.marker:
                self.marks([x + 8], [y + 3], stroke)
            x = self._word(x + 20, y, stroke.label)
        for label, colour in boxes:
            self.boxes(np.array([[x, x + 12, y, y + 6]]), colour, 1)
            x = self._word(x + 16, y, label)

    def _word(self, x: float, y: float, word: str) -> float:
        self.text(x, y, word, size=SMALL_PT)
        return x + 0.57 * SMALL_PT * len(word) + 10

    def to_figure(
        self, scene: Scene, *, name: str, title: str, caption: str, alt: str, wide: bool = False
    ) -> Figure:
        """Write the SVG; the same sheet always gives the same bytes."""
        buffer = io.BytesIO()
        nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
        FigureCanvasSVG(self._figure).print_svg(buffer, metadata=nothing)  # type: ignore[no-untyped-call]
        svg = tidy(buffer.getvalue(), name=scene.prefix + name, title=title, description=alt)
        return Figure(name, title, caption, alt, svg, wide)


class Panel:
    """A rectangle of a sheet with a scale in x and y."""

    def __init__(
        self,
        sheet: Sheet,
        box_pt: tuple[float, float, float, float],
        x: tuple[float, float],
        y: tuple[float, float],
    ) -> None:
        self.sheet, self.x, self.y = sheet, x, y
        self.left, self.bottom, self.wide, self.high = box_pt

    @property
    def top(self) -> float:
        return self.bottom + self.high

    @property
    def right(self) -> float:
        return self.left + self.wide

    def across(self, x: Any) -> Any:
        """Points from the left for values of x."""
        return self.left + (np.asarray(x, dtype=float) - self.x[0]) * (self.wide / (self.x[1] - self.x[0]))

    def up(self, y: Any) -> Any:
        """Points from below for values of y."""
        return self.bottom + (np.asarray(y, dtype=float) - self.y[0]) * (self.high / (self.y[1] - self.y[0]))

    def scale_y(self, unit: str, most: int = 4) -> None:
        """Level lines with their numbers; the unit above them."""
        for value, label in _ticks(self.y, most):
            y = float(self.up(value))
            self.sheet.line([self.left, self.right], [y, y], Stroke("", RULE, "-"), 0.6, 0.5)
            self.sheet.text(self.left - 4, y - 3, label, across="right")
        self.sheet.text(2, self.top + 5, unit, colour=MUTED)

    def scale_x(self, unit: str, *, labels: bool = True, most: int = 6, level: bool = True) -> None:
        """Ticks along the bottom; the last label carries the unit."""
        if level:
            self.sheet.line(
                [self.left, self.right], [self.bottom, self.bottom], Stroke("", MUTED, "-"), 0.6, 3
            )
        ticks = _ticks(self.x, most)
        for value, label in ticks:
            x = float(self.across(value))
            self.sheet.line([x, x], [self.bottom - 2.5, self.bottom], Stroke("", MUTED, "-"), 0.6, 3)
            if labels:
                text = f"{label} {unit}" if value == ticks[-1][0] else label
                middle = min(x, self.sheet.width_pt - 0.32 * TEXT_PT * len(text))
                self.sheet.text(middle, self.bottom - 11.5, text, across="center")

    def name(self, text: str) -> None:
        """What the panel shows, above its right end."""
        self.sheet.text(self.right, self.top + 5, text, across="right", bold=True)

    def trace(self, x: Floats, y: Floats, stroke: Stroke, width: float = 0.9) -> None:
        """A line through samples, decimated without losing a peak."""
        keep = envelope(y)
        self.sheet.line(self.across(x[keep]), self.up(y[keep]), stroke, width)

    def bands(self, series: SensorSeries) -> None:
        """Rests as pale bands over the whole height; lost samples as a thin strip along the bottom.

        The strip has its full height from a tenth lost and less where less is lost, so that 2 % of an hour does not
        look like all of it.
        """
        rest = spans(series.t_s, series.rest, 0.5 * (self.x[1] - self.x[0]) / self.wide)
        self._boxes(rest[:, 0], rest[:, 1], np.full(len(rest), self.high), REST_KEY[1], 0.2)
        lost = shares(series.t_s, series.lost, round(self.wide))
        height = _STRIP_PT * np.clip(lost[:, 2] / 0.1, 0.15, 1.0)
        self._boxes(lost[:, 0], lost[:, 1], height, LOST_KEY[1], 2.5)

    def _boxes(self, start: Floats, end: Floats, height: Floats, colour: str, order: float) -> None:
        floor = np.full(len(start), self.bottom)
        corners = np.column_stack((self.across(start), self.across(end), floor, floor + height))
        self.sheet.boxes(corners, colour, order)


def _ticks(limits: tuple[float, float], most: int) -> list[tuple[float, str]]:
    """Round values within limits, with as many decimals as they need."""
    values = np.asarray(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]).tick_values(*limits), dtype=float)
    step = values[1] - values[0]
    decimals = next((d for d in range(7) if abs(round(step, d) - step) < 1e-6 * step), 6)
    air = 1e-9 * (limits[1] - limits[0])
    inside = values[(values >= limits[0] - air) & (values <= limits[1] + air)]
    return [
        (float(v), f"{v + 0.0:.{decimals}f}".replace("-", "−"))
        for v in np.where(np.abs(inside) < air, 0.0, inside)
    ]


def time_range(*series: SensorSeries) -> tuple[float, float]:
    """First and last instant of several sensors."""
    times = [one.t_s for one in series if len(one.t_s)]
    low, high = min(float(t[0]) for t in times), max(float(t[-1]) for t in times)
    return low, high if high > low else low + 1.0


def padded(low: float, high: float, share: float = 0.06) -> tuple[float, float]:
    """A range with some air, also where all values are the same."""
    if not (np.isfinite(low) and np.isfinite(high)):
        return -1.0, 1.0
    air = share * (high - low) or 0.5
    return low - air, high + air
