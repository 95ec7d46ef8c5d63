"""The tables of the public recordings: their size is what was published, and no figure is worse than it was.

The limits stand a little above the figures reached, so that a step back is noticed; the figures to reach are in the
tables themselves.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from gaitlab.recording import Placement, Side
from gaitlab.validation import Table, validate
from gaitlab.validation.foot_loop import read_loop
from gaitlab.validation.foot_mocap_files import read_feet, read_heel

FOLDERS = {
    "10m-walk": "mtw-10m-walk",
    "leg-vicon": "mtw-leg-vicon",
    "foot-mocap": "foot-mocap",
    "foot-loop": "foot-loop",
}


@cache
def _table(data_dir: Path, name: str) -> Table:
    return validate(name, data_dir / FOLDERS[name])


@pytest.mark.parametrize("name", FOLDERS)
def test_every_public_recording_is_used(data_dir: Path, name: str) -> None:
    table = _table(data_dir, name)
    assert not table.problems
    assert table.recordings == {"10m-walk": 46, "foot-mocap": 2}.get(name, 1)
    assert all(np.isfinite(figure.value) for row in table.rows for figure in row.figures)


@pytest.mark.parametrize(
    ("key", "n"),
    [
        ("path_left_minus_right", 46),
        ("closing_foot", 92),
        ("initial_contact", 1615),
        ("foot_off", 1615),
        ("rests", 1523),
    ],
)
def test_no_trial_and_no_labelled_event_of_ten_metres_is_left_out(data_dir: Path, key: str, n: int) -> None:
    assert _table(data_dir, "10m-walk").row(key).n == n


@pytest.mark.parametrize(
    ("name", "key", "figure", "limit"),
    [
        ("10m-walk", "path_left_minus_right", "SD", 0.5),
        ("10m-walk", "closing_foot", "median", 0.35),
        ("10m-walk", "closing_foot", "P95", 0.8),
        ("10m-walk", "stride_time", "MAE", 14.0),
        ("10m-walk", "rests", "missed", 1.0),
        ("10m-walk", "rests", "doubled", 1.0),
        ("10m-walk", "rests", "in a swing", 1.0),
        ("leg-vicon", "stride_length", "MAE", 1.7),
        ("leg-vicon", "stride_length", "SD", 2.3),
        ("leg-vicon", "stride_length_device", "MAE", 1.3),
        ("leg-vicon", "knee_shank_gaitlab", "3D RMS", 4.5),
        ("foot-mocap", "stride_length_heel", "MAE", 5.5),
        ("foot-loop", "loop_short_walk", "horizontal", 0.1),
    ],
)
def test_no_error_is_larger_than_it_was(
    data_dir: Path, name: str, key: str, figure: str, limit: float
) -> None:
    assert abs(_table(data_dir, name).row(key).value(figure)) <= limit


@pytest.mark.parametrize("key", ["initial_contact", "foot_off"])
@pytest.mark.parametrize("figure", ["recall", "precision"])
def test_hand_checked_events_are_found_and_few_others(data_dir: Path, key: str, figure: str) -> None:
    assert _table(data_dir, "10m-walk").row(key).value(figure) >= 93.0


def test_saturated_samples_of_shoes_are_marked(data_dir: Path) -> None:
    recording = read_feet(data_dir / "foot-mocap" / "imu_sample.csv")
    for sensor in recording.sensors.values():
        assert sensor.rate_hz == 204.8
        assert sensor.n_samples == 7928
        assert 1 <= sensor.n_saturated <= 20
        assert np.abs(sensor.acc_mps2[sensor.saturated]).max(axis=1).min() >= 155.0
    assert {finding.code for finding in recording.findings} == {"saturated"}
    assert _table(data_dir, "foot-mocap").row("stride_saturated").reached


def test_a_staircase_is_read_at_its_own_rate(data_dir: Path) -> None:
    recording = read_feet(data_dir / "foot-mocap" / "stair_up.csv")
    assert set(recording.sensors) == {Placement.LEFT_FOOT, Placement.RIGHT_FOOT}
    assert recording.rate_hz == pytest.approx(204.8)


def test_the_heel_marker_runs_with_the_sensors(data_dir: Path) -> None:
    """Heel still while the foot's sensor is: the two clocks begin together, within a frame."""
    folder = data_dir / "foot-mocap"
    sensor = read_feet(folder / "imu_sample.csv").sensors[Placement.LEFT_FOOT]
    heel = read_heel(folder / "mocap_left.csv", Side.LEFT)
    speed = np.linalg.norm(np.gradient(heel.point_m, axis=0), axis=1) * 100.0
    time_s = np.arange(sensor.n_samples) / sensor.rate_hz
    turning = np.linalg.norm(sensor.gyr_radps, axis=1)

    def agreement(lag_s: float) -> float:
        return float(np.corrcoef(speed, np.interp(heel.time_s + lag_s, time_s, turning))[0, 1])

    assert max(np.arange(-0.5, 0.51, 0.05), key=agreement) == pytest.approx(0.0, abs=0.11)
    assert agreement(0.0) > 0.5


def test_the_clock_of_the_loop_repeats_and_loses_samples(data_dir: Path) -> None:
    (sensor,) = read_loop(data_dir / "foot-loop" / "short_walk.csv").sensors.values()
    assert sensor.rate_hz == pytest.approx(398.3, abs=0.1)
    assert 0 < sensor.n_lost < 0.02 * sensor.n_samples
