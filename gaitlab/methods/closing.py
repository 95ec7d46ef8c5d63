"""How well a path closes that ends where it began."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.methods.model import Track


@dataclass(frozen=True)
class Closing:
    """Closing error of a track, horizontally.

    Attributes
    ----------
    error_m : float
        From the first place to the last; NaN where there is only one.
    path_m : float
        Length of the track from place to place.
    """

    error_m: float
    path_m: float

    @property
    def percent(self) -> float:
        """Error in % of the method's own path; NaN where it went nowhere."""
        return 100.0 * self.error_m / self.path_m if self.path_m > 0.0 else np.nan


def closing_of(track: Track) -> Closing:
    """Closing error of a track (Jiménez et al. 2009, §V.B; Feliz et al. 2009, §III)."""
    if len(track.time_s) < 2:
        return Closing(np.nan, 0.0)
    level = track.place_m[:, :2]
    path = float(np.linalg.norm(np.diff(level, axis=0), axis=1).sum())
    return Closing(float(np.linalg.norm(level[-1] - level[0])), path)
