"""May a stride be used? Each is valid, wants attention, or is invalid, with the reason in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gaitlab.motion.model import FootMotion, Indices
from gaitlab.motion.path import PathParams
from gaitlab.recording.model import Bools, Floats


class Quality(StrEnum):
    """Of a stride or of a trial, the better first."""

    VALID = "valid"
    ATTENTION = "attention"
    INVALID = "invalid"


@dataclass(frozen=True)
class StrideQualityParams:
    """From when on a stride wants attention, and from when on it is left out of means.

    Attributes
    ----------
    lost_share, most_lost_share : float
        Share of its samples that were lost: attention, invalid. Of 1,653 strides of ``mtw-10m-walk`` 9 % and 0.1 % lost
        more; what their loss leaves uncertain is in their interval.
    blind_gap_s : float
        A longer gap hides the movement: invalid.
    most_saturated_share : float
        Any saturated sample wants attention; with more than this share the movement was not recorded.
    drift, most_drift : float
        Acceleration error that the velocity at the stride's end implies, over the median of the foot's strides:
        attention, invalid. 0.5 % of the strides of ``mtw-10m-walk`` lie above 4.3, 0.1 % above 8.7.
    least_drift_mps2 : float
        A median below this counts as this: below what 95 % of the feet of ``mtw-10m-walk`` reach (0.13 m/s²).
    """

    lost_share: float = 0.1
    most_lost_share: float = 0.5
    blind_gap_s: float = PathParams().blind_gap_s
    most_saturated_share: float = 0.1
    drift: float = 5.0
    most_drift: float = 10.0
    least_drift_mps2: float = 0.1


@dataclass(frozen=True, eq=False)
class Verdicts:
    """Verdict on each stride of a foot, shape (n,); ``reasons`` only of those that are not valid."""

    attention: Bools
    invalid: Bools
    reasons: Mapping[int, str]

    def of(self, stride: int) -> tuple[Quality, str]:
        """Verdict on one stride and the reason, empty where it is valid."""
        quality = Quality.INVALID if self.invalid[stride] else Quality.ATTENTION
        reason = self.reasons.get(stride, "")
        return (quality, reason) if reason else (Quality.VALID, "")


_Check = tuple[Bools, Callable[[int], str]]


def judge_strides(
    motion: FootMotion, length_m: Floats, length_sd_m: Floats, params: StrideQualityParams | None = None
) -> Verdicts:
    """Judge the movement from each rest to the next by what was recorded of it and how it fits its rests."""
    p = params or StrideQualityParams()
    rests = motion.rests
    leave, reach = np.maximum(rests.end - 1, rests.start)[:-1], rests.start[1:]
    lost = _share(~motion.received, leave, reach)
    saturated = _share(motion.saturated, leave, reach)
    gap_s = _longest_gap_s(motion, leave, reach, p.blind_gap_s)
    drift = _drift(motion, leave, reach, p)
    unsure = ~(length_sd_m < length_m / 1.96) & (length_m >= 0.1)

    def gone(k: int) -> str:
        return f"{100 * lost[k]:.0f} % of its samples were lost"

    def drifted(k: int) -> str:
        return f"the velocity drifted {drift[k]:.0f} times as much as in this foot's other strides"

    fatal: tuple[_Check, ...] = (
        (gap_s > 0.0, lambda k: f"{gap_s[k]:.2f} s of it were lost at a stretch"),
        (lost > p.most_lost_share, gone),
        (
            saturated > p.most_saturated_share,
            lambda k: f"{100 * saturated[k]:.0f} % of its samples reached the end of the sensor's range",
        ),
        (drift > p.most_drift, drifted),
        (unsure, lambda k: "its length is as uncertain as it is long"),
    )
    mild: tuple[_Check, ...] = (
        (lost > p.lost_share, gone),
        (saturated > 0.0, lambda k: "the sensor reached the end of its range"),
        (drift > p.drift, drifted),
    )
    return _worded(fatal, mild)


def _worded(fatal: Sequence[_Check], mild: Sequence[_Check]) -> Verdicts:
    """Verdicts from what makes strides invalid and what wants attention, each stride with its own reasons."""
    invalid = np.any([hit for hit, _ in fatal], axis=0)
    attention = np.any([hit for hit, _ in mild], axis=0) & ~invalid
    reasons = {}
    for k in map(int, np.flatnonzero(invalid | attention)):
        text = "; ".join(words(k) for hit, words in (fatal if invalid[k] else mild) if hit[k])
        reasons[k] = f"{text[0].upper()}{text[1:]}."
    return Verdicts(attention, invalid, reasons)


def _share(rows: Bools, leave: Indices, reach: Indices) -> Floats:
    """Share of marked rows in each movement."""
    count = np.concatenate([[0], np.cumsum(rows)])
    share: Floats = (count[reach] - count[leave]) / np.maximum(reach - leave, 1)
    return share


def _longest_gap_s(motion: FootMotion, leave: Indices, reach: Indices, least_s: float) -> Floats:
    """Longest gap in each movement, in seconds; 0 where there is none longer than ``least_s``."""
    longest = np.zeros(len(leave))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~motion.received, [False]]).astype(np.int8)))
    gaps = edges.reshape(-1, 2)
    for start, end in gaps[np.diff(gaps, axis=1)[:, 0] > least_s * motion.rate_hz]:
        touched = slice(np.searchsorted(reach, start, "right"), np.searchsorted(leave, end, "left"))
        longest[touched] = np.maximum(longest[touched], (end - start) / motion.rate_hz)
    return longest


def _drift(motion: FootMotion, leave: Indices, reach: Indices, p: StrideQualityParams) -> Floats:
    """Acceleration error implied by the velocity at each stride's end (see ``RestEvidence``), over the median of the
    foot's strides."""
    if not len(leave):
        return np.zeros(0)
    residual = np.linalg.norm(motion.rests.residual_mps[1:], axis=1)
    implied = residual * motion.rate_hz / np.maximum(reach - leave, 1)
    ratio: Floats = implied / max(float(np.median(implied)), p.least_drift_mps2)
    return ratio
