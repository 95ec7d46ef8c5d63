"""What joins a sensor on the shank to its foot: a rigid link from the ankle.

Wherever the sensor sits on the shank it stays at one distance from the ankle, and so does the foot's sensor. With
attitudes R and two lever arms that are constant in the sensors' own axes,

    p_leg + R_leg·r = p_foot + R_foot·a            (both are the ankle)

all the time, in swing as in stance. The leg's path from its accelerometer is right from one moment to the next and
wrong over seconds; this equation is right over seconds. What the one has more than the other is the drift.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gaitlab.motion.drift import DriftCurve
from gaitlab.motion.model import FootMotion, Motion
from gaitlab.motion.quaternions import matrices
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class LeverParams:
    """How far joints are from sensors; it decides only what a walk cannot tell, above all to which side they lie.

    Attributes
    ----------
    foot_sd_m : float
        Sensor on the foot to ankle.
    along_sd_m, beside_sd_m : float
        Sensor on the leg to ankle or knee, along the leg and across it: it is worn on the surface of the leg.
    """

    foot_sd_m: float = 0.1
    along_sd_m: float = 0.3
    beside_sd_m: float = 0.06

    def precision(self, leg_axes: Floats) -> Floats:
        """Of the foot's and the leg's lever entries, shape (6, 6); the leg is taken to stand upright on average."""
        up = leg_axes[:, 2].mean(axis=0)
        up /= max(float(np.linalg.norm(up)), 1e-9)
        precision = np.diag([self.foot_sd_m**-2] * 3 + [self.beside_sd_m**-2] * 3)
        precision[3:, 3:] += (self.along_sd_m**-2 - self.beside_sd_m**-2) * np.outer(up, up)
        return precision


@dataclass(frozen=True)
class RigidParams:
    """Sizes of what a rigid link leaves out.

    Attributes
    ----------
    sd_m : float
        How far the ankle as seen from the shank lies from the ankle as seen from the foot: skin, a joint that is no
        point, the foot's own path. Its optical centres in ``mtw-leg-vicon`` keep their distance within 0.007 m.
    lasting_s : float
        How long such an error lasts.
    levers : LeverParams
    headings : int
        Headings of the leg that are tried, before the best is refined.
    """

    sd_m: float = 0.01
    lasting_s: float = 0.1
    levers: LeverParams = field(default_factory=LeverParams)
    headings: int = 24


@dataclass(frozen=True, eq=False)
class Pair:
    """A leg sensor and its foot at the k observed rows of a drift curve.

    Attributes
    ----------
    leg_m, foot_m : ndarray (k, 3)
        Paths; the leg's is uncorrected and has a heading of its own.
    leg_axes, foot_axes : ndarray (k, 3, 3)
        Attitudes as matrices, sensor to world.
    foot_rate_radps : ndarray (k, 3)
        Angular rate of the foot, world axes.
    weight : ndarray (k,)
        How far the foot's path is to be believed, 0 to 1.
    """

    leg_m: Floats
    leg_axes: Floats
    foot_m: Floats
    foot_axes: Floats
    foot_rate_radps: Floats
    weight: Floats

    @classmethod
    def of(cls, leg: Motion, foot: FootMotion, shift: int, curve: DriftCurve, sd_m: float) -> Pair:
        """The pair at the rows of ``curve``; leg row = foot row + ``shift``.

        In the middle of a movement whose length is uncertain by u the foot's place is uncertain by about u/2, which
        adds to ``sd_m``.
        """
        rows = curve.rows
        there = rows - shift
        rests = foot.rests
        into = np.searchsorted(rests.start, there, side="right") - 1
        moving = (there >= rests.end[into]) & (into < len(rests) - 1)
        doubt = np.zeros(len(rows))
        doubt[moving] = 0.5 * foot.displacement_sd_m[into[moving]]
        weight = curve.counted / np.hypot(1.0, doubt / sd_m)
        return cls(
            leg.raw_position_m[rows],
            matrices(leg.attitude[rows]).transpose(2, 0, 1),
            foot.position_m[there],
            matrices(foot.attitude[there]).transpose(2, 0, 1),
            foot.rate_radps[there],
            weight,
        )


@dataclass(frozen=True, eq=False)
class RigidFit:
    """A rigid link, fitted.

    Attributes
    ----------
    yaw_rad : float
        Angle by which the leg's world must be turned to the left to agree with its foot's.
    drift : ndarray (n, 3)
        Coefficients of the leg's drift in the foot's world.
    leg_lever_m : ndarray (3,)
        From the leg's sensor to the ankle, in the sensor's axes.
    misfit : float
        RMS of what the link leaves, faster than the drift, in its standard deviations.
    unexplained : float
        The same against the foot's movement.
    """

    yaw_rad: float
    drift: Floats
    leg_lever_m: Floats
    misfit: float
    unexplained: float


def white_sd(sd: float, lasting_s: float, curve: DriftCurve) -> float:
    """Standard deviation that an error which lasts is given where each observed row counts as a new one."""
    return sd * float(np.sqrt(max(1.0, lasting_s * curve.rate_hz / curve.spacing)))


def fit_rigid_link(pair: Pair, curve: DriftCurve, params: RigidParams | None = None) -> RigidFit:
    """Fit heading, both levers and the leg's drift at once, by least squares.

    Everything but the heading is linear. So the drift is taken out of 24 series (the leg's path and the entries of
    its attitude, the same of the foot) in one go; every heading and every pair of levers is a mixture of what is left
    of them. Of all headings the best is taken: none has to be known before.
    """
    p = params or RigidParams()
    k = len(pair.leg_m)
    weight = (pair.weight / white_sd(p.sd_m, p.lasting_s, curve))[:, None, None]
    series = [pair.leg_m, pair.leg_axes.reshape(k, 9), pair.foot_m, pair.foot_axes.reshape(k, 9)]
    drifts, gram = curve.fit(weight, weight * np.concatenate(series, axis=1)[:, None, :])
    precision = p.levers.precision(pair.leg_axes)
    flat = _PARTS.reshape(21, 72)
    squares = (flat @ (gram @ _PARTS).reshape(21, 72).T).reshape(3, 7, 3, 7).transpose(0, 2, 1, 3)
    yaw = _best_heading(squares, precision, p)
    cost, levers = _cost(squares, np.array([yaw]), precision)
    mixture = np.concatenate([[1.0], levers[0]]) @ (
        _heading(np.array([yaw])) @ flat.reshape(3, 7 * 72)
    ).reshape(7, 72)
    count = 3 * max(1, int(np.count_nonzero(pair.weight)))
    misfit = float(np.sqrt(max(cost[0], 0.0) / count))
    movement = float(np.sqrt(np.trace(gram[12:15, 12:15]) / count))
    return RigidFit(
        yaw, drifts[:, 0] @ mixture.reshape(24, 3), levers[0, 3:], misfit, misfit / max(movement, 1e-9)
    )


def yaw_matrices(yaw: Floats) -> Floats:
    """Turns about the vertical to the left, shape (len(yaw), 3, 3)."""
    turn = np.zeros((len(yaw), 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(yaw)
    turn[:, 1, 0] = np.sin(yaw)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    return turn


def _parts() -> Floats:
    """How the 24 series make the distance between the two ankles, shape (3, 7, 24, 3).

    Always, times the cosine and times the sine of the heading; by itself and per unit of three entries of the foot's
    lever and three of the leg's; series; axis.
    """
    turn = np.zeros((3, 3, 3))
    turn[0, 2, 2] = turn[1, 0, 0] = turn[1, 1, 1] = turn[2, 0, 1] = 1.0
    turn[2, 1, 0] = -1.0
    parts = np.zeros((3, 7, 24, 3))
    parts[:, 0, :3] = turn
    parts[0, 0, 12:15] = -np.eye(3)
    for m in range(3):
        parts[0, 1 + m, 15 + m :: 3] = -np.eye(3)
        parts[:, 4 + m, 3 + m : 12 : 3] = turn
    return parts


_PARTS = _parts()


def _heading(yaw: Floats) -> Floats:
    """What the three parts are multiplied by, shape (len(yaw), 3)."""
    return np.stack([np.ones_like(yaw), np.cos(yaw), np.sin(yaw)], axis=1)


def _cost(squares: Floats, yaw: Floats, precision: Floats) -> tuple[Floats, Floats]:
    """Least sum of squares at each heading, and the levers (foot, leg) that reach it, shape (len(yaw), 6).

    ``squares`` (3, 3, 7, 7) are the products of the parts.
    """
    heading = _heading(yaw)
    pairs = (heading[:, :, None] * heading[:, None, :]).reshape(-1, 9)
    square = (pairs @ squares.reshape(9, 49)).reshape(-1, 7, 7)
    inner = square[:, 1:, 1:] + precision
    levers = -np.asarray(np.linalg.solve(inner, square[:, 1:, :1]), dtype=np.float64)[..., 0]
    cost: Floats = square[:, 0, 0] + np.sum(square[:, 0, 1:] * levers, axis=1)
    return cost, levers


def _best_heading(squares: Floats, precision: Floats, p: RigidParams) -> float:
    step = 2.0 * np.pi / p.headings
    yaw = np.linspace(0.0, 2.0 * np.pi, p.headings, endpoint=False)
    best = float(yaw[np.argmin(_cost(squares, yaw, precision)[0])])
    for _ in range(3):  # a parabola through three headings, ever closer
        low, middle, high = _cost(squares, best + step * np.array([-1.0, 0.0, 1.0]), precision)[0]
        bend = low - 2.0 * middle + high
        best += step * (float(np.clip(0.5 * (low - high) / bend, -1.0, 1.0)) if bend > 0.0 else 0.0)
        step *= 0.25
    return best
