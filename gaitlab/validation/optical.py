"""Strides of a foot against a point of it that cameras saw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.recording.model import Bools, Floats
from gaitlab.validation.model import Cell
from gaitlab.validation.truth import OpticalPath

NORMAL_95 = 1.959964


@dataclass(frozen=True, eq=False)
class StrideCheck:
    """Strides within sight of the cameras; arrays have one entry a stride.

    Attributes
    ----------
    start_s, end_s : ndarray
        Instants in the two rests, as in the result.
    length_m, sd_m, optical_m : ndarray
        Ours, its standard uncertainty, and the optical one between the same instants.
    turning, doubtful : ndarray of bool
        As in the result.
    """

    start_s: Floats
    end_s: Floats
    length_m: Floats
    sd_m: Floats
    optical_m: Floats
    turning: Bools
    doubtful: Bools

    @property
    def error_m(self) -> Floats:
        """Ours less the optical."""
        return np.asarray(self.length_m - self.optical_m)

    @property
    def covered(self) -> Bools:
        """The 95 % interval holds the optical length."""
        return np.asarray(np.abs(self.error_m) <= NORMAL_95 * self.sd_m)

    def detail(self, k: int) -> tuple[Cell, ...]:
        """Stride ``k`` as cells: start, end, ours, SD, optical, error, covered, turning."""
        return (
            float(self.start_s[k]),
            float(self.end_s[k]),
            100.0 * float(self.length_m[k]),
            100.0 * float(self.sd_m[k]),
            100.0 * float(self.optical_m[k]),
            100.0 * float(self.error_m[k]),
            "yes" if self.covered[k] else "no",
            "yes" if self.turning[k] else "no",
        )


def check_strides(foot: FootGait, optical: OpticalPath) -> StrideCheck:
    """All strides of a foot that lie wholly within sight, turning ones too."""
    truth = optical.horizontal_length(foot.start_s, foot.end_s)
    seen = np.flatnonzero(foot.walking & np.isfinite(truth))
    return StrideCheck(
        foot.start_s[seen],
        foot.end_s[seen],
        foot.length_m[seen],
        foot.length_sd_m[seen],
        truth[seen],
        foot.turning[seen],
        foot.doubtful[seen],
    )
