"""Rows 3 and 4: how far two feet went on the same walk, and how near to where they began they ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.recording.model import Floats, Side
from gaitlab.validation.model import Goal, Row
from gaitlab.validation.statistics import M, mean_and_sd, median_and_p95
from gaitlab.validation.ten_metres_trials import OFF, Labels, Trial

HALT_S = 0.5
"""A step that begins within this time of a trial's last contact brings the feet together and belongs to the halt."""


@dataclass(frozen=True, eq=False)
class Way:
    """How far one foot came: out and back by way of its farthest rest, and from its first place to its last."""

    out_and_back_m: float
    closing_m: Floats

    @property
    def closing_length_m(self) -> float:
        """Horizontal."""
        return float(np.linalg.norm(self.closing_m))


def way_of(foot: FootGait, labels: Labels, side: Side) -> Way | None:
    """Way of a foot from where it stood before its first labelled swing to where it stands after the trial.

    It stands there once the step is done, if any, that it began within half a second of the trial's last contact. What
    follows is no part of the trial: shuffles, steps out of it. None where the foot has fewer than two rests.
    """
    moments = foot.motion.time_s[foot.motion.rests.moment]
    places = foot.motion.rest_position_m[:, :2]
    if len(places) < 2:
        return None
    swings = labels.swings[side]
    began = float(swings[0, OFF]) if len(swings) else labels.trial[0]
    first = max(int(np.searchsorted(moments, began)) - 1, 0)
    rests = foot.motion.rests
    left = foot.motion.time_s[np.maximum(rests.end - 1, rests.start)]
    last = int(np.searchsorted(left[:-1], labels.trial[1] + HALT_S))
    path = places[first : max(last, first) + 1]
    far = path[np.argmax(np.linalg.norm(path - path[0], axis=1))]
    length = np.linalg.norm(far - path[0]) + np.linalg.norm(path[-1] - far)
    return Way(float(length), path[-1] - path[0])


def _ways(trial: Trial) -> dict[Side, Way]:
    found = {side: way_of(foot, trial.labels, side) for side, foot in trial.feet.items()}
    return {side: way for side, way in found.items() if way is not None}


def path_rows(trials: Sequence[Trial]) -> list[Row]:
    """Rows 3 and 4, and what of the closing is real.

    Where a person stops is their own affair; that the feet end side by side as they began is not: left less right
    closes along the walk, and across it differs by two step widths, since the feet have changed sides.
    """
    ways = [_ways(trial) for trial in trials]
    both = [(one[Side.LEFT], one[Side.RIGHT]) for one in ways if len(one) == len(Side)]
    differences = [left.out_and_back_m - right.out_and_back_m for left, right in both]
    closing = [way.closing_length_m for one in ways for way in one.values()]
    middle = [float(np.linalg.norm(0.5 * (left.closing_m + right.closing_m))) for left, right in both]
    apart = np.array([left.closing_m - right.closing_m for left, right in both]).reshape(-1, 2)
    n = len(both)
    return [
        Row(
            "path_left_minus_right",
            "path out and back by the farthest rest, left − right",
            mean_and_sd(differences, M),
            n,
            "trials",
            3,
            (Goal("SD", high=0.5),),
        ),
        Row(
            "closing_foot",
            "closing error of a foot at the end of the trial",
            median_and_p95(closing, M),
            len(closing),
            "feet",
            4,
            (Goal("median", high=0.3), Goal("P95", high=0.8)),
        ),
        Row(
            "closing_middle",
            "  the same of the point midway between the feet",
            median_and_p95(middle, M),
            n,
            "trials",
        ),
        Row(
            "closing_apart_along",
            "  left − right, along the walk (the feet end side by side)",
            mean_and_sd(apart[:, 0], M),
            n,
            "trials",
        ),
        Row(
            "closing_apart_across",
            "  left − right, across it (the feet have changed sides)",
            mean_and_sd(apart[:, 1], M),
            n,
            "trials",
        ),
    ]
