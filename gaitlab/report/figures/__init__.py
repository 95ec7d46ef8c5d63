"""Figures of a trial as SVG: the same picture on screen and on paper.

Importing this package loads no plotting library; drawing the first figure does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from gaitlab.recording.model import Placement
from gaitlab.report.figures.model import Figure, Scene
from gaitlab.result import Result
from gaitlab.series import Series

Maker = Callable[[Scene], Figure | None]


def _route(scene: Scene) -> Figure | None:
    from gaitlab.report.figures.route import route

    return route(scene)


def _strides(scene: Scene) -> Figure | None:
    from gaitlab.report.figures.strides import strides

    return strides(scene)


def _of(placement: Placement, quantity: str) -> Maker:
    def make(scene: Scene) -> Figure | None:
        from gaitlab.report.figures import foot, knee

        room = foot if placement.is_foot else knee
        maker: Callable[[Scene, Placement], Figure | None] = getattr(room, quantity)
        return maker(scene, placement)

    return make


_FEET = (Placement.LEFT_FOOT, Placement.RIGHT_FOOT)
_KNEES = (Placement.LEFT_KNEE, Placement.RIGHT_KNEE)

FIGURES: Mapping[str, Maker] = MappingProxyType(
    {
        "route": _route,
        "strides": _strides,
        **{f"{p}_{q}": _of(p, q) for q in ("acceleration", "velocity", "position") for p in _FEET},
        **{f"{p}_{q}": _of(p, q) for q in ("velocity", "position") for p in _KNEES},
    }
)
"""Every figure by its name, in the order of the report."""


def figures(result: Result, series: Series, *, prefix: str = "") -> list[Figure]:
    """All figures that this trial has data for, in the order of ``FIGURES``.

    ``prefix`` begins every id inside the pictures: give each trial its own where several stand in one page.
    """
    scene = Scene(result, series, prefix)
    made = (make(scene) for make in FIGURES.values())
    return [figure for figure in made if figure is not None]


__all__ = ["FIGURES", "Figure", "figures"]
