"""What joins a sensor on the thigh to its foot: thigh and shank as two links with a hinge between.

The shank wears no sensor, so its attitude is unknown; but the knee is a hinge and the shank has one length. With the
knee at p_leg + R_leg·r, the ankle at p_foot + R_foot·a and s from the one to the other, two things hold at every
moment, however far the knee is bent:

    (R_leg·j)·s = 0,  j the knee's axis in the thigh          |s| = L, the length of the shank

In stance the second holds the height, in swing, when the shank lies back, the way forward; the first holds the side.
The model of the leg is that of Bousdar Ahmed and Metzger 2017 (one degree of freedom at the knee); using it to bound
the drift of a thigh by its foot is ours.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gaitlab.motion.drift import DriftCurve
from gaitlab.motion.leg import LeverParams, Pair, RigidFit, white_sd, yaw_matrices
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class TwoLinkParams:
    """Sizes of what two links leave out, and what is known of legs.

    Attributes
    ----------
    hinge_sd_m : float
        How far the ankle leaves the plane of the hinge: skin turns about the thigh by some 5°, on 0.45 m.
    length_sd_m : float
        How far the distance from knee to ankle is from constant: skin, joints that are no points, the foot's path.
    lasting_s : float
        How long such errors last.
    levers : LeverParams
    above_knee_m : float
        Where the sensor is looked for first, above the knee.
    shank_m, shank_sd_m : float
        Length of the shank from knee to ankle, of people from 1.4 m to 2 m.
    axis_sd_rad : float
        How well the axis of the knee agrees with that about which the foot pitches: toeing out, a turned thigh.
    yaw_sd_rad : float
        How well the heading of a single rigid link is a start.
    max_rounds, enough : int, float
        Gauss–Newton steps at most; a step below this (metres, radians) is the last.
    """

    hinge_sd_m: float = 0.05
    length_sd_m: float = 0.015
    lasting_s: float = 0.1
    levers: LeverParams = field(default_factory=LeverParams)
    above_knee_m: float = 0.2
    shank_m: float = 0.41
    shank_sd_m: float = 0.06
    axis_sd_rad: float = 0.2
    yaw_sd_rad: float = 0.5
    max_rounds: int = 8
    enough: float = 0.005


@dataclass(frozen=True, eq=False)
class TwoLinkFit:
    """Two links, fitted: heading and drift as in ``RigidFit``.

    Attributes
    ----------
    leg_lever_m : ndarray (3,)
        From the leg's sensor to the knee, in the sensor's axes.
    below_m : float
        How far the knee is below the sensor, on average.
    shank_m : float
        Length of the shank.
    plausible : bool
        The knee is below the sensor and the shank is one that people have.
    misfit : float
        RMS of both statements, faster than the drift, in their standard deviations.
    """

    yaw_rad: float
    drift: Floats
    leg_lever_m: Floats
    below_m: float
    shank_m: float
    plausible: bool
    misfit: float


@dataclass(frozen=True, eq=False)
class _Leg:
    """Unknowns but the drift: levers, heading, length of the shank, axis of the knee in the thigh."""

    foot_lever: Floats
    leg_lever: Floats
    yaw: float
    shank: float
    axis: Floats

    def moved(self, step: Floats, beside: Floats) -> _Leg:
        """A step in (foot lever, leg lever, heading, length, the axis along the two rows of ``beside``)."""
        axis = self.axis + step[8:] @ beside
        return _Leg(
            self.foot_lever + step[:3],
            self.leg_lever + step[3:6],
            self.yaw + float(step[6]),
            self.shank + float(step[7]),
            axis / np.linalg.norm(axis),
        )


def fit_two_links(
    pair: Pair, curve: DriftCurve, start: RigidFit, params: TwoLinkParams | None = None
) -> TwoLinkFit:
    """Fit heading, levers, shank, axis and the leg's drift at once, by Gauss–Newton from a rigid link's heading."""
    p = params or TwoLinkParams()
    first = leg = _first_guess(pair, start, p)
    drift = start.drift
    sd = white_sd(1.0, p.lasting_s, curve) * np.array([p.hinge_sd_m, p.length_sd_m])
    weight = (pair.weight[:, None] / sd)[:, :, None]
    known = np.zeros((10, 10))
    known[:6, :6] = p.levers.precision(pair.leg_axes)
    known[6:, 6:] = np.diag(np.array([p.yaw_sd_rad, p.shank_sd_m, p.axis_sd_rad, p.axis_sd_rad]) ** -2)
    misfit = 0.0
    for _ in range(p.max_rounds):
        beside = np.linalg.svd(leg.axis[None, :])[2][1:]
        normals, statements = _statements(pair, leg, beside, curve.observed(drift))
        drifts, gram = curve.fit(weight * normals, weight * statements)
        off = np.concatenate(
            [
                leg.foot_lever,
                leg.leg_lever,
                [leg.yaw - first.yaw, leg.shank - first.shank],
                beside @ (leg.axis - first.axis),
            ]
        )
        step = -np.linalg.solve(gram[:10, :10] + known, gram[:10, 10] + known @ off)
        whole = np.append(step, 1.0)
        drift = -drifts @ whole
        leg = leg.moved(step, beside)
        misfit = float(np.sqrt(max(whole @ gram @ whole, 0.0) / (2.0 * np.count_nonzero(pair.weight))))
        if np.abs(step).max() < p.enough:
            break
    below = -float(np.mean(pair.leg_axes[:, 2] @ leg.leg_lever))
    plausible = below > 0.0 and abs(leg.shank - p.shank_m) < 2.5 * p.shank_sd_m
    return TwoLinkFit(leg.yaw, drift, leg.leg_lever, below, leg.shank, plausible, misfit)


def _first_guess(pair: Pair, start: RigidFit, p: TwoLinkParams) -> _Leg:
    """The knee bends about the axis about which the foot pitches, and lies below the sensor."""
    rate = pair.foot_rate_radps
    in_foot = (pair.foot_axes.transpose(0, 2, 1) @ rate[:, :, None])[..., 0]
    pitching = pair.foot_axes @ np.linalg.eigh(in_foot.T @ in_foot)[1][:, -1]
    to_leg = pair.leg_axes.transpose(0, 2, 1) @ yaw_matrices(np.array([-start.yaw_rad]))[0]
    axis = (to_leg @ pitching[:, :, None])[..., 0].mean(axis=0)
    axis /= max(float(np.linalg.norm(axis)), 1e-9)
    down = -pair.leg_axes[:, 2].mean(axis=0)
    return _Leg(np.zeros(3), p.above_knee_m * down, start.yaw_rad, p.shank_m, axis)


def _statements(pair: Pair, leg: _Leg, beside: Floats, drift: Floats) -> tuple[Floats, Floats]:
    """The two statements about the leg, linear about where it is.

    Returns
    -------
    normals : ndarray (k, 2, 3)
        By the drift.
    columns : ndarray (k, 2, 11)
        By the ten unknowns of ``_Leg.moved``; the last is the statement itself, without drift.
    """
    turn = yaw_matrices(np.array([leg.yaw]))[0]
    axes = turn @ pair.leg_axes
    knee = pair.leg_m @ turn.T + axes @ leg.leg_lever
    shank = pair.foot_m + pair.foot_axes @ leg.foot_lever - knee + drift
    length = np.linalg.norm(shank, axis=1)
    normals = np.stack([axes @ leg.axis, shank / length[:, None]], axis=1)
    columns = np.zeros((len(shank), 2, 11))
    columns[:, :, :3] = normals @ pair.foot_axes
    columns[:, :, 3:6] = -(normals @ axes)
    columns[:, :, 6] = normals[:, :, 0] * knee[:, 1:2] - normals[:, :, 1] * knee[:, :1]
    columns[:, 0, 6] += normals[:, 0, 0] * shank[:, 1] - normals[:, 0, 1] * shank[:, 0]
    columns[:, 1, 7] = -1.0
    columns[:, 0, 8:10] = (shank[:, None, :] @ axes)[:, 0] @ beside.T
    columns[:, 0, 10] = np.sum(normals[:, 0] * shank, axis=1)
    columns[:, 1, 10] = length - leg.shank
    columns[:, :, 10] -= (normals @ drift[:, :, None])[..., 0]
    return normals, columns
