"""The common look: Okabe and Ito's colours, which colour-blind readers tell apart; lines and marks differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gaitlab.recording.model import Side

HALF_WIDTH_PT = 300.0
FULL_WIDTH_PT = 330.0
TEXT_PT = 9.0
SMALL_PT = 8.2
INK = "#1d2733"
MUTED = "#566270"
RULE = "#dfe4ea"
REST_KEY = ("rest", "#e2e8ee")
LOST_KEY = ("lost", "#8f1d5b")
TURN_KEY = ("turn", "#e2e8ee")


@dataclass(frozen=True)
class Stroke:
    """How one thing is drawn wherever it appears; ``line`` as matplotlib names line styles."""

    label: str
    colour: str
    line: Any
    marker: str = ""


SIDES = {
    Side.LEFT: Stroke("left foot", "#0072b2", "-", "o"),
    Side.RIGHT: Stroke("right foot", "#d55e00", (0, (4, 1.4)), "s"),
}
AXES = (
    Stroke("x along", "#1d2733", "-"),
    Stroke("y left", "#009e73", (0, (5, 1.5))),
    Stroke("z up", "#b0578d", (0, (1.5, 1))),
)
