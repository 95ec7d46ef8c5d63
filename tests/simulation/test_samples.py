"""Samples are what a sensor on that path would have sent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.recording import Placement, Recording, Side
from gaitlab.simulation import (
    GRAVITY_MPS2,
    TYPICAL_MTW,
    Plan,
    SensorErrors,
    Simulation,
    Stand,
    Turn,
    Walk,
    presets,
    simulate,
)
from gaitlab.simulation.sampling import Sampling
from tests.simulation.strapdown import Path, integrate

UP_MPS2 = np.array([0.0, 0.0, GRAVITY_MPS2])
SHORT = Plan((Stand(1.0), Walk(2.5), Turn(2.0), Walk(1.0), Stand(0.5)))


def back(walk: Simulation, placement: Placement) -> tuple[Path, np.ndarray, np.ndarray]:
    """The integrated path, and the true velocity and position at its rows."""
    sensor = walk.recording.sensors[placement]
    side = placement.side
    truth = walk.truth.feet[side] if placement.is_foot else walk.truth.knees[side]
    first = sensor.first_packet - walk.recording.first_packet
    path = integrate(sensor, truth.velocity_mps[first], truth.position_m[first])
    return path, truth.velocity_mps[first + path.rows], truth.position_m[first + path.rows]


@settings(max_examples=12, deadline=None)
@given(
    mounting=st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: sum(x * x for x in q) > 0.01),
    rate_hz=st.sampled_from([50.0, 60.0, 100.0, 204.8, 400.0]),
    placement=st.sampled_from(list(Placement)),
    lost=st.sampled_from([0.0, 0.1, 0.4]),
)
def test_adding_up_exact_samples_gives_the_exact_velocity_whatever_mounting_rate_and_loss(
    mounting: tuple[float, float, float, float], rate_hz: float, placement: Placement, lost: float
) -> None:
    errors = SensorErrors(mounting=mounting, lost_share=lost, late_start=9)
    path, velocity, _ = back(simulate(SHORT, errors, rate_hz=rate_hz), placement)
    np.testing.assert_allclose(path.velocity_mps, velocity, atol=1e-9)


@pytest.mark.parametrize("placement", list(Placement))
def test_double_integration_of_exact_samples_gives_the_path_within_a_millimetre(placement: Placement) -> None:
    path, _, position = back(simulate(SHORT, SensorErrors(mounting="random")), placement)
    error = np.linalg.norm(path.position_m - position, axis=1)
    assert error.max() < 1e-3


def test_double_integration_is_exact_to_a_tenth_of_a_millimetre_at_rests() -> None:
    walk = simulate(SHORT, rate_hz=200.0)
    path, _, position = back(walk, Placement.LEFT_FOOT)
    for start, end in walk.truth.feet[Side.LEFT].rests_s:
        row = round(0.5 * (start + end) * 200.0)
        assert np.linalg.norm(path.position_m[row] - position[row]) < 1e-4


def test_the_mounting_turns_the_samples_and_nothing_else() -> None:
    mounting = Rotation.from_euler("xyz", [0.4, -1.1, 2.0])
    plain = simulate(SHORT).recording.sensors[Placement.RIGHT_FOOT]
    errors = SensorErrors(mounting=tuple(mounting.as_quat(scalar_first=True)))
    turned = simulate(SHORT, errors).recording.sensors[Placement.RIGHT_FOOT]
    for name in ("acc_mps2", "gyr_radps"):
        np.testing.assert_allclose(
            mounting.apply(getattr(turned, name).copy()), getattr(plain, name), atol=1e-9
        )


@pytest.mark.parametrize("sampling", ["strapdown", "mean"])
def test_a_received_sample_after_a_gap_is_the_mean_over_the_gap(sampling: Sampling) -> None:
    whole = simulate(SHORT, sampling=sampling, knees=False)
    lossy = simulate(SHORT, SensorErrors(lost_share=0.3), sampling=sampling, knees=False)
    sensor = lossy.recording.sensors[Placement.LEFT_FOOT]
    exact = whole.recording.sensors[Placement.LEFT_FOOT]
    assert sensor.n_lost > 50
    for lossy_values, values in ((sensor.acc_mps2, exact.acc_mps2), (sensor.gyr_radps, exact.gyr_radps)):
        assert lossy_values is not None
        assert values is not None
        still = slice(0, 90)
        np.testing.assert_allclose(lossy_values[still].sum(axis=0), values[still].sum(axis=0), atol=1e-6)
        if sampling == "mean":
            rows = np.flatnonzero(sensor.received)
            upto = rows[-1] + 1
            np.testing.assert_allclose(lossy_values[:upto].sum(axis=0), values[:upto].sum(axis=0), atol=1e-9)


def test_lost_rows_hold_the_next_received_sample() -> None:
    errors = replace(TYPICAL_MTW, lost_share=0.3)
    sensor = simulate(SHORT, errors, seed=5).recording.sensors[Placement.LEFT_FOOT]
    lost = np.flatnonzero(~sensor.received)
    for name in ("acc_mps2", "gyr_radps"):
        values = getattr(sensor, name)
        np.testing.assert_array_equal(values[lost], values[lost + 1])


def test_about_the_wanted_share_is_lost_in_bursts_of_the_wanted_length() -> None:
    errors = SensorErrors(lost_share=0.2, lost_burst=3.0)
    plan = presets.long_walk(4.0)
    received = (
        simulate(plan, errors, knees=False, orientation=False).recording.sensors[Placement.LEFT_FOOT].received
    )
    assert np.mean(~received) == pytest.approx(0.2, abs=0.01)
    gaps = np.count_nonzero(np.diff(received.astype(int)) == -1)
    assert np.count_nonzero(~received) / gaps == pytest.approx(3.0, rel=0.06)
    assert received[0]
    assert received[-1]


def test_mean_samples_are_means_of_the_instantaneous_values() -> None:
    walk = simulate(SHORT, sampling="mean", knees=False)
    sensor = walk.recording.sensors[Placement.LEFT_FOOT]
    row, fine = 150, np.linspace(1.49, 1.50, 2001)
    motion = walk.truth.body.sensor(Placement.LEFT_FOOT, fine)
    force = motion.rotation.inv().apply(motion.acceleration_mps2 + UP_MPS2)
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    np.testing.assert_allclose(sensor.acc_mps2[row], np.trapezoid(force, fine, axis=0) / 0.01, atol=1e-4)
    rate = np.trapezoid(motion.angular_rate_radps, fine, axis=0) / 0.01
    np.testing.assert_allclose(sensor.gyr_radps[row], rate, atol=1e-4)


def test_a_sensor_at_rest_shows_gravity_its_offsets_and_its_noise() -> None:
    errors = SensorErrors(
        acc_noise=0.002,
        gyr_noise=0.0003,
        acc_offset_mps2=(0.1, -0.2, 0.3),
        gyr_offset_radps=(0.01, 0.02, -0.03),
        acc_scale=1.02,
    )
    sensor = simulate(Plan((Stand(60.0),)), errors, knees=False).recording.sensors[Placement.LEFT_FOOT]
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    # the foot points outwards, so its sensor's y axis is turned, but stays level
    np.testing.assert_allclose(
        sensor.acc_mps2.mean(axis=0), [0.1, -0.2, 1.02 * GRAVITY_MPS2 + 0.3], atol=2e-3
    )
    np.testing.assert_allclose(sensor.gyr_radps.mean(axis=0), [0.01, 0.02, -0.03], atol=3e-4)
    np.testing.assert_allclose(sensor.acc_mps2.std(axis=0), 0.02, rtol=0.06)
    np.testing.assert_allclose(sensor.gyr_radps.std(axis=0), 0.003, rtol=0.06)


def test_gyroscope_drift_is_a_random_walk_of_the_given_size() -> None:
    errors = SensorErrors(gyr_drift=0.001)
    ends = []
    for seed in range(40):
        sensor = simulate(Plan((Stand(25.0),)), errors, seed=seed, knees=False).recording.sensors
        gyr = sensor[Placement.RIGHT_FOOT].gyr_radps
        assert gyr is not None
        ends.append(gyr[-1])
    assert np.std(ends) == pytest.approx(0.005, rel=0.2)


def test_samples_beyond_the_range_are_cut_off_and_marked() -> None:
    errors = SensorErrors(acc_range_mps2=20.0, gyr_range_radps=4.0)
    sensor = simulate(SHORT, errors).recording.sensors[Placement.LEFT_FOOT]
    exact = simulate(SHORT).recording.sensors[Placement.LEFT_FOOT]
    assert exact.acc_mps2 is not None
    assert exact.gyr_radps is not None
    assert exact.n_saturated == 0
    beyond = np.any(np.abs(exact.acc_mps2) >= 20.0, axis=1) | np.any(np.abs(exact.gyr_radps) >= 4.0, axis=1)
    np.testing.assert_array_equal(sensor.saturated, beyond)
    assert sensor.n_saturated > 10
    for values, limit in ((sensor.acc_mps2, 20.0), (sensor.gyr_radps, 4.0)):
        assert values is not None
        assert np.abs(values).max() == limit


def test_quantised_samples_are_multiples_of_the_step() -> None:
    errors = replace(TYPICAL_MTW, acc_step_mps2=0.01, lost_share=0.0)
    acc = simulate(SHORT, errors).recording.sensors[Placement.RIGHT_KNEE].acc_mps2
    assert acc is not None
    np.testing.assert_allclose(acc / 0.01, np.round(acc / 0.01), atol=1e-6)


def test_perfect_orientation_carries_gravity_upwards() -> None:
    sensor = simulate(SHORT, SensorErrors(mounting="random")).recording.sensors[Placement.RIGHT_FOOT]
    assert sensor.attitude is not None
    assert sensor.acc_mps2 is not None
    up = Rotation.from_quat(sensor.attitude[:90], scalar_first=True).apply(sensor.acc_mps2[:90].copy())
    np.testing.assert_allclose(up, np.tile(UP_MPS2, (90, 1)), atol=1e-9)


def test_tilt_and_heading_of_the_device_are_off_by_about_what_was_asked() -> None:
    errors = SensorErrors(attitude_tilt_rad=0.01, attitude_heading_rad=0.5)
    tilts, headings = [], []
    for seed in range(30):
        sensor = simulate(Plan((Stand(20.0),)), errors, seed=seed, knees=False).recording.sensors
        attitude = sensor[Placement.RIGHT_FOOT].attitude
        assert attitude is not None
        matrix = Rotation.from_quat(attitude, scalar_first=True).as_matrix()
        tilts.append(np.arccos(np.clip(matrix[:, 2, 2], -1.0, 1.0)))
        headings.append(np.arctan2(matrix[0, 1, 0], matrix[0, 0, 0]) + 0.10)
    assert 0.01 < np.sqrt(np.mean(np.square(tilts))) < 0.04
    assert np.std(headings) == pytest.approx(0.5, rel=0.35)


def test_the_compass_points_north_and_the_barometer_falls_with_height() -> None:
    walk = simulate(SHORT, SensorErrors(mounting="random"), magnetometer=True, pressure=True)
    sensor = walk.recording.sensors[Placement.LEFT_KNEE]
    assert sensor.mag is not None
    assert sensor.attitude is not None
    assert sensor.pressure_pa is not None
    field = Rotation.from_quat(sensor.attitude, scalar_first=True).apply(sensor.mag.copy())
    np.testing.assert_allclose(field, np.tile(field[0], (len(field), 1)), atol=1e-9)
    height = walk.truth.knees[Side.LEFT].position_m[:, 2]
    slope = np.polyfit(height, sensor.pressure_pa, 1)[0]
    assert slope == pytest.approx(-12.0, abs=0.1)


def test_the_same_seed_gives_the_same_samples_and_another_seed_others() -> None:
    first, again, other = (
        simulate(SHORT, TYPICAL_MTW, seed=seed).recording.sensors[Placement.LEFT_KNEE] for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first.acc_mps2, again.acc_mps2)
    assert first.source.sha256 == again.source.sha256
    assert first.source.sha256 != other.source.sha256


def test_a_further_channel_changes_no_other() -> None:
    plain = simulate(SHORT, TYPICAL_MTW, orientation=False)
    rich = simulate(SHORT, TYPICAL_MTW, magnetometer=True, pressure=True, free_acceleration=True)
    for placement, sensor in plain.recording.sensors.items():
        np.testing.assert_array_equal(sensor.acc_mps2, rich.recording.sensors[placement].acc_mps2)
        np.testing.assert_array_equal(sensor.received, rich.recording.sensors[placement].received)


def test_each_sensor_may_have_its_own_errors() -> None:
    errors = {Placement.LEFT_FOOT: SensorErrors(acc_offset_mps2=(1.0, 0.0, 0.0))}
    exact, walk = simulate(SHORT), simulate(SHORT, errors)
    for placement in Placement:
        before, after = (simulated.recording.sensors[placement].acc_mps2 for simulated in (exact, walk))
        assert before is not None
        assert after is not None
        expected = [1.0, 0.0, 0.0] if placement is Placement.LEFT_FOOT else [0.0, 0.0, 0.0]
        np.testing.assert_allclose(after - before, np.tile(expected, (len(before), 1)), atol=1e-12)


def test_sensors_start_and_end_at_different_packets_of_one_clock() -> None:
    recording: Recording = simulate(SHORT, replace(TYPICAL_MTW, lost_share=0.0), seed=3).recording
    starts = {sensor.first_packet for sensor in recording.sensors.values()}
    assert len(starts) > 1
    assert (
        recording.first_packet
        == TYPICAL_MTW.first_packet
        == recording.sensors[Placement.LEFT_FOOT].first_packet
    )
    assert len({sensor.n_samples for sensor in recording.sensors.values()}) > 1
    assert len({sensor.device for sensor in recording.sensors.values()}) == 4
