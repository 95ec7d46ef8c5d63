"""What the step-length models share: reasons, and rows of steps or strides in metres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.methods.model import Lengths
from gaitlab.methods.steps_signals import StepSignals
from gaitlab.recording.model import Bools, Floats

NO_SAMPLES = "there are no samples in the step"
NO_TIME = "the step takes no time"
STILL = "the vertical acceleration does not change in the step"
UNSAID = "the signals of the step are not known"
Why = tuple[Bools, str]
"""Steps whose length cannot be determined, and why not."""


def unseen(steps: StepSignals) -> tuple[Why, ...]:
    """Steps whose acceleration says nothing."""
    return (np.isnan(steps.max_g), NO_SAMPLES), (~(steps.range_g > 0.0), STILL)


def untimed(steps: StepSignals) -> tuple[Why, ...]:
    """Steps without a frequency."""
    return ((~np.isfinite(steps.frequency_spm), NO_TIME),)


def lengths_of(
    steps: StepSignals, step_m: Floats, why_not: Sequence[Why], outside: Bools | None = None
) -> Lengths:
    """Lengths of the rows from those of one step each; the first reason that holds stands."""
    n = len(steps)
    reason = [""] * n
    for mask, text in reversed(why_not):
        for i in np.flatnonzero(mask):
            reason[i] = text
    for i in np.flatnonzero(~np.isfinite(step_m)):
        reason[i] = reason[i] or UNSAID
    known = np.array([not text for text in reason], dtype=np.bool_)
    length = np.where(known, step_m * steps.steps_each, np.nan)
    marked = np.zeros(n, dtype=np.bool_) if outside is None else outside & known
    return Lengths(length, tuple(reason), marked)
