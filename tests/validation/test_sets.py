"""Each set out of simulated walks: with perfect sensors and exact truth the errors are small, and what is broken is said."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Side
from gaitlab.validation import validate, validate_all
from gaitlab.validation.foot_loop import read_loop, regular_clock
from gaitlab.validation.foot_mocap_files import heels_of
from gaitlab.validation.ten_metres_trials import find_trials
from tests.validation import folders


def test_simulated_trials_of_ten_metres_agree_with_their_true_events(tmp_path: Path) -> None:
    table = validate("10m-walk", folders.ten_metres(tmp_path, "1-1", "1-2"))
    assert table.recordings == 2
    assert not table.problems
    assert table.row("initial_contact").value("recall") > 90.0
    assert table.row("initial_contact").value("precision") > 90.0
    assert table.row("rests").value("missed") == 0.0
    assert table.row("closing_foot").n == 4
    assert table.row("stride_time").value("MAE") < 20.0
    (details,) = table.details
    assert len(details.rows) == 4


def _true_places(side: Side) -> np.ndarray:
    """Where the sensor of a foot is in each of its rests."""
    truth = folders.walk().truth
    rows = np.round(100.0 * truth.feet[side].rests_s.mean(axis=1)).astype(int)
    return truth.feet[side].position_m[rows, :2]


def _out_and_back(places: np.ndarray) -> float:
    way = np.linalg.norm(places - places[0], axis=1)
    return float(way.max() + np.linalg.norm(places[-1] - places[way.argmax()]))


def test_path_and_closing_are_the_true_ones(tmp_path: Path) -> None:
    """The simulated person turns on a half circle and stops where the feet happen to be."""
    table = validate("10m-walk", folders.ten_metres(tmp_path, "1-1"))
    left, right = (_true_places(side) for side in Side)
    difference = _out_and_back(left) - _out_and_back(right)
    assert table.row("path_left_minus_right").value("mean") == pytest.approx(difference, abs=0.05)
    closing = [np.linalg.norm(places[-1] - places[0]) for places in (left, right)]
    assert table.row("closing_foot").value("median") == pytest.approx(np.median(closing), abs=0.1)


def test_a_broken_trial_is_listed_with_its_reason_and_the_others_count(tmp_path: Path) -> None:
    folder = folders.ten_metres(tmp_path, "1-1", "1-2", "1-3", "1-4", "1-5")
    (folder / "1-2_lf.txt").write_text("nothing of use\n")
    (folder / "1-3.json").write_text("{")
    (folder / "1-4_rf.txt").unlink()
    (folder / "1-5.json").unlink()
    table = validate("10m-walk", folder)
    reasons = {problem.recording: problem.reason for problem in table.problems}
    assert set(reasons) == {"1-2", "1-3", "1-4", "1-5"}
    assert "JSON" in reasons["1-3"]
    assert "right foot is missing" in reasons["1-4"]
    assert "no file of events" in reasons["1-5"]
    assert table.recordings == 5
    assert table.row("path_left_minus_right").n == 1
    assert table.row("closing_foot").n == 3


@pytest.mark.parametrize(
    "change", [{"TrialBoundaries": [1]}, {"LeftFootEvents": [[1, 2], [3]]}, {"RightFootEvents": None}]
)
def test_labels_that_are_none_are_a_problem_of_their_trial(tmp_path: Path, change: dict[str, object]) -> None:
    folder = folders.ten_metres(tmp_path, "1-1")
    truth = json.loads((folder / "1-1.json").read_text()) | change
    (folder / "1-1.json").write_text(json.dumps(truth))
    table = validate("10m-walk", folder)
    assert [problem.recording for problem in table.problems] == ["1-1"]
    assert next(iter(change)) in table.problems[0].reason
    assert table.row("initial_contact").n == 0
    assert table.row("closing_foot").reached is False


def test_trials_are_found_by_pattern_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    for name in ("10-2_lf.txt", "2-1_rf.txt", "2-1.json", "10-1_lf.txt", "notes.txt", ".1-9_lf.txt"):
        (tmp_path / name).write_text("")
    assert [trial.name for trial in find_trials(tmp_path)] == ["2-1", "10-1", "10-2"]


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("devices", [True, False])
def test_a_simulated_leg_agrees_with_its_cameras_on_either_side(
    tmp_path: Path, side: Side, devices: bool
) -> None:
    table = validate("leg-vicon", folders.leg(tmp_path, side, devices=devices))
    row = table.row("stride_length")
    assert row.n >= 12
    assert row.value("MAE") < 1.5
    assert table.row("stride_length_covered").n == row.n
    assert table.row("knee_shank_gaitlab").value("3D RMS") < 6.0
    assert {stride[1] for stride in table.details[0].rows} == {side.value}
    assert [p.reason for p in table.problems if "thigh" in p.reason] == [
        f"There is no sensor on the {side} thigh."
    ]
    assert any("orientation" in p.recording for p in table.problems)


def test_legs_in_folders_of_their_own_are_one_table(tmp_path: Path) -> None:
    folders.leg(tmp_path / "a", Side.LEFT)
    folders.leg(tmp_path / "b", Side.RIGHT)
    table = validate("leg-vicon", tmp_path)
    assert table.recordings == 2
    assert {(stride[0], stride[1]) for stride in table.details[0].rows} == {("a", "left"), ("b", "right")}


def test_a_placement_file_that_names_what_is_not_there_is_a_problem_and_no_crash(tmp_path: Path) -> None:
    folder = folders.leg(tmp_path, devices=False)
    (folder / "placement.json").write_text('{"left_foot": "gone.txt"}')
    table = validate("leg-vicon", folder)
    assert "not there" in table.problems[0].reason
    assert table.row("stride_length").n == 0


def test_simulated_shoes_agree_with_the_heel_marker(tmp_path: Path) -> None:
    folder = folders.shoes(tmp_path)
    (folder / "stride_events_left.csv").write_text("s_id,start,end\n0,1000,1400\n1,1400,99999\n")
    table = validate("foot-mocap", folder)
    row = table.row("stride_length_heel")
    assert row.n >= 15
    assert row.value("MAE") < 1.5
    assert row.reached
    assert table.row("stride_saturated").value("saturated") == 0
    assert table.row("stride_length_published").n == 1


def test_optical_files_go_to_the_walk_of_their_name_and_else_to_the_one_as_long(tmp_path: Path) -> None:
    names = ["mocap_b_left.csv", "mocap_right.csv"]
    for name, frames in zip(names, (900, 510), strict=True):
        (tmp_path / name).write_text("sample\n" + "0\n" * frames)
    a, b = tmp_path / "imu_a.csv", tmp_path / "imu_b.csv"
    heels = heels_of([tmp_path / name for name in names], {a: 5.0, b: 30.0})
    assert heels[a] == [(Side.RIGHT, tmp_path / "mocap_right.csv")]
    assert heels[b] == [(Side.LEFT, tmp_path / "mocap_b_left.csv")]


def test_a_walk_without_cameras_and_a_broken_staircase_are_listed(tmp_path: Path) -> None:
    folders.shoes(tmp_path)
    folders.shoes(tmp_path, "imu_x.csv", "mocap_x_right.csv")
    (tmp_path / "stair_up.csv").write_text("a,b\n1,2\n")
    table = validate("foot-mocap", tmp_path)
    reasons = {problem.recording: problem.reason for problem in table.problems}
    assert set(reasons) == {"imu_x: mocap_x_right.csv", "stair_up"}
    assert "R_FCC" in reasons["imu_x: mocap_x_right.csv"]
    assert table.row("stride_length_heel").n >= 15


def test_a_loop_is_laid_on_its_clock_and_measured(tmp_path: Path) -> None:
    folder = folders.loop(tmp_path)
    (sensor,) = read_loop(folder / "loop.csv").sensors.values()
    true = next(iter(folders.walk().recording.sensors.values()))
    assert sensor.rate_hz == pytest.approx(100.0, rel=1e-6)
    assert sensor.n_samples == true.n_samples
    assert sensor.n_lost == len(range(500, true.n_samples, 97))
    table = validate("foot-loop", folder)
    distance = folders.walk().truth.feet[Side.LEFT].distance_m
    assert table.row("loop_loop").value("path") == pytest.approx(distance, rel=0.03)


def test_times_of_reception_become_packets() -> None:
    file = InputFile("loop.csv", b"")
    time = np.array([0.0, 0.0025, 0.0025, 0.0050, 0.0126, 0.0150]) + np.array([0, 1, 1, -2, 3, 0]) * 1e-5
    packet, rate = regular_clock(np.concatenate([time, 0.015 + np.arange(1, 200) * 0.0025]), file)
    assert packet[:6].tolist() == [0, 1, 1, 2, 5, 6]
    assert rate == pytest.approx(400.0, rel=1e-3)
    with pytest.raises(InputError, match="run forward"):
        regular_clock(np.array([0.0, 1.0, 0.5]), file)
    with pytest.raises(InputError, match="regular clock"):
        regular_clock(np.cumsum(np.random.default_rng(0).exponential(0.01, 500)), file)


@pytest.mark.parametrize("name", ["10m-walk", "leg-vicon", "foot-mocap", "foot-loop"])
def test_a_wrong_folder_is_refused_with_what_was_looked_for_and_found(tmp_path: Path, name: str) -> None:
    (tmp_path / "holiday.jpg").write_bytes(b"")
    with pytest.raises(InputError) as caught:
        validate(name, tmp_path)
    assert "Looked for" in caught.value.message
    assert "holiday.jpg" in caught.value.message
    with pytest.raises(InputError, match="cannot be read"):
        validate(name, tmp_path / "gone")


def test_all_sets_of_a_folder_are_found_by_what_they_hold(tmp_path: Path) -> None:
    folders.loop(tmp_path / "something")
    folders.ten_metres(tmp_path / "else", "7-1")
    assert [table.name for table in validate_all(tmp_path)] == ["10m-walk", "foot-loop"]
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(InputError, match="No folder in it holds a known set"):
        validate_all(empty)


def test_labels_of_a_foot_that_was_not_recorded_and_of_a_turn_may_be_missing(tmp_path: Path) -> None:
    folder = folders.ten_metres(tmp_path, "1-1")
    truth = json.loads((folder / "1-1.json").read_text())
    n = len(truth.pop("LeftFootEvents"))
    del truth["UTurnBoundaries"]
    (folder / "1-1.json").write_text(json.dumps(truth))
    assert "LeftFootEvents" in validate("10m-walk", folder).problems[0].reason
    (folder / "1-1_lf.txt").unlink()
    table = validate("10m-walk", folder)
    assert table.row("initial_contact").n == len(truth["RightFootEvents"])
    assert abs(n - len(truth["RightFootEvents"])) <= 1
    assert table.row("initial_contact_turn").n == 0
