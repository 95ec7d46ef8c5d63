"""Fewer points for drawing: an hour at 100 Hz is 360,000 samples, a figure is some 300 points wide."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording.model import Bools, Floats


def envelope(values: Floats, bins: int = 320) -> NDArray[np.intp]:
    """Indices that keep the lowest and the highest sample of each bin, in order of time.

    Drawn as a line they look like the whole signal: no peak is lost. All indices where there are few samples.
    """
    n = len(values)
    if n <= 2 * bins:
        return np.arange(n)
    size = -(-n // bins)
    full = n // size
    block = values[: full * size].reshape(full, size)
    start = np.arange(full) * size
    kept = [start + block.argmin(axis=1), start + block.argmax(axis=1), [0, n - 1]]
    if full * size < n:
        rest = values[full * size :]
        kept.append([full * size + int(rest.argmin()), full * size + int(rest.argmax())])
    return np.unique(np.concatenate(kept)).astype(np.intp)


def thin(n: int, most: int) -> NDArray[np.intp]:
    """At most ``most`` evenly spaced indices of ``n`` samples, first and last among them."""
    if n <= most:
        return np.arange(n)
    return np.unique(np.linspace(0, n - 1, most).round().astype(np.intp))


def spans(t_s: Floats, mask: Bools, shortest_s: float = 0.0) -> Floats:
    """Intervals ``[start, end)`` of at least ``shortest_s`` in which ``mask`` holds, shape (k, 2), in seconds.

    What is too short to be seen is left out, not widened: an hour of steps must not look like an hour of rest.
    """
    if len(t_s) == 0 or not mask.any():
        return np.empty((0, 2))
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    period = (t_s[-1] - t_s[0]) / (len(t_s) - 1) if len(t_s) > 1 else 0.0
    found = np.column_stack((t_s[edges[::2]], t_s[edges[1::2] - 1] + period))
    long: Floats = found[found[:, 1] - found[:, 0] >= shortest_s]
    return long


def shares(t_s: Floats, mask: Bools, bins: int) -> Floats:
    """Rows of (start, end, share of ``mask``) for the stretches in which it holds at all, shape (k, 3)."""
    if len(t_s) == 0 or not mask.any():
        return np.empty((0, 3))
    size = max(1, -(-len(t_s) // bins))
    first = np.arange(0, len(t_s), size)
    last = np.append(first[1:], len(t_s)) - 1
    share = np.add.reduceat(mask.astype(float), first) / (last - first + 1)
    period = (t_s[-1] - t_s[0]) / (len(t_s) - 1) if len(t_s) > 1 else 0.0
    return np.column_stack((t_s[first], t_s[last] + period, share))[share > 0]
