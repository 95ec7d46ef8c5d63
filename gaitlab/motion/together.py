"""What two feet know of each other's heading: they walk every straight part in one direction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.motion.chain import solve_chain
from gaitlab.motion.course import Course, CourseParams, Swings
from gaitlab.motion.model import FootMotion
from gaitlab.motion.smoother import SmootherParams
from gaitlab.recording.model import Floats, Side


@dataclass(frozen=True)
class TogetherParams:
    """How well a straight part tells a foot's direction.

    Attributes
    ----------
    sideways_m : float
        How far a place of rest lies beside the line of its foot: 0.035 in the straight parts of ``mtw-10m-walk``.
    least_rests : int
        Places of rest that make a line.
    """

    sideways_m: float = 0.035
    least_rests: int = 3


@dataclass(frozen=True)
class Direction:
    """Direction of a foot on a straight part: when, which way, and how sure (seconds, radians)."""

    time_s: float
    angle_rad: float
    sd_rad: float


def with_one_heading(feet: Mapping[Side, FootMotion], course: Course) -> dict[Side, FootMotion]:
    """The feet with the difference of their headings' drift taken out, each by its share of the doubt.

    Only the difference shows: what both headings have in common looks like a walk that bends. The first straight part
    keeps each foot's own direction (``frame`` turns them into one).
    """
    if len(feet) < 2 or len(course.straights) < 2:
        return dict(feet)
    left, right = (directions(feet[side], course) for side in Side)
    shared = sorted(left.keys() & right.keys())
    if len(shared) < 2:
        return dict(feet)
    drift = {side: feet[side].offsets.drift_sd_radps for side in Side}
    total = drift[Side.LEFT] ** 2 + drift[Side.RIGHT] ** 2
    time_s = np.array([0.5 * (left[k].time_s + right[k].time_s) for k in shared])
    apart = np.array([right[k].angle_rad - left[k].angle_rad for k in shared])
    apart = np.angle(np.exp(1j * (apart - apart[0])))
    variance = np.array([left[k].sd_rad ** 2 + right[k].sd_rad ** 2 for k in shared])
    estimate = _drift_between(time_s, apart, variance, total)
    turned = {}
    for side, sign in ((Side.LEFT, 1.0), (Side.RIGHT, -1.0)):
        share = sign * drift[side] ** 2 / total
        turned[side] = feet[side].redirected(share * np.interp(feet[side].time_s, time_s, estimate))
    return turned


def directions(
    foot: FootMotion, course: Course, params: TogetherParams | None = None
) -> dict[int, Direction]:
    """Direction of a foot on each straight part that it walks, by the line through its places of rest."""
    p = params or TogetherParams()
    if len(foot.rests) < p.least_rests:
        return {}
    swings = Swings.of(foot, CourseParams())
    found = {}
    for part, span in enumerate(course.straights):
        low, high = swings.rests_within(span)
        if high - low + 1 < p.least_rests:
            continue
        place = swings.place_m[low : high + 1]
        centred = place - place.mean(axis=0)
        along = np.linalg.svd(centred, full_matrices=False)[2][0]
        along = along if along @ (place[-1] - place[0]) >= 0.0 else -along
        spread = float(np.linalg.norm(centred @ along))
        middle = 0.5 * float(swings.leave_s[low] + swings.reach_s[high - 1])
        found[part] = Direction(
            middle, float(np.arctan2(along[1], along[0])), p.sideways_m / max(spread, 1e-3)
        )
    return found


def _drift_between(time_s: Floats, apart_rad: Floats, variance: Floats, drift_var: float) -> Floats:
    """Difference of the headings at each straight part against the first: a drift that is steady but for a slow walk,
    and what each part says of it."""
    walk = SmootherParams()
    n = len(time_s)
    diagonal, upper, right = np.zeros((n, 2, 2)), np.zeros((n - 1, 2, 2)), np.zeros((n, 2))
    diagonal[:, 0, 0] = 1.0 / variance
    right[:, 0] = apart_rad / variance
    diagonal[0] += np.diag([1e-2 / variance.min(), 1.0 / drift_var])
    step = np.diff(time_s)
    before, after = np.zeros((n - 1, 2, 2)), np.tile(np.eye(2), (n - 1, 1, 1))
    before[:, 0, 0], before[:, 0, 1], before[:, 1, 1] = -1.0, -step, -1.0
    weight = 1.0 / (2.0 * np.array([walk.heading_walk_rad, walk.drift_walk_radps]) ** 2 * step[:, None])
    weighted = weight[:, :, None] * before
    diagonal[:-1] += np.swapaxes(before, 1, 2) @ weighted
    diagonal[1:] += weight[:, :, None] * after
    upper[:] = np.swapaxes(weighted, 1, 2)
    state = solve_chain(diagonal, upper, right).state[:, 0]
    return np.asarray(state - state[0])
