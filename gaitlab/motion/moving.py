"""Moving mean and moving maximum of a signal, whose ends are held.

The values are those of ``scipy.ndimage`` to the last bit; its import alone takes a new process a quarter of a second.
"""

from __future__ import annotations

import numpy as np

from gaitlab.recording.model import Floats


def moving_mean(values: Floats, width: int) -> Floats:
    """Mean of the ``width`` samples around each along the last axis; an even width reaches one farther back."""
    held = _held(values, width)
    total = np.empty(values.shape)
    total[..., 0] = np.add.accumulate(held[..., :width], axis=-1)[..., -1]
    np.subtract(held[..., width:], held[..., :-width], out=total[..., 1:])
    np.add.accumulate(total, axis=-1, out=total)
    total /= width
    return total


def moving_maximum(values: Floats, width: int) -> Floats:
    """Highest of the ``width`` samples around each, shape (n,), from the highest of 2, 4, 8 …."""
    highest = _held(values, width)
    reach = 1
    while 2 * reach <= width:
        highest = np.maximum(highest[:-reach], highest[reach:])
        reach *= 2
    return np.maximum(highest[: len(values)], highest[width - reach :])


def _held(values: Floats, width: int) -> Floats:
    """The values with their ends held for half a window along the last axis."""
    before, n = width // 2, values.shape[-1]
    held = np.empty((*values.shape[:-1], n + width - 1))
    held[..., :before] = values[..., :1]
    held[..., before : before + n] = values
    held[..., before + n :] = values[..., -1:]
    return held
