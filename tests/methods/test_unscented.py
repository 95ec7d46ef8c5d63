"""The unscented filter: what it finds standing, turning, with an offset, and with nothing to go by."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gaitlab.methods import unscented
from gaitlab.methods.unscented import Belief, UnscentedParams

GRAVITY = 9.80665


def filtered(acc: np.ndarray, gyr: np.ndarray, rate_hz: float = 100.0) -> tuple[Rotation, Belief]:
    blocks = unscented.blocks_of(acc, gyr, rate_hz)
    turns, belief = unscented.run(blocks, unscented.first_belief(blocks), 0, len(blocks.seconds))
    return Rotation.from_quat(unscented.attitudes(blocks, turns), scalar_first=True), belief


def swinging(n: int = 1500, rate_hz: float = 100.0) -> tuple[Rotation, np.ndarray, np.ndarray]:
    """A sensor that swings by ±0.5 rad at 1 Hz about its y: truth, and what it reads (means over the intervals)."""
    time = np.arange(n + 1) / rate_hz
    truth = Rotation.from_euler("y", 0.5 * np.sin(2.0 * np.pi * time)[:, None])
    gyr = (truth[:-1].inv() * truth[1:]).as_rotvec() * rate_hz
    middle = truth[:-1] * Rotation.from_rotvec(0.5 * gyr / rate_hz)
    return truth[1:], middle.inv().apply([0.0, 0.0, GRAVITY]), gyr


def tilt_deg(found: Rotation, truth: Rotation) -> np.ndarray:
    up = [found.inv().apply([0.0, 0.0, 1.0]), truth.inv().apply([0.0, 0.0, 1.0])]
    return np.degrees(np.linalg.norm(up[0] - up[1], axis=1))


@pytest.mark.parametrize(
    "tilt", [(0.0, 0.0, 0.0), (0.4, -0.7, 0.2), (1.5, 0.0, 0.0), (3.1, 0.0, 0.0), (0.0, 1.57, 0.0)]
)
def test_the_tilt_of_a_sensor_at_rest_is_found(tilt: tuple[float, float, float]) -> None:
    truth = Rotation.from_rotvec(tilt)
    acc = np.tile(truth.inv().apply([0.0, 0.0, GRAVITY]), (300, 1))
    found, _ = filtered(acc, np.zeros((300, 3)))
    np.testing.assert_allclose(found.inv().apply([0.0, 0.0, 1.0]), acc / GRAVITY, atol=1e-9)


def test_a_sensor_that_turns_at_a_constant_rate_is_followed_in_heading_too() -> None:
    rate = np.tile([0.0, 0.0, 0.5], (1000, 1))
    found, _ = filtered(np.tile([0.0, 0.0, GRAVITY], (1000, 1)), rate)
    heading = np.unwrap(found.as_euler("ZYX")[:, 0])
    assert heading[-1] - heading[0] == pytest.approx(0.5 * 9.99, abs=1e-4)


def test_a_swinging_sensor_is_followed() -> None:
    truth, acc, gyr = swinging()
    found, _ = filtered(acc, gyr)
    assert tilt_deg(found, truth).max() < 0.3


def test_an_offset_of_the_gyroscope_is_found_where_gravity_shows_it() -> None:
    truth, acc, gyr = swinging(6000)
    offset = np.array([0.004, -0.003, 0.0])
    found, belief = filtered(acc, gyr + offset)
    np.testing.assert_allclose(belief.offset_radps[:2], offset[:2], atol=5e-4)
    assert tilt_deg(found, truth)[3000:].max() < 0.5


def test_without_a_filter_such_an_offset_would_tilt_the_sensor_by_degrees() -> None:
    truth, acc, gyr = swinging(6000)
    blocks = unscented.blocks_of(acc, gyr + np.array([0.004, -0.003, 0.0]), 100.0)
    assert tilt_deg(Rotation.from_quat(blocks.integral, scalar_first=True), truth)[-1] > 5.0


def test_what_the_filter_believes_of_its_error_is_what_the_error_is() -> None:
    """40 sensors at rest with an offset of the assumed size and noise: errors over their standard deviation."""
    rng, p = np.random.default_rng(5), UnscentedParams()
    ratios = []
    for _ in range(40):
        gyr = rng.normal(0.0, p.gyro_noise * 10.0, (400, 3)) + rng.normal(0.0, p.offset_sd_radps, 3)
        acc = np.array([0.0, 0.0, GRAVITY]) + np.repeat(
            rng.normal(0.0, p.force_sd_mps2 * np.sqrt(2.5), (40, 3)), 10, axis=0
        )
        found, belief = filtered(acc, gyr)
        up = found[-1].apply([0.0, 0.0, 1.0])
        ratios.append(np.array([-up[1], up[0]]) / np.sqrt(np.diag(belief.covariance)[:2]))
    assert 0.5 < np.sqrt(np.mean(np.square(ratios))) < 1.5


@pytest.mark.parametrize("mount", [(0.3, -0.2, 1.0), (2.0, 1.0, 0.0)])
def test_turning_the_sensor_on_the_leg_changes_nothing(mount: tuple[float, float, float]) -> None:
    _, acc, gyr = swinging(500)
    turn = Rotation.from_rotvec(mount)
    first, _ = filtered(acc, gyr + 0.002)
    other, _ = filtered(turn.inv().apply(acc), turn.inv().apply(gyr + 0.002))
    between = other * turn.inv() * first.inv()
    heading = between[0].as_matrix()
    np.testing.assert_allclose(
        heading[2], [0.0, 0.0, 1.0], atol=1e-3
    )  # a heading is each sensor's own, and it stays
    np.testing.assert_allclose(between.as_matrix(), np.broadcast_to(heading, (500, 3, 3)), atol=2e-3)


@pytest.mark.parametrize("rate_hz", [50.0, 200.0, 400.0])
def test_another_rate_gives_the_same_tilt(rate_hz: float) -> None:
    truth, acc, gyr = swinging(int(10 * rate_hz), rate_hz)
    found, _ = filtered(acc, gyr, rate_hz)
    assert tilt_deg(found, truth).max() < 0.6


def test_a_control_turns_the_orientation_in_the_sensor_s_own_axes() -> None:
    """Equation 6: C' = C·Δ."""
    _, acc, gyr = swinging(500)
    blocks = unscented.blocks_of(acc, gyr, 100.0)
    _, belief = unscented.run(blocks, unscented.first_belief(blocks), 0, len(blocks.seconds))
    at, delta = blocks.integral[-1], Rotation.from_euler("YX", [0.1, -0.2])
    after = unscented.controlled(belief, at, delta.as_quat(scalar_first=True))

    def orientation(one: Belief) -> Rotation:
        turn, integral = (Rotation.from_quat(q, scalar_first=True) for q in (one.turn, at))
        return turn * integral

    np.testing.assert_allclose(
        orientation(after).as_matrix(), (orientation(belief) * delta).as_matrix(), atol=1e-12
    )


def test_a_control_of_the_filter_fades_as_gravity_speaks_against_it() -> None:
    acc, gyr = np.tile([0.0, 0.0, GRAVITY], (6000, 1)), np.zeros((6000, 3))
    blocks = unscented.blocks_of(acc, gyr, 100.0)
    _, belief = unscented.run(blocks, unscented.first_belief(blocks), 0, 20)
    tilted = unscented.controlled(
        belief, blocks.integral[199], Rotation.from_euler("y", 0.1).as_quat(scalar_first=True)
    )
    turns, _ = unscented.run(blocks, tilted, 20, len(blocks.seconds))
    tilt = 2.0 * np.abs(turns[:, 2])
    assert tilt[0] > 0.05
    assert tilt[-1] < 0.005


def test_no_rows_one_row_and_no_force_at_all_are_no_error() -> None:
    for n in (0, 1, 3):
        blocks = unscented.blocks_of(np.zeros((n, 3)), np.zeros((n, 3)), 100.0)
        turns, _ = unscented.run(blocks, unscented.first_belief(blocks), 0, len(blocks.seconds))
        found = unscented.attitudes(blocks, turns)
        assert found.shape == (n, 4)
        assert np.all(np.isfinite(found))


def test_a_heading_that_nobody_knows_any_more_does_no_harm_to_the_tilt() -> None:
    truth, acc, gyr = swinging(3000)
    lost = UnscentedParams(offset_sd_radps=0.5, gyro_noise=0.2)
    blocks = unscented.blocks_of(acc, gyr, 100.0, lost)
    turns, belief = unscented.run(blocks, unscented.first_belief(blocks, lost), 0, len(blocks.seconds), lost)
    assert np.sqrt(belief.covariance[2, 2]) <= 0.5 + 1e-9
    assert (
        tilt_deg(Rotation.from_quat(unscented.attitudes(blocks, turns), scalar_first=True), truth).max() < 1.0
    )
