"""What a reader of a result should know about the data behind it, what stops an analysis, and the trial's verdict."""

from gaitlab.quality.data import (
    RESERVES,
    check_alternation,
    check_length,
    check_placements,
    findings,
    merged,
    with_reserve,
)
from gaitlab.quality.trial import TrialQuality, severity, trial_quality

__all__ = [
    "RESERVES",
    "TrialQuality",
    "check_alternation",
    "check_length",
    "check_placements",
    "findings",
    "merged",
    "severity",
    "trial_quality",
    "with_reserve",
]
