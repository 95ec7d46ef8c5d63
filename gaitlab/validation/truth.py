"""What is laid against the truth, and how: matched instants, optical displacements, aligned paths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from gaitlab.motion.model import Indices
from gaitlab.recording.model import Floats


def match_instants(found_s: Floats, truth_s: Floats, tolerance_s: float) -> tuple[Indices, Indices]:
    """Pairs of found and true instants within a tolerance, one to one, the nearest first; both in order of time.

    Returns
    -------
    found, truth : ndarray (m,)
        Indices of the pairs, ordered by the true instant.
    """
    apart = np.abs(np.asarray(found_s)[:, None] - np.asarray(truth_s)[None, :])
    i, j = np.nonzero(apart <= tolerance_s + 1e-9)
    taken_i: set[int] = set()
    taken_j: set[int] = set()
    pairs = []
    for k in np.argsort(apart[i, j], kind="stable"):
        a, b = int(i[k]), int(j[k])
        if a not in taken_i and b not in taken_j:
            taken_i.add(a)
            taken_j.add(b)
            pairs.append((b, a))
    pairs.sort()
    return (
        np.array([a for _, a in pairs], dtype=np.intp),
        np.array([b for b, _ in pairs], dtype=np.intp),
    )


@dataclass(frozen=True, eq=False)
class OpticalPath:
    """A point seen by cameras: ``time_s`` (n,) on the clock of the sensors, ``point_m`` (n, 3), NaN where hidden."""

    time_s: Floats
    point_m: Floats

    def at(self, time_s: Floats) -> Floats:
        """Where the point was, straight lines between frames, shape (k, 3); NaN outside and where hidden."""
        place = [np.interp(time_s, self.time_s, axis, np.nan, np.nan) for axis in self.point_m.T]
        return np.stack(place, axis=1)

    def horizontal_length(self, start_s: Floats, end_s: Floats) -> Floats:
        """Horizontal distance between where the point was at two instants, shape (k,)."""
        length: Floats = np.linalg.norm((self.at(end_s) - self.at(start_s))[:, :2], axis=1)
        return length


@dataclass(frozen=True)
class LeverFit:
    """How a sensor's path was laid on an optical joint.

    Attributes
    ----------
    heading_rad : float
        Turn of the sensor's world about the vertical, to the left, one for the whole recording.
    lever_m : ndarray (3,)
        From the sensor to the joint, sensor frame, one for the whole recording.
    error_m : ndarray (n, 3)
        Turned path of the joint, less the optical one, each less its start in the same cycle.
    """

    heading_rad: float
    lever_m: Floats
    error_m: Floats


def fit_lever(
    position_m: Floats,
    rotation: Floats,
    optical_m: Floats,
    cycle: Indices,
    *,
    start_is_mean: bool = False,
) -> LeverFit:
    """Lay the path of a sensor on that of a joint: one heading, one lever arm, a start in every cycle.

    The joint is at p + R·r. Least squares over all rows of all cycles of what is left of
    Rz(ψ)(p + R·r) − optical after the start of each cycle has been subtracted. For a given ψ the lever arm r is
    linear; with it projected out the cost is a quadratic form in (cos ψ, sin ψ, 1).

    Parameters
    ----------
    position_m, optical_m : ndarray (n, 3)
    rotation : ndarray (n, 3, 3)
        Sensor to world.
    cycle : ndarray (n,)
        Which cycle each row belongs to, ascending.
    start_is_mean : bool
        The start of a cycle is its mean place instead of its first row.
    """

    def from_start(values: Floats) -> Floats:
        flat = values.reshape(len(values), -1)
        _, first, group = np.unique(cycle, return_index=True, return_inverse=True)
        if start_is_mean:
            sums = np.add.reduceat(flat, first, axis=0)
            starts = sums / np.bincount(group)[:, None]
        else:
            starts = flat[first]
        return np.asarray((flat - starts[group]).reshape(values.shape))

    path, arm, truth = from_start(position_m), from_start(rotation), from_start(optical_m)
    design = arm.reshape(-1, 3)
    with_cos = truth * np.array([1.0, 1.0, 0.0])
    with_sin = np.stack([truth[:, 1], -truth[:, 0], np.zeros(len(truth))], axis=1)
    fixed = truth * np.array([0.0, 0.0, 1.0]) - path
    # the optical path turned to the right by ψ, less the sensor's: targets @ (cos ψ, sin ψ, 1) = design @ lever
    targets = np.stack([with_cos.ravel(), with_sin.ravel(), fixed.ravel()], axis=1)
    levers = np.linalg.lstsq(design, targets, rcond=None)[0]
    left = targets - design @ levers
    form = left.T @ left

    def cost(heading: float) -> float:
        v = np.array([np.cos(heading), np.sin(heading), 1.0])
        return float(v @ form @ v)

    coarse = np.linspace(-np.pi, np.pi, 721)
    best = float(coarse[np.argmin([cost(h) for h in coarse])])
    step = float(coarse[1] - coarse[0])
    heading = float(minimize_scalar(cost, bounds=(best - step, best + step), method="bounded").x)
    lever = levers @ np.array([np.cos(heading), np.sin(heading), 1.0])
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    error: Floats = (path + arm @ lever) @ turn.T - truth
    return LeverFit(heading, lever, error)
