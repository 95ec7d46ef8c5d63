"""Individual factors of the step-length models from walks of known length, and how far the models are off.

Sun et al. (2015), eq. 15, 16 and table II.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gaitlab.methods.model import Lengths, Method
from gaitlab.methods.steps_signals import Person, StepSignals
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class Factors:
    """What a person's test walk sets.

    Attributes
    ----------
    k : float
        The models' individual parameter; 1 before a test walk. For the constant and the nonlinear model it scales the
        usual step length.
    a, b, c : float
        Of the linear models, letters as in eq. 5 and 7 of the paper (metres per step/min; …); NaN before a test walk.
    normal_spm : float
        Frequency of the person's normal gait, for eq. 6; NaN: the average of the steps at hand, which the paper allows.
    """

    k: float = 1.0
    a: float = float("nan")
    b: float = float("nan")
    c: float = float("nan")
    normal_spm: float = float("nan")


@dataclass(frozen=True, eq=False)
class KnownWalk:
    """The steps of a walk and the distance they covered, measured otherwise."""

    steps: StepSignals
    length_m: float


@dataclass(frozen=True)
class LengthClass:
    """Errors of the lengths within one class of true length, ``[low, high)``; NaN where it is empty.

    ``deviation_percent`` is the mean of eq. 16.
    """

    low_m: float
    high_m: float
    n: int
    rmse_m: float
    deviation_percent: float


CLASS_EDGES_M = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Sun et al. (2015), table II."""
_POWER_OF_K = {"bylemans": 2}
"""Where the length does not grow with k itself: in eq. 8 it stands under a square root."""
_PREDICTORS = {"frequency_linear": ("frequency_spm",), "shin": ("frequency_spm", "variance_g2")}
"""Models that are linear in the person's factors, and what they are linear in."""
SAME_SPREAD = 0.02
"""Walks whose mean frequency (or variance, or a mixture of both) spreads by less than this share of its size are alike:
what their lengths differ by is no matter of it."""


def distance_m(lengths: Lengths) -> float:
    """Sum of the lengths, a step that is not determinable counted as the mean of the others; NaN where none is."""
    known = lengths.length_m[lengths.known]
    return float(known.mean() * len(lengths.length_m)) if len(known) else float("nan")


def calibrate(method: Method, walks: Sequence[KnownWalk], person: Person) -> Factors:
    """Factors of a model from walks of known length.

    k by eq. 15, the real distance of all walks over that estimated with k = 1; a, b, c by least squares on the mean step
    of each walk. Where the walks do not tell how the length changes with frequency or variance (all alike; not more of
    them than factors), no change is assumed: of all solutions the one of least slope. Models without a factor, and walks
    that determine none, leave it as it was.
    """
    steps = sum(len(walk.steps) * walk.steps.steps_each for walk in walks)
    if not steps:
        return Factors()
    if method.name in _PREDICTORS:
        return _linear(method.name, walks)
    spm = np.concatenate([walk.steps.frequency_spm for walk in walks])
    spm = spm[np.isfinite(spm)]
    start = Factors(normal_spm=float(spm.mean()) if len(spm) else float("nan"))
    estimated = [distance_m(method.run(walk.steps, person, start)) for walk in walks]
    known = [(walk.length_m, found) for walk, found in zip(walks, estimated, strict=True) if found > 0.0]
    if not known:
        return start
    real, found = np.sum(known, axis=0)
    k = float(real / found) ** _POWER_OF_K.get(method.name, 1)
    return Factors(k=k, normal_spm=start.normal_spm)


def _linear(name: str, walks: Sequence[KnownWalk]) -> Factors:
    """Slopes and constant by least squares, each walk counted by the root of its number of steps."""
    rows = []
    for walk in walks:
        seen = [getattr(walk.steps, one) for one in _PREDICTORS[name]]
        whole = np.isfinite(seen).all(axis=0)
        if whole.any():
            n = len(walk.steps) * walk.steps.steps_each
            rows.append((n, walk.length_m / n, *(float(one[whole].mean()) for one in seen)))
    if not rows:
        return Factors()
    table = np.array(rows)
    weight, length, seen_by = table[:, 0], table[:, 1], table[:, 2:]
    middle = np.average(seen_by, axis=0, weights=weight)
    typical = float(np.average(length, weights=weight))
    unit = np.maximum(np.abs(middle), 1e-12)
    root = np.sqrt(weight / weight.sum())
    u, spread, directions = np.linalg.svd(root[:, None] * (seen_by - middle) / unit, full_matrices=False)
    told = (spread >= SAME_SPREAD) & (np.arange(len(spread)) < len(rows) - 2)
    along = np.divide(u.T @ (root * (length - typical)), spread, out=np.zeros_like(spread), where=told)
    slopes = along @ directions / unit
    constant = float(typical - slopes @ middle)
    if name == "shin":
        return Factors(a=float(slopes[0]), b=float(slopes[1]), c=constant)
    return Factors(a=float(slopes[0]), b=constant)


def leave_one_out(method: Method, walks: Sequence[KnownWalk], person: Person) -> Floats:
    """Relative error of each walk's distance with the factors of the person's other walks, shape (w,).

    NaN where there is no other walk, or no step could be determined.
    """
    errors = np.full(len(walks), np.nan)
    for i, left_out in enumerate(walks):
        others = [walk for j, walk in enumerate(walks) if j != i]
        if others:
            lengths = method.run(left_out.steps, person, calibrate(method, others, person))
            errors[i] = distance_m(lengths) / left_out.length_m - 1.0
    return errors


def by_class(estimated_m: Floats, real_m: Floats) -> tuple[LengthClass, ...]:
    """Root mean square error and average deviation by class of the true length, as in table II; all of them last.

    Lengths that are not known do not count; the last row also holds those outside every class.
    """
    known = np.isfinite(estimated_m) & np.isfinite(real_m) & (real_m > 0.0)
    estimated, real = estimated_m[known], real_m[known]
    edges = [*pairwise(CLASS_EDGES_M), (0.0, float("inf"))]
    classes = []
    for low, high in edges:
        inside = (real >= low - 1e-9) & (real < high - 1e-9)
        error, true = (estimated - real)[inside], real[inside]
        if len(error):
            rmse = float(np.sqrt(np.mean(error**2)))
            deviation = float(100.0 * np.mean(np.abs(error) / true))
        else:
            rmse = deviation = float("nan")
        classes.append(LengthClass(low, high, len(error), rmse, deviation))
    return tuple(classes)
