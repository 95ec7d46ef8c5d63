"""Strides of a foot against a point of it that cameras saw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.measurement import TWO_SIDED_95
from gaitlab.gait.strides import FootGait
from gaitlab.motion.model import Indices
from gaitlab.motion.quaternions import matrices
from gaitlab.recording.model import Bools, Floats
from gaitlab.validation.model import Cell, Column, Figure, Goal, Row
from gaitlab.validation.statistics import CM, mean_absolute, mean_and_sd, share
from gaitlab.validation.truth import OpticalPath, fit_lever

STRIDE_COLUMNS = (
    Column("recording"),
    Column("side"),
    Column("start", "s", 2),
    Column("end", "s", 2),
    Column("ours", "cm", 2),
    Column("SD", "cm", 2),
    Column("optical", "cm", 2),
    Column("error", "cm", 2),
    Column("covered"),
    Column("turning"),
)


@dataclass(frozen=True, eq=False)
class StrideCheck:
    """Strides within sight of the cameras; arrays have one entry a stride.

    Attributes
    ----------
    start_s, end_s : ndarray
        Instants in the two rests, as in the result.
    length_m, sd_m, optical_m : ndarray
        Ours, its standard uncertainty, and the optical one between the same instants.
    turning : ndarray of bool
        As in the result.
    marked : ndarray of bool
        The analysis counts lost or saturated rows in it.
    at_point_m : ndarray
        Our length for the optical point instead of the sensor: moved there by one lever arm, in the sensor's frame, that
        is fitted to the paths of all these strides.
    """

    start_s: Floats
    end_s: Floats
    length_m: Floats
    sd_m: Floats
    optical_m: Floats
    turning: Bools
    marked: Bools
    at_point_m: Floats

    @property
    def error_m(self) -> Floats:
        """Ours less the optical."""
        return np.asarray(self.length_m - self.optical_m)

    @property
    def covered(self) -> Bools:
        """The 95 % interval holds the optical length."""
        return np.asarray(np.abs(self.error_m) <= TWO_SIDED_95 * self.sd_m)

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
        np.asarray(foot.motion.doubtful_share[seen] > 0.0),
        _at_point(foot, seen, optical),
    )


def _at_point(foot: FootGait, seen: Indices, optical: OpticalPath) -> Floats:
    """Lengths of strides of the optical point, by our path and a fitted lever arm."""
    if not len(seen):
        return np.zeros(0)
    motion = foot.motion
    rows = [
        np.round((at[seen] - motion.time_s[0]) * motion.rate_hz).astype(np.intp)
        for at in (foot.start_s, foot.end_s)
    ]
    spans = [np.arange(a, b + 1) for a, b in zip(*rows, strict=True)]
    every, stride = np.concatenate(spans), np.repeat(np.arange(len(spans)), [len(one) for one in spans])
    truth = optical.at(motion.time_s[every])
    known = np.isfinite(truth).all(axis=1)
    every, stride, truth = every[known], stride[known], truth[known]
    rotation = np.moveaxis(matrices(motion.attitude), 2, 0)
    fit = fit_lever(motion.position_m[every], rotation[every], truth, stride, start_is_mean=True)
    ends = [motion.position_m[row] + rotation[row] @ fit.lever_m for row in rows]
    return np.asarray(np.linalg.norm((ends[1] - ends[0])[:, :2], axis=1))


def length_row(
    key: str,
    what: str,
    errors_m: Floats,
    target: int | None = None,
    goals: tuple[Goal, ...] = (),
) -> Row:
    """Errors of stride lengths."""
    figures = (mean_absolute(errors_m, CM), *mean_and_sd(errors_m, CM))
    return Row(key, what, figures, len(errors_m), "strides", target, goals)


def coverage_row(key: str, checks: Sequence[StrideCheck]) -> Row:
    """Row 8: how many of the 95 % intervals hold the optical length.

    Below a hundred strides all of them may: the share that 99 % allow to miss is then less than one stride. Whether the
    intervals are too wide shows in the errors divided by their standard uncertainties: their RMS should be 1.
    """
    covered = joined([check.covered.astype(np.float64) for check in checks])
    ratio = joined([check.error_m / check.sd_m for check in checks])
    rms = float(np.sqrt(np.mean(ratio**2))) if len(ratio) else float("nan")
    figures = (share("covered", int(covered.sum()), len(covered)), Figure("RMS of error/SD", rms, "", 2))
    high = 99.0 if len(covered) >= 100 else 100.0
    what = "95 % interval of a stride length covers the optical one"
    return Row(key, what, figures, len(covered), "strides", 8, (Goal("covered", low=90.0, high=high),))


def joined(parts: Sequence[Floats]) -> Floats:
    """All of them one after the other; empty for none."""
    return np.concatenate(parts) if parts else np.zeros(0)
