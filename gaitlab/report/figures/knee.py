"""A knee's velocity and position over time: figures 7 and 8 of İkizoğlu et al. 2018."""

from __future__ import annotations

from gaitlab.recording.model import Placement
from gaitlab.report.figures.foot import above_and_below
from gaitlab.report.figures.model import Figure, Scene

_RULE = (
    "corrected: the knee never rests, so in each gait cycle a velocity offset is removed that makes it go as "
    "far as its foot's step (bands: the foot rests)."
)


def velocity(scene: Scene, placement: Placement) -> Figure | None:
    """Figure 7: the knee's velocity, uncorrected above, corrected below."""
    series = scene.sensor(placement)
    if series is None:
        return None
    return above_and_below(
        scene,
        placement,
        [("uncorrected", series, series.raw_velocity_mps), ("corrected", series, series.velocity_mps)],
        quantity="velocity",
        unit="m/s",
        how=f"Below: {_RULE}",
    )


def position(scene: Scene, placement: Placement) -> Figure | None:
    """Figure 8: the knee's position uncorrected and corrected, and its pivot foot's position."""
    series = scene.sensor(placement)
    foot = scene.sensor(Placement.foot(placement.side))
    if series is None:
        return None
    rows = [
        ("knee, uncorrected", series, series.raw_position_m),
        ("knee, corrected", series, series.position_m),
    ]
    if foot is not None:
        rows.append(("pivot foot", foot, foot.position_m))
    pivot = " At the bottom: the pivot foot." if foot is not None else ""
    return above_and_below(
        scene, placement, rows, quantity="position", unit="m", how=f"Below: {_RULE}{pivot}"
    )
