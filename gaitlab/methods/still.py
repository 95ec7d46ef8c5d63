"""What the detectors share: stretches of rows, majorities, sizes of vectors, filters that short signals survive."""

from __future__ import annotations

from typing import Literal

import numpy as np

from gaitlab.motion.model import FootMotion, Indices, Rests
from gaitlab.motion.moving import moving_mean
from gaitlab.recording.model import Bools, Floats


def size(vectors: Floats) -> Floats:
    """Length of each row of vectors (n, 3), shape (n,)."""
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def free_acceleration(motion: FootMotion) -> Floats:
    """Free acceleration of each row, world, shape (n, 3), as the orientation gives it; 0 in the first row.

    ``FootMotion.acceleration_mps2`` holds what our smoother has learnt of tilt and offset; a published method is not to
    profit from that.
    """
    velocity = motion.raw_velocity_mps
    return np.asarray(np.diff(velocity, axis=0, prepend=velocity[:1]) * motion.rate_hz)


def samples(seconds: float, rate_hz: float) -> int:
    """A time in whole samples, at least one: windows that a paper gives for 100 Hz last as long at any rate."""
    return max(1, round(seconds * rate_hz))


def stretches(mask: Bools) -> tuple[Indices, Indices]:
    """Intervals ``[start, end)`` of rows in which the mask, shape (n,), is true."""
    framed = np.concatenate([[False], mask, [False]])
    edges = np.flatnonzero(framed[1:] != framed[:-1])
    return edges[::2], edges[1::2]


def majority(mask: Bools, reach: int) -> Bools:
    """What most of the ``reach`` rows on either side and the row itself say: the median filter of a yes or no.

    Beyond the ends the first and the last row are held.
    """
    return np.asarray(moving_mean(mask.astype(np.float64), 2 * reach + 1) > 0.5)


def rests_where(still: Bools) -> Rests:
    """A rest in every stretch of rows that is still; its moment is its middle, its residual is not computed."""
    start, end = stretches(still)
    return Rests(start, end, (start + end - 1) // 2, np.zeros((len(start), 3)))


def filtered(
    values: Floats, kind: Literal["low", "high"], cut_hz: float, order: int, rate_hz: float
) -> Floats:
    """Butterworth filter without delay (forward and backward) along the first axis.

    A signal of fewer rows than the filter needs, or sampled at less than twice the cut, is passed as it is, its mean
    taken out by a high pass.
    """
    if len(values) < 2 * order + 2 or 2.0 * cut_hz >= rate_hz:
        return np.asarray(values - values.mean(axis=0)) if kind == "high" else values
    from scipy.signal import butter, sosfiltfilt  # takes a new process a quarter of a second

    sections = butter(order, cut_hz, kind, fs=rate_hz, output="sos")
    pad = min(3 * (2 * len(sections) + 1), len(values) - 1)
    return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=pad))
