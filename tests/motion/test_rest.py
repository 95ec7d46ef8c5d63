"""One rest in every gait cycle: on simulated walks exactly, on the real ones as the hand-checked events say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.motion.extrema import prominent_peaks
from gaitlab.motion.foot import track_foot
from gaitlab.motion.free import free_motion
from gaitlab.motion.integration import reset_at_rests, velocity_of
from gaitlab.motion.model import Rests
from gaitlab.motion.rest import cycle_time, find_rests, no_rests, rest_evidence, restlessness, unrest
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement, Side
from gaitlab.simulation import TYPICAL_MTW, Plan, Stand, Turn, Walk, simulate
from gaitlab.simulation.walk import Gait
from gaitlab.validation.ten_metres_events import check_stances
from gaitlab.validation.ten_metres_trials import find_trials, read_trial
from tests.walks import out_and_back, turned


@given(st.lists(st.integers(0, 12), min_size=1, max_size=80), st.integers(1, 6))
@settings(max_examples=200)
def test_prominent_peaks_are_those_of_scipy(values: list[int], prominence: int) -> None:
    from scipy.signal import find_peaks

    array = np.array(values, dtype=float) + 1e-6 * np.arange(
        len(values)
    )  # no two alike: a plateau has no one peak
    expected, _ = find_peaks(np.concatenate([[-99.0], array, [-99.0]]), prominence=prominence)
    np.testing.assert_array_equal(prominent_peaks(array, prominence), expected - 1)


def _agree(found: np.ndarray, rests_s: np.ndarray) -> bool:
    """One moment within each true rest and none elsewhere."""
    return len(found) == len(rests_s) and bool(np.all((found >= rests_s[:, 0]) & (found <= rests_s[:, 1])))


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0, 400.0])
def test_every_rest_is_found_once_at_any_rate(rate_hz: float) -> None:
    walk = out_and_back(rate_hz=rate_hz)
    for side in Side:
        placement = Placement.foot(side)
        foot = track_foot(walk.recording.sensors[placement], walk.recording.time_s(placement))
        assert _agree(foot.time_s[foot.rests.moment], walk.truth.feet[side].rests_s)


@pytest.mark.parametrize("pace", [0.5, 0.7, 1.0, 1.3, 1.6])
def test_every_rest_is_found_once_at_any_pace(pace: float) -> None:
    gait = Gait(stride_time_s=1.08 / pace)
    walk = simulate(
        Plan((Stand(4.0), Walk(8.0), Turn(np.pi), Walk(4.0), Stand(2.0)), gait), TYPICAL_MTW, knees=False
    )
    for side in Side:
        placement = Placement.foot(side)
        foot = track_foot(walk.recording.sensors[placement], walk.recording.time_s(placement))
        assert _agree(foot.time_s[foot.rests.moment], walk.truth.feet[side].rests_s)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=10)
def test_turning_the_sensor_on_the_foot_changes_no_rest(seed: int) -> None:
    sensor = out_and_back().recording.sensors[Placement.LEFT_FOOT]
    time_s = np.arange(sensor.n_samples) / sensor.rate_hz
    matrix = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    plain, other = track_foot(sensor, time_s), track_foot(turned(sensor, matrix), time_s)
    assert len(plain.rests) == len(other.rests)
    assert np.abs(plain.rests.moment - other.rests.moment).max() <= 1
    length = [np.linalg.norm(np.diff(foot.rest_position_m, axis=0)[:, :2], axis=1) for foot in (plain, other)]
    np.testing.assert_allclose(length[0], length[1], atol=0.005)


def test_noise_of_a_sensor_that_lies_still_is_no_walk() -> None:
    rng = np.random.default_rng(5)
    acceleration, rate = rng.normal(0, 0.03, (3000, 3)), rng.normal(0, 0.005, (3000, 3))
    assert len(find_rests(acceleration, rate, 100.0)) == 0
    assert restlessness(unrest(acceleration, rate, 100.0)) is None


def test_the_gait_cycle_of_a_sine_is_its_period() -> None:
    t = np.arange(2000) / 100.0
    rate = np.stack([3.0 + 3.0 * np.sin(2 * np.pi * t / 1.25), 0 * t, 0 * t], axis=1)
    assert cycle_time(rate, 100.0) == pytest.approx(1.25, abs=0.02)


def test_real_feet_have_one_rest_in_every_hand_checked_stance(data_dir: Path) -> None:
    """1,523 stances: at most 1 % without a rest, at most 1 % of the short ones with two; none of the swings but 1 %."""
    checks = []
    for files in find_trials(data_dir / "mtw-10m-walk"):
        recording, labels = read_trial(files)
        for placement, sensor in recording.sensors.items():
            foot = track_foot(sensor, recording.time_s(placement))
            moments = foot.time_s[foot.rests.moment]
            checks.append(check_stances(moments, labels.swings[placement.side]))
    stances = sum(check.stances for check in checks)
    assert stances == 1523
    assert sum(check.missed for check in checks) <= 0.01 * stances
    assert sum(check.doubled for check in checks) <= 0.01 * stances
    assert sum(check.false for check in checks) <= 0.01 * sum(check.swings for check in checks)


def test_a_foot_comes_to_rest_and_a_shank_does_not(data_dir: Path) -> None:

    def least(device: str) -> float:
        path = data_dir / "mtw-leg-vicon" / f"S02-Trial-Walk-1-000_{device}.txt"
        sensor = read_recording(placements={Placement.LEFT_FOOT: path}).sensors[Placement.LEFT_FOOT]
        motion = free_motion(sensor, np.arange(sensor.n_samples) / 100.0)
        found = restlessness(unrest(motion.acceleration_mps2, motion.rate_radps, 100.0))
        assert found is not None
        return found

    feet = [least("00B40C55"), least("00B40C48")]
    shanks = [least("00B40BA5"), least("00B40C35"), least("00B40C44"), least("00B40C47")]
    assert max(feet) * 1.5 < min(shanks)


def test_a_rest_that_is_split_in_two_is_one_rest() -> None:
    """A twitch of the standing foot, too small for a step, neither ends a rest nor adds one."""
    walk = out_and_back()
    sensor = walk.recording.sensors[Placement.LEFT_FOOT]
    assert sensor.gyr_radps is not None
    gyr = sensor.gyr_radps.copy()
    gyr[150:190, 1] += 0.9 * np.sin(np.linspace(0, 2 * np.pi, 40))  # 5° there and back
    time_s = np.arange(sensor.n_samples) / sensor.rate_hz
    plain, twitching = track_foot(sensor, time_s), track_foot(replace(sensor, gyr_radps=gyr), time_s)
    assert len(twitching.rests) == len(plain.rests)


def test_the_evidence_of_a_rest_is_that_of_its_own_rows() -> None:
    rng = np.random.default_rng(8)
    acceleration, rate = rng.normal(0.0, 2.0, (400, 3)), rng.normal(1.0, 0.5, (400, 3))
    start, end = np.array([0, 90, 210, 399]), np.array([40, 92, 300, 400])
    rests = Rests(start, end, start, rng.normal(0.0, 0.1, (4, 3)))
    evidence = rest_evidence(acceleration, rate, rests, 200.0)
    np.testing.assert_allclose(evidence.duration_s, [0.2, 0.01, 0.45, 0.005])
    for k in range(3):
        rows = slice(start[k], end[k])
        expected = [np.sqrt(signal[rows].var(axis=0, ddof=1).sum()) for signal in (rate, acceleration)]
        assert [evidence.gyr_sd_radps[k], evidence.acc_sd_mps2[k]] == pytest.approx(expected)
    assert np.isnan([evidence.gyr_sd_radps[3], evidence.acc_sd_mps2[3]]).all()


def test_a_constant_error_of_the_acceleration_is_what_the_evidence_implies() -> None:
    """Closed form: a sensor that lies still and reads (0.03, 0.04, 0) m/s² too much, at rest now and then."""
    acceleration = np.tile([0.03, 0.04, 0.0], (1000, 1))
    rests = Rests(
        np.array([0, 150, 480]), np.array([50, 200, 481]), np.array([20, 170, 480]), np.zeros((3, 3))
    )
    _, rests = reset_at_rests(velocity_of(acceleration, 100.0), rests)
    evidence = rest_evidence(acceleration, np.zeros((1000, 3)), rests, 100.0)
    assert np.isnan(evidence.implied_acc_error_mps2[0])
    np.testing.assert_allclose(evidence.implied_acc_error_mps2[1:], 0.05)
    np.testing.assert_allclose(evidence.residual_mps, [0.0, 0.05 * 1.01, 0.05 * 2.81])


def test_no_rests_have_no_evidence() -> None:
    evidence = rest_evidence(np.zeros((9, 3)), np.zeros((9, 3)), no_rests(), 100.0)
    assert all(len(column) == 0 for column in vars(evidence).values())
