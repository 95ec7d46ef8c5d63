"""The links between foot and leg sensor, against legs of closed form: every lever, heading and drift is known."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from gaitlab.motion.drift import DriftCurve
from gaitlab.motion.leg import Pair, RigidFit, fit_rigid_link, yaw_matrices
from gaitlab.motion.thigh import fit_two_links
from gaitlab.recording.model import Floats

RATE_HZ, SHANK_M, THIGH_M, YAW_RAD = 100.0, 0.40, 0.42, 2.1
FOOT_LEVER = np.array([0.06, 0.01, -0.05])
TO_ANKLE, TO_KNEE = np.array([-0.04, 0.03, -0.31]), np.array([0.05, 0.02, -0.24])


def pitched(angle_rad: Floats, yaw_rad: Floats) -> Floats:
    """Axes of a segment that leans forward by ``angle_rad`` while it walks towards ``yaw_rad``."""
    c, s, zero, one = np.cos(angle_rad), np.sin(angle_rad), 0.0 * angle_rad, 0.0 * angle_rad + 1.0
    lean = np.stack([c, zero, s, zero, one, zero, -s, zero, c], axis=1).reshape(-1, 3, 3)
    return yaw_matrices(yaw_rad) @ lean


@dataclass(frozen=True)
class ClosedFormLeg:
    """Out and back: thigh and knee swing, the hip goes on and turns after ten seconds, everything else follows."""

    foot_m: Floats
    foot_axes: Floats
    foot_rate: Floats
    shank_m: Floats
    shank_axes: Floats
    thigh_m: Floats
    thigh_axes: Floats


def closed_form_leg() -> ClosedFormLeg:
    t = np.arange(2000) / RATE_HZ
    phase = 2.0 * np.pi * t / 1.1
    yaw = np.pi / (1.0 + np.exp(-(t - 10.0) / 0.4))
    lean = -0.15 - 0.35 * np.sin(phase)  # of the thigh; hip behind knee is negative
    bend = 0.15 + 0.9 * (0.5 + 0.5 * np.cos(phase + 0.3)) ** 3  # of the knee, once in swing
    thigh, shank = pitched(lean, yaw), pitched(lean + bend, yaw)
    pitch = lean + bend + 0.3 * np.sin(phase + 2.0)
    foot = pitched(pitch, yaw)
    forward = np.stack([np.cos(yaw), np.sin(yaw)], axis=1) * (1.2 / RATE_HZ)
    hip = np.column_stack([np.cumsum(forward, axis=0), 0.9 + 0.02 * np.cos(2.0 * phase)])
    knee = hip + thigh @ np.array([0.0, 0.0, -THIGH_M])
    ankle = knee + shank @ np.array([0.0, 0.0, -SHANK_M])
    rate = foot @ np.array([0.0, 1.0, 0.0]) * np.gradient(pitch, t)[:, None]
    return ClosedFormLeg(
        ankle - foot @ FOOT_LEVER, foot, rate, ankle - shank @ TO_ANKLE, shank, knee - thigh @ TO_KNEE, thigh
    )


def drift_of(t: Floats) -> Floats:
    """What a tilt that wanders by a few tenths of a degree does in 20 s."""
    return np.stack([0.4 * np.sin(0.5 * t), 0.1 * t, 0.3 * np.cos(0.4 * t)], axis=1)


def pair_of(
    leg: ClosedFormLeg, place_m: Floats, axes: Floats, mounting: Floats | None = None
) -> tuple[Pair, DriftCurve]:
    """The sensor's drifted path seen from a world of its own, whose heading is wrong by −YAW_RAD."""
    n = len(place_m)
    curve = DriftCurve.over(0, n - 1, n, RATE_HZ, 0.1, 0.0064)
    rows = curve.rows
    back = yaw_matrices(np.array([-YAW_RAD]))[0]
    path = (place_m + drift_of(np.arange(n) / RATE_HZ)) @ back.T
    turned = back @ axes if mounting is None else back @ axes @ mounting.T
    weight = curve.counted.astype(np.float64)
    return (
        Pair(path[rows], turned[rows], leg.foot_m[rows], leg.foot_axes[rows], leg.foot_rate[rows], weight),
        curve,
    )


def path_error_m(pair: Pair, curve: DriftCurve, fit: RigidFit, place_m: Floats) -> float:
    """Largest distance of the corrected path from the true one, the start set equal."""
    path = pair.leg_m @ yaw_matrices(np.array([fit.yaw_rad]))[0].T - curve.observed(fit.drift)
    error = path - place_m[curve.rows]
    return float(np.linalg.norm(error - error.mean(axis=0), axis=1).max())


def test_a_rigid_link_finds_heading_lever_and_path_of_a_shank() -> None:
    leg = closed_form_leg()
    pair, curve = pair_of(leg, leg.shank_m, leg.shank_axes)
    fit = fit_rigid_link(pair, curve)
    assert np.angle(np.exp(1j * (fit.yaw_rad - YAW_RAD))) == pytest.approx(0.0, abs=0.005)
    assert np.linalg.norm((fit.leg_lever_m - TO_ANKLE)[[0, 2]]) < 0.01  # to the side a walk hardly tells
    assert fit.unexplained < 0.02
    assert path_error_m(pair, curve, fit, leg.shank_m) < 0.01


@pytest.mark.parametrize("seed", range(3))
def test_how_a_sensor_sits_on_the_shank_does_not_matter(seed: int) -> None:
    leg = closed_form_leg()
    mounting, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    mounting = mounting * np.linalg.det(mounting)
    (pair, curve), (other, _) = (
        pair_of(leg, leg.shank_m, leg.shank_axes),
        pair_of(leg, leg.shank_m, leg.shank_axes, mounting),
    )
    fit, same = fit_rigid_link(pair, curve), fit_rigid_link(other, curve)
    np.testing.assert_allclose(mounting @ fit.leg_lever_m, same.leg_lever_m, atol=1e-6)
    np.testing.assert_allclose(curve.observed(fit.drift), curve.observed(same.drift), atol=1e-6)


def test_two_links_find_knee_shank_and_path_of_a_thigh() -> None:
    leg = closed_form_leg()
    pair, curve = pair_of(leg, leg.thigh_m, leg.thigh_axes)
    rigid = fit_rigid_link(pair, curve)
    two = fit_two_links(pair, curve, rigid)
    assert np.angle(np.exp(1j * (two.yaw_rad - YAW_RAD))) == pytest.approx(0.0, abs=0.005)
    assert two.misfit < 0.25 * rigid.misfit
    assert two.plausible
    assert two.shank_m == pytest.approx(SHANK_M, abs=0.03)
    assert np.linalg.norm((two.leg_lever_m - TO_KNEE)[[0, 2]]) < 0.02
    assert path_error_m(pair, curve, two, leg.thigh_m) < 0.01


def test_two_links_are_no_better_than_one_for_a_shank() -> None:
    leg = closed_form_leg()
    pair, curve = pair_of(leg, leg.shank_m, leg.shank_axes)
    rigid = fit_rigid_link(pair, curve)
    assert fit_two_links(pair, curve, rigid).misfit > 0.8 * rigid.misfit


def test_the_foot_of_another_walk_explains_nothing() -> None:
    """Half a cycle later, as the other leg: no lever makes up for it."""
    leg = closed_form_leg()
    own, curve = pair_of(leg, leg.shank_m, leg.shank_axes)
    late = np.roll(np.arange(len(curve.rows)), 5)
    other = replace(
        own, foot_m=own.foot_m[late], foot_axes=own.foot_axes[late], weight=own.weight * (late > 5)
    )
    assert fit_rigid_link(other, curve).unexplained > 5.0 * fit_rigid_link(own, curve).unexplained
