"""Toe and heel of a foot, found from how it rolls, and how fast each of them moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from gaitlab.motion.model import FootMotion, Indices
from gaitlab.motion.quaternions import matrices
from gaitlab.motion.windows import Windows
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class SoleParams:
    """How toe and heel are found.

    Attributes
    ----------
    roll_share : float
        Only rolls at least this share as fast as the median one tell where the foot rolls over.
    slap_s : float
        The foot rolls over the heel from the fastest slap of the forefoot until this much later, when it lies flat.
    damping : float
        Share of the mean squared rotation that keeps the point near the sensor along the axis of the roll, along which
        it is not seen.
    """

    roll_share: float = 0.5
    slap_s: float = 0.06
    damping: float = 0.01


@dataclass(frozen=True, eq=False)
class FootSwings:
    """How a foot moves from rest to rest, rows and one entry a swing, shape (m,), or one a row, shape (n,).

    Attributes
    ----------
    whole, before, after : Windows
        From rest to rest, up to the fastest row and from it on.
    peak : ndarray (m,)
        Row in which the sensor is fastest.
    push, slap : ndarray (m,)
        Row of the fastest pitching forward before and after it: the heel's rise and the forefoot's fall.
    lateral : ndarray (3,)
        The foot's own lateral axis, to its left, in the sensor's frame.
    speed_mps, toe_mps, heel_mps : ndarray (n,)
        Speed of the sensor, of the point over which the foot rolls off, and of that over which it rolls on.
    pitch_radps : ndarray (n,)
        Rate about the foot's own lateral axis, positive when the toe goes down. A row is the mean over the interval
        that ends with it, so it belongs half a row earlier.
    """

    whole: Windows
    before: Windows
    after: Windows
    peak: Indices
    push: Indices
    slap: Indices
    lateral: Floats
    speed_mps: Floats
    toe_mps: Floats
    heel_mps: Floats
    pitch_radps: Floats

    @classmethod
    def of(cls, foot: FootMotion, params: SoleParams | None = None) -> Self:
        """Swings of a foot with at least two rests.

        The lateral axis is the one about which the foot turns most, in the sensor's frame, so a foot that turns the
        corner keeps its own. Toe and heel are the points of the foot that stay where they are while it rolls off and
        on: the r that minimises Σ|v + ω×r|² over those rows. Ours; no mounting, no length of foot is assumed.
        """
        p = params or SoleParams()
        rests = foot.rests
        world = matrices(foot.attitude)
        rate, velocity = _in_sensor(world, foot.rate_radps), _in_sensor(world, foot.velocity_mps)
        speed = _size(velocity)
        whole = Windows(rests.moment[:-1], np.maximum(rests.moment[1:] + 1, rests.moment[:-1] + 2))
        peak = whole.highest(speed)
        before, after = Windows(whole.start, peak + 1), Windows(peak, whole.end)
        lateral = _lateral_axis(rate, world, foot.velocity_mps)
        pitch = lateral @ rate
        push, slap = before.highest(pitch), after.highest(pitch)

        def point_speed(first: Indices, last: Indices, of: Indices) -> Floats:
            fast = pitch[of] >= p.roll_share * middle_of(pitch[of])
            chosen = rate * _inside(first[fast], last[fast], len(speed))
            point = _still_point(chosen @ rate.T, chosen @ velocity.T, p.damping)
            return _size(velocity + _cross_matrix(point) @ rate)

        toe = point_speed(whole.start, push + 1, push)
        flat = np.minimum(slap + max(1, round(p.slap_s * foot.rate_hz)), whole.end)
        heel = point_speed(slap, flat, slap)
        return cls(whole, before, after, peak, push, slap, lateral, speed, toe, heel, pitch)


def middle_of(values: Floats) -> float:
    """The middle one of a few values in order, the upper of two: a median at a tenth of numpy's cost."""
    return float(np.sort(values)[len(values) // 2])


def _in_sensor(world: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3) of the world in the sensor's frame, components first, shape (3, n)."""
    x, y, z = np.ascontiguousarray(vectors.T)
    turned: Floats = world[0] * x + world[1] * y + world[2] * z
    return turned


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(vectors[0] ** 2 + vectors[1] ** 2 + vectors[2] ** 2))


def _lateral_axis(rate: Floats, world: Floats, velocity_mps: Floats) -> Floats:
    """Unit vector to the left of the foot in the sensor's frame: the axis of most of its turning, with the way it
    walks ahead."""
    axis: Floats = np.linalg.eigh(rate @ rate.T)[1][:, -1]
    x, y = np.ascontiguousarray(velocity_mps[:, :2].T)
    ahead = float(axis @ (world[1] @ x - world[0] @ y))
    return axis if ahead >= 0.0 else -axis


def _inside(start: Indices, end: Indices, n: int) -> Floats:
    """1 in rows ``[start, end)`` that do not overlap, 0 elsewhere, shape (n,)."""
    edges = np.zeros(n + 1)
    edges[start] += 1.0
    edges[end] -= 1.0
    return np.cumsum(edges)[:n]


def _still_point(outer: Floats, mixed: Floats, damping: float) -> Floats:
    """Point of a rigid body, from the sensor, that moves least, from Σ ω ωᵀ and Σ ω vᵀ over the rows; the sensor
    itself where it does not turn."""
    turning = float(np.trace(outer))
    if turning <= 0.0:
        return np.zeros(3)
    normal = (turning + damping * turning) * np.eye(3) - outer
    moment = np.array([mixed[1, 2] - mixed[2, 1], mixed[2, 0] - mixed[0, 2], mixed[0, 1] - mixed[1, 0]])
    return np.asarray(np.linalg.solve(normal, moment))


def _cross_matrix(r: Floats) -> Floats:
    """The matrix M with M ω = ω × r."""
    return np.array([[0.0, r[2], -r[1]], [-r[2], 0.0, r[0]], [r[1], -r[0], 0.0]])
