"""The path through the rests: exact with exact sensors, offsets found, and as uncertain as it is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.orientation import OrientationSource
from gaitlab.motion.quaternions import conjugate, rotate
from gaitlab.recording.model import Placement, Sensor, Side
from gaitlab.simulation import TYPICAL_MTW, Simulation
from tests.walks import out_and_back, turned

LEFT = Placement.LEFT_FOOT


def track(
    walk: Simulation, sensor: Sensor | None = None, source: OrientationSource | None = None
) -> FootMotion:
    return track_foot(sensor or walk.recording.sensors[LEFT], walk.recording.time_s(LEFT), source=source)


def lengths(foot: FootMotion) -> np.ndarray:
    return np.linalg.norm(np.diff(foot.rest_position_m, axis=0)[:, :2], axis=1)


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0, 400.0])
def test_exact_sensors_give_strides_to_the_centimetre(rate_hz: float) -> None:
    walk = out_and_back(None, rate_hz)
    error = lengths(track(walk)) - walk.truth.feet[Side.LEFT].stride_length_m
    assert np.abs(error).max() < (0.02 if rate_hz < 100.0 else 0.01)


@pytest.mark.parametrize("source", list(OrientationSource))
def test_every_orientation_leads_to_the_same_strides(source: OrientationSource) -> None:
    walk = out_and_back()
    foot = track(walk, replace(walk.recording.sensors[LEFT], attitude=track(walk).attitude), source)
    error = lengths(foot) - walk.truth.feet[Side.LEFT].stride_length_m
    assert np.abs(error).max() < 0.02


def test_the_path_passes_through_the_places_of_rest_and_its_velocity_is_its_slope() -> None:
    foot = track(out_and_back())
    np.testing.assert_allclose(
        np.diff(foot.velocity_mps[foot.rests.mask(foot.n_samples)], axis=0), 0.0, atol=1e-9
    )
    slope = np.diff(foot.position_m, axis=0) * foot.rate_hz
    mean = 0.5 * (foot.velocity_mps[1:] + foot.velocity_mps[:-1])
    assert np.sqrt(np.mean((slope - mean) ** 2)) < 0.002


def test_an_accelerometer_offset_across_gravity_is_found_and_costs_no_length() -> None:
    """Standing cannot show it: there it is a tilt. A swing turns the sensor and tells the two apart."""
    walk = out_and_back()
    sensor = walk.recording.sensors[LEFT]
    assert sensor.acc_mps2 is not None
    across = np.cross(sensor.acc_mps2[:200].mean(axis=0), [0.3, 1.0, -0.2])
    offset = 0.25 * across / np.linalg.norm(across)
    plain, shifted = track(walk), track(walk, replace(sensor, acc_mps2=sensor.acc_mps2 + offset))
    np.testing.assert_allclose(lengths(shifted), lengths(plain), atol=0.012)


def test_turning_the_sensor_on_the_foot_changes_no_place() -> None:
    walk = out_and_back()
    matrix = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    plain, other = track(walk), track(walk, turned(walk.recording.sensors[LEFT], matrix))
    np.testing.assert_allclose(lengths(other), lengths(plain), atol=2e-4)
    np.testing.assert_allclose(other.displacement_sd_m, plain.displacement_sd_m, rtol=0.02)


def test_a_dead_accelerometer_warns_of_nothing() -> None:
    walk = out_and_back()
    sensor = walk.recording.sensors[LEFT]
    foot = track(walk, replace(sensor, acc_mps2=np.zeros((sensor.n_samples, 3))))
    assert np.isfinite(foot.position_m).all()


def test_a_level_floor_stays_level() -> None:
    foot = track(out_and_back())
    assert foot.level.all()
    assert np.abs(foot.rest_position_m[:, 2]).max() < 0.02


def test_uncertainty_grows_along_the_way_and_turns_with_the_world() -> None:
    foot = track(out_and_back())
    spread = np.sqrt(np.trace(foot.place_covariance_m2[:, :2, :2], axis1=1, axis2=2))
    assert spread[0] < 1e-5
    assert spread[-1] > 3.0 * spread[1]
    other = foot.turned(0.7)
    np.testing.assert_allclose(
        np.trace(other.place_covariance_m2, axis1=1, axis2=2),
        np.trace(foot.place_covariance_m2, axis1=1, axis2=2),
        rtol=1e-9,
    )
    assert not np.allclose(other.place_covariance_m2[-1], foot.place_covariance_m2[-1], rtol=0.05)
    np.testing.assert_allclose(np.linalg.eigvalsh(other.step_covariance_m2) > 0.0, True)


def test_what_a_saturated_sample_hides_is_put_where_it_was_hidden() -> None:
    """A clipped sample takes 0.4 m/s out of the swing. Known to be clipped it costs the length little; unknown, much."""
    walk = out_and_back()
    sensor, foot = walk.recording.sensors[LEFT], track(walk)
    row = int(foot.rests.start[4]) - 12
    saturated = np.zeros(sensor.n_samples, dtype=np.bool_)
    saturated[row] = True
    assert sensor.acc_mps2 is not None
    clipped = sensor.acc_mps2.copy()
    forward = np.diff(foot.rest_position_m, axis=0)[3] / lengths(foot)[3]
    clipped[row] -= 40.0 * rotate(conjugate(foot.attitude[row]), forward)
    known = track(walk, replace(sensor, acc_mps2=clipped, saturated=saturated))
    unknown = track(walk, replace(sensor, acc_mps2=clipped))
    error = np.abs([lengths(one)[3] - lengths(foot)[3] for one in (known, unknown)])
    assert error[0] < 0.02 < 0.05 < error[1]
    assert unknown.displacement_sd_m[3] > 2.0 * foot.displacement_sd_m[3]


def test_a_long_gap_hides_the_stride() -> None:
    walk = out_and_back(replace(TYPICAL_MTW, lost_share=0.0))
    sensor, foot = walk.recording.sensors[LEFT], track(walk)
    received = np.ones(sensor.n_samples, dtype=np.bool_)
    middle = int(foot.rests.end[3] + foot.rests.start[4]) // 2
    received[middle - 20 : middle + 20] = False
    hurt = track(walk, replace(sensor, received=received))
    assert hurt.displacement_sd_m[3] > 0.5
    assert np.delete(hurt.displacement_sd_m / foot.displacement_sd_m, 3).max() < 1.2


def test_a_sensor_that_lies_still_has_no_passages() -> None:
    still = Sensor(
        LEFT,
        out_and_back().recording.sensors[LEFT].source,
        100.0,
        0,
        np.ones(500, dtype=np.bool_),
        np.zeros(500, dtype=np.bool_),
        np.tile([0.0, 0.0, STANDARD_GRAVITY_MPS2], (500, 1)),
        np.zeros((500, 3)),
    )
    foot = track_foot(still, np.arange(500) / 100.0)
    assert len(foot.displacement_sd_m) == 0
    assert len(foot.place_covariance_m2) == len(foot.rests)
