"""Quaternion algebra against scipy and against hand-worked rotations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.motion.quaternions import (
    angular_rate,
    conjugate,
    midway,
    multiply,
    rotate,
    turn_to_left,
    twist_about_vertical,
)

SEEDS = st.integers(0, 2**32 - 1)


def _random(seed: int, n: int) -> tuple[np.ndarray, Rotation]:
    rotation = Rotation.random(n, rng=np.random.default_rng(seed))
    return rotation.as_quat(scalar_first=True), rotation


@given(SEEDS)
def test_product_and_rotation_agree_with_scipy(seed: int) -> None:
    p, first = _random(seed, 4)
    q, second = _random(seed + 1, 4)
    v = np.random.default_rng(seed).normal(size=(4, 3))
    expected = (first * second).apply(v)
    np.testing.assert_allclose(rotate(multiply(p, q), v), expected, atol=1e-12)
    np.testing.assert_allclose(rotate(conjugate(p), first.apply(v)), v, atol=1e-12)


def test_a_quarter_turn_to_the_left_takes_forward_to_left() -> None:
    turned = turn_to_left(np.array([[1.0, 0.0, 2.0]]), np.pi / 2)
    np.testing.assert_allclose(turned, [[0.0, 1.0, 2.0]], atol=1e-15)


@given(SEEDS, st.floats(-3.1, 3.1))
def test_the_twist_of_a_turn_about_the_vertical_is_its_angle_whatever_the_pose(
    seed: int, angle: float
) -> None:
    pose, _ = _random(seed, 1)
    turn = np.array([[np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)]])
    relative = multiply(multiply(turn, pose), conjugate(pose))
    found = (twist_about_vertical(relative)[0] - angle + np.pi) % (2 * np.pi) - np.pi
    assert found == pytest.approx(0.0, abs=1e-9)


def test_the_angular_rate_of_a_steady_turn_is_constant() -> None:
    t = np.arange(50) / 100.0
    half = 0.5 * 2.0 * t
    q = np.stack([np.cos(half), np.zeros(50), np.sin(half), np.zeros(50)], axis=1)
    np.testing.assert_allclose(angular_rate(q, 100.0), np.tile([0.0, 2.0, 0.0], (50, 1)), atol=1e-9)


def test_midway_is_half_an_interval_back() -> None:
    half = 0.5 * 8.0 * np.array([0.0, 0.01])
    q = np.stack([np.cos(half), np.sin(half), np.zeros(2), np.zeros(2)], axis=1)
    found = midway(q, np.tile([8.0, 0.0, 0.0], (2, 1)), 100.0)
    assert 2.0 * np.arctan2(found[1, 1], found[1, 0]) == pytest.approx(0.04, abs=2e-5)
