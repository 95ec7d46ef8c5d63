"""Turns of a foot about the vertical."""

from __future__ import annotations

import numpy as np

from gaitlab.motion.model import Motion, Rests
from gaitlab.motion.quaternions import conjugate, multiply, twist_about_vertical
from gaitlab.recording.model import Floats


def heading_change(motion: Motion, rests: Rests) -> Floats:
    """Turn of a foot about the vertical from each rest to the next, radians, positive to the left, shape (k − 1,).

    Taken from the two orientations; the integrated angular rate decides between a turn and its complement to 360°.
    """
    stance = motion.attitude[rests.moment]
    turn = twist_about_vertical(multiply(stance[1:], conjugate(stance[:-1])))
    swept = np.add.reduceat(motion.rate_radps[:, 2], rests.moment)[:-1] / motion.rate_hz
    change: Floats = turn + 2.0 * np.pi * np.round((swept - turn) / (2.0 * np.pi))
    return change
