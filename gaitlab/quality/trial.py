"""May a trial be used? The verdict follows from what was found in its data, and says so in the same words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.gait.verdicts import Quality
from gaitlab.recording.model import Finding, Placement, Side

SEVERITY: dict[str, Quality] = {
    **dict.fromkeys(("no_walking", "not_one_walk", "few_rests", "most_strides_invalid"), Quality.INVALID),
    **dict.fromkeys(
        (
            "column_not_used",
            "course_used",
            "knee_without_foot",
            "lost_samples",
            "rate_overridden",
            "sensor_not_used",
            "standing_elsewhere",
        ),
        Quality.VALID,
    ),
}
"""Code of a finding → what it makes of the trial; every other finding wants attention."""


def severity(code: str) -> Quality:
    """What a finding of this code makes of the trial."""
    return SEVERITY.get(code, Quality.ATTENTION)


@dataclass(frozen=True)
class TrialQualityParams:
    """``most_invalid``: a foot of which more than this share of the strides is invalid makes the trial invalid."""

    most_invalid: float = 0.5


@dataclass(frozen=True)
class TrialQuality:
    """The verdict on a trial and its reasons, one sentence each; none where it is valid."""

    status: Quality
    reasons: tuple[str, ...]


def invalid_strides(feet: Mapping[Side, FootGait], params: TrialQualityParams | None = None) -> list[Finding]:
    """A finding for each foot of which strides of the walk are invalid."""
    p = params or TrialQualityParams()
    found = []
    for side, foot in feet.items():
        n, bad = int(foot.walking.sum()), int((foot.walking & foot.verdicts.invalid).sum())
        if not bad:
            continue
        most = bad > p.most_invalid * n
        at = ", ".join(
            f"{foot.start_s[k]:.1f}" for k in np.flatnonzero(foot.walking & foot.verdicts.invalid)[:5]
        )
        verb = "is" if bad == 1 else "are"
        message = (
            f"{bad} of {n} strides of the {side} foot {verb} invalid (at {at}{' …' if bad > 5 else ''} s) and left out of"
            f" the means{', which rest on the few that remain' if most else ''}."
        )
        found.append(
            Finding("most_strides_invalid" if most else "strides_invalid", message, Placement.foot(side))
        )
    return found


def trial_quality(findings: Iterable[Finding]) -> TrialQuality:
    """The worst that any finding makes of the trial; the reasons are the findings that make it so or want attention."""
    judged = [(severity(one.code), one.message) for one in findings]
    order = list(Quality)
    status = max((quality for quality, _ in judged), key=order.index, default=Quality.VALID)
    counted = sorted(
        (one for one in judged if one[0] is not Quality.VALID), key=lambda one: -order.index(one[0])
    )
    return TrialQuality(status, tuple(dict.fromkeys(message for _, message in counted)))
