"""What a figure is and what it is drawn from."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.recording.model import Placement
from gaitlab.result import Result
from gaitlab.series import SensorSeries, Series


@dataclass(frozen=True)
class Figure:
    """A picture with everything a reader needs who cannot see it.

    Attributes
    ----------
    name : str
        Stable name, and the prefix of all ids in the picture.
    title, caption : str
        Heading, and how the picture is to be read.
    alt : str
        What the picture shows, in words.
    svg : bytes
        A complete ``<svg>`` element without inline styles, scripts or outside links; the same result always
        has the same bytes.
    wide : bool
        Drawn for the whole column; the others stand in pairs, left and right side.
    """

    name: str
    title: str
    caption: str
    alt: str
    svg: bytes
    wide: bool = False


@dataclass(frozen=True, eq=False)
class Scene:
    """A trial as the figures see it."""

    result: Result
    series: Series
    prefix: str = ""

    def sensor(self, placement: Placement) -> SensorSeries | None:
        """The sensor's series, or None where it has no samples."""
        one = self.series.get(placement)
        return one if one is not None and len(one.t_s) else None

    @property
    def feet(self) -> tuple[SensorSeries, ...]:
        """The feet that have samples; all sensors where no foot has any."""
        filled = {p: one for p, one in self.series.items() if len(one.t_s)}
        return tuple(one for p, one in filled.items() if p.is_foot) or tuple(filled.values())
