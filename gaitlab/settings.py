"""What can be chosen for an analysis."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from gaitlab.motion.orientation import OrientationSource
from gaitlab.motion.path import Anchor

METHODS: dict[str, str] = {
    "gaitlab": "One rest in every gait cycle, drift taken out between rests, knee tied to its foot (default).",
    "ikizoglu2018": "İkizoğlu et al. 2018 to the letter: rest below 0.15 m/s², velocity reset at every rest.",
}
"""Methods by name, with one sentence for people."""


@dataclass(frozen=True)
class Settings:
    """What can be chosen for an analysis; stored with every result.

    Attributes
    ----------
    method : str
        A key of ``METHODS``.
    course_m : float or None
        Length of the timed course; None for a free walk.
    orientation : OrientationSource or None
        Where the orientation comes from; None: the gyroscope where its offset was seen while standing, else VQF, else the
        device's.
    closed : bool
        The path may use that each foot ended where it began.
    way_m : float or None
        The path may use that its farthest rest is so far from its first.
    """

    method: str = "gaitlab"
    course_m: float | None = None
    orientation: OrientationSource | None = None
    closed: bool = False
    way_m: float | None = None

    @property
    def anchor(self) -> Anchor | None:
        """What the path may use of the course; None for nothing."""
        return Anchor(self.closed, self.way_m) if self.closed or self.way_m is not None else None

    def as_dict(self) -> dict[str, object]:
        """For storing with a result."""
        return asdict(self)
