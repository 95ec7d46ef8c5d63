"""Orientation from the gyroscope: closed forms, and the device's own increments."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gaitlab.motion.free import calibrate
from gaitlab.motion.quaternions import angular_rate, conjugate, matrices, midway, multiply, rotate
from gaitlab.motion.strapdown import (
    apply,
    integrate_rate,
    level_throughout,
    mean_force,
    small_rotation,
    upright,
)
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement


@pytest.mark.parametrize("n", [1, 2, 15, 16, 17, 500, 1025])
def test_the_orientation_is_the_product_of_all_rotations(n: int) -> None:
    rate = np.random.default_rng(n).normal(size=(n, 3)) * 8.0
    q = integrate_rate(rate, 100.0)
    whole = Rotation.identity()
    for k in range(1, n):
        whole = whole * Rotation.from_rotvec(rate[k] / 100.0)
    expected = whole.as_quat()[[3, 0, 1, 2]]
    np.testing.assert_allclose(q[-1] * np.sign(q[-1] @ expected), expected, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-12)


def test_a_steady_turn_is_a_steady_angle() -> None:
    q = integrate_rate(np.tile([0.0, 0.0, 0.5], (301, 1)), 100.0)
    np.testing.assert_allclose(2.0 * np.arctan2(q[:, 3], q[:, 0]), 0.005 * np.arange(301), atol=1e-12)


def test_angular_rate_is_its_inverse() -> None:
    rate = np.random.default_rng(3).normal(size=(50, 3))
    np.testing.assert_allclose(angular_rate(integrate_rate(rate, 100.0), 100.0)[1:], rate[1:], atol=1e-9)


def test_upright_turns_every_vector_to_the_vertical_even_one_that_hangs_down() -> None:
    vectors = np.vstack([np.random.default_rng(1).normal(size=(20, 3)), [[0.0, 0.0, -2.0], [0.0, 0.0, 3.0]]])
    size = np.linalg.norm(vectors, axis=1)
    expected = np.outer(size, [0.0, 0.0, 1.0])
    np.testing.assert_allclose(rotate(upright(vectors), vectors), expected, atol=1e-9)


def test_matrices_turn_as_quaternions_do() -> None:
    rng = np.random.default_rng(2)
    q = rng.normal(size=(30, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    v = rng.normal(size=(30, 3))
    np.testing.assert_allclose(apply(matrices(q), v), rotate(q, v), atol=1e-12)


def test_a_small_rotation_is_that_of_its_vector() -> None:
    vectors = np.random.default_rng(4).normal(size=(10, 3)) * 0.3
    q = Rotation.from_rotvec(vectors).as_quat()[:, [3, 0, 1, 2]]
    np.testing.assert_allclose(small_rotation(vectors), q, atol=1e-12)


def test_a_tilted_sensor_that_lies_still_becomes_level() -> None:
    attitude = np.tile([1.0, 0.0, 0.0, 0.0], (400, 1))
    force = np.tile([3.0, -4.0, 8.0], (400, 1))
    level = level_throughout(attitude, mean_force(force, 100.0))
    np.testing.assert_allclose(rotate(level, force)[:, :2], 0.0, atol=1e-9)


def test_the_gyroscope_turns_as_the_device_says(data_dir: Path) -> None:
    """MTw samples are means over the interval that ends with them: then increments agree, else by 0.1 rad/s not."""
    folder = data_dir / "mtw-leg-vicon"
    paths = {Placement.LEFT_FOOT: folder / "S02-Trial-Walk-1-000_00B40C55.txt"}
    sensor = read_recording(placements=paths).sensors[Placement.LEFT_FOOT]
    assert sensor.attitude is not None
    gyr = calibrate(sensor).gyr_radps
    own = integrate_rate(gyr, 100.0)
    ours = multiply(conjugate(own[:-1]), own[1:])
    device = multiply(conjugate(sensor.attitude[:-1]), sensor.attitude[1:])
    apart = multiply(conjugate(ours), device)
    rate = 2.0 * np.linalg.norm(apart[:, 1:], axis=1) * 100.0
    assert np.sqrt(np.mean(rate**2)) < 0.02
    half = midway(own, gyr, 100.0)
    before = multiply(conjugate(own[:-1]), half[1:])
    np.testing.assert_allclose(np.abs(multiply(before, before)[:, 0]), np.abs(ours[:, 0]), atol=1e-6)
