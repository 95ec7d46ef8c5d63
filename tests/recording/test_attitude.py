"""Orientations of every spelling become the same quaternions."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.recording.attitude import (
    continuous,
    from_euler,
    from_matrix,
    multiply,
    ned_to_enu,
    rotation_angle_rad,
    up_component,
)

angle_deg = st.floats(-180, 180, allow_nan=False)
seeds = st.integers(0, 2**32 - 1)


def random_rotations(seed: int, n: int = 20) -> Rotation:
    return Rotation.random(n, rng=np.random.default_rng(seed))


def same(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Equal as rotations: a quaternion and its negative are one."""
    return np.asarray(np.abs(np.abs(np.sum(a * b, axis=1)) - 1))


@settings(deadline=None)
@given(seeds)
def test_matrix_to_quaternion_as_scipy_does_it(seed: int) -> None:
    rotations = random_rotations(seed)
    quaternion = from_matrix(rotations.as_matrix())
    assert same(quaternion, rotations.as_quat(scalar_first=True)).max() < 1e-12


def test_half_turns_have_no_singularity() -> None:
    half_turns = np.array(
        [np.diag([1.0, -1.0, -1.0]), np.diag([-1.0, 1.0, -1.0]), np.diag([-1.0, -1.0, 1.0]), np.eye(3)]
    )
    np.testing.assert_allclose(np.abs(from_matrix(half_turns)), np.eye(4)[[1, 2, 3, 0]], atol=1e-15)


@settings(deadline=None)
@given(angle_deg, angle_deg, angle_deg)
def test_euler_angles_are_yaw_then_pitch_then_roll(roll: float, pitch: float, yaw: float) -> None:
    quaternion = from_euler(np.array([roll]), np.array([pitch]), np.array([yaw]))
    expected = Rotation.from_euler("ZYX", [[yaw, pitch, roll]], degrees=True).as_quat(scalar_first=True)
    assert same(quaternion, expected).max() < 1e-12


@settings(deadline=None)
@given(seeds)
def test_product_is_the_composition_of_rotations(seed: int) -> None:
    a, b = random_rotations(seed), random_rotations(seed + 1)
    product = multiply(a.as_quat(scalar_first=True), b.as_quat(scalar_first=True))
    assert same(product, (a * b).as_quat(scalar_first=True)).max() < 1e-12


@settings(deadline=None)
@given(seeds)
def test_north_east_down_becomes_east_north_up(seed: int) -> None:
    rotations = random_rotations(seed)
    vector = np.array([0.3, -0.5, 0.8])
    north, east, down = rotations.apply(vector).T
    turned = Rotation.from_quat(ned_to_enu(rotations.as_quat(scalar_first=True)), scalar_first=True).apply(
        vector
    )
    np.testing.assert_allclose(turned, np.stack([east, north, -down], axis=1), atol=1e-12)


@settings(deadline=None)
@given(seeds)
def test_up_component(seed: int) -> None:
    rotations = random_rotations(seed)
    vectors = np.random.default_rng(seed).normal(size=(20, 3))
    up = up_component(rotations.as_quat(scalar_first=True), vectors)
    np.testing.assert_allclose(up, rotations.apply(vectors)[:, 2], atol=1e-12)


@settings(deadline=None)
@given(st.lists(st.booleans(), min_size=30, max_size=30))
def test_continuous_undoes_every_flip_of_sign(flips: list[bool]) -> None:
    smooth = from_euler(np.linspace(0, 400, 30), np.linspace(0, 80, 30), np.linspace(0, -300, 30))
    flipped = smooth * np.where(flips, -1.0, 1.0)[:, None]
    restored = continuous(flipped)
    assert np.all(np.sum(restored[1:] * restored[:-1], axis=1) > 0)
    assert same(restored, smooth).max() < 1e-12
    assert np.array_equal(restored[0], flipped[0])


def test_angle_between_successive_orientations() -> None:
    yaw_deg = np.array([0.0, 1.0, 4.0, 4.0])
    angle = rotation_angle_rad(from_euler(np.zeros(4), np.zeros(4), yaw_deg))
    np.testing.assert_allclose(np.rad2deg(angle), [1.0, 3.0, 0.0], atol=1e-5)
