"""Height by barometer, and the floor that a person is on (Feliz et al. 2009, §III.B)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.heading import first_moment
from gaitlab.methods.model import FootView, Method, Need, Question
from gaitlab.recording.model import Floats

_ICAO = "ICAO standard atmosphere (1993): "


@dataclass(frozen=True)
class Atmosphere:
    """The lower standard atmosphere."""

    temperature_k: float = constant(288.15, "K", f"{_ICAO}at sea level")
    lapse_kpm: float = constant(0.0065, "K/m", f"{_ICAO}temperature lost a metre")
    exponent: float = constant(0.190263, "", f"{_ICAO}R·L/(g·M)")


@dataclass(frozen=True)
class FloorParams:
    """When a floor is left for another.

    Attributes
    ----------
    margin : float
        A height within this share of a storey about the middle between two floors decides nothing: the floor stays.
    """

    margin: float = constant(0.3, "storey", "ours: 0.9 m of 3 m, 3.6 times the noise of a barometer, 3 Pa")


def barometric_height(pressure_pa: Floats, reference_pa: float, air: Atmosphere | None = None) -> Floats:
    """Height over the place where the pressure is ``reference_pa``, metres: h = T₀/L · (1 − (p/p₀)^(R·L/(g·M)))."""
    a = air or Atmosphere()
    share = np.maximum(pressure_pa, 0.0) / reference_pa
    return np.asarray(a.temperature_k / a.lapse_kpm * (1.0 - share**a.exponent))


def by_barometer(foot: FootView, air: Atmosphere | None = None) -> Floats:
    """Height of each row over the first rest, metres, shape (n,); NaN where the pressure is none.

    The pressure at the first rest is its mean there. Nothing is smoothed, as in the paper: "rough", but without drift.
    """
    assert foot.pressure_pa is not None
    rests = foot.motion.rests
    first = first_moment(foot.motion)
    standing = slice(int(rests.start[0]), int(rests.end[0])) if len(rests) else slice(first, first + 1)
    reference = float(foot.pressure_pa[standing].mean())
    if not reference > 0.0:
        return np.full(len(foot.pressure_pa), np.nan)
    return barometric_height(foot.pressure_pa, reference, air)


def floor_of(height_m: Floats, storey_m: float, params: FloorParams | None = None) -> NDArray[np.intp]:
    """Number of the floor that each height, shape (n,), is on; 0 is where the heights are measured from.

    A floor is left only when another is clearly nearer: between, and where the height is not known, it stays the last one
    that was certain, so that noise halfway up a staircase does not go up and down. The paper names the purpose without a
    rule.
    """
    p = params or FloorParams()
    with np.errstate(invalid="ignore"):
        level = np.round(height_m / storey_m)
        certain = np.abs(height_m / storey_m - level) <= 0.5 - p.margin
    last = np.maximum.accumulate(np.where(certain, np.arange(len(height_m)), -1))
    known = np.where(certain, level, 0.0)
    return np.asarray(np.where(last >= 0, known[np.maximum(last, 0)], 0.0).astype(np.intp))


METHOD = Method(
    "feliz2009_barometric",
    Question.HEIGHT,
    "Barometer in the standard atmosphere",
    "Feliz et al. 2009, §III.B",
    (Need.PRESSURE,),
    constants_of(Atmosphere, FloorParams),
    (
        "The paper takes the device's height; here it is the standard atmosphere's, over the pressure at the first rest.",
    ),
    by_barometer,
)
