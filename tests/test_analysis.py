"""The analysis as a whole: what it refuses, what does not change its answer, and real walks."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gaitlab.analysis import Settings, analyze
from gaitlab.errors import InputError
from gaitlab.motion.orientation import OrientationSource
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement, Recording, Side
from gaitlab.result import Result
from gaitlab.series import from_bytes, to_bytes, to_csv
from gaitlab.validation.leg_vicon_check import read_optical
from gaitlab.validation.optical import check_strides
from gaitlab.validation.ten_metres_events import check_events
from gaitlab.validation.ten_metres_paths import way_of
from gaitlab.validation.ten_metres_trials import find_trials, read_trial
from tests.walks import analysed, cut, out_and_back, turned, without

LEG = {
    Placement.LEFT_FOOT: "00B40C55",
    Placement.RIGHT_FOOT: "00B40C48",
    Placement.LEFT_KNEE: "00B40BA5",
    Placement.RIGHT_KNEE: "00B40C35",
}


def _leg(data_dir: Path) -> Recording:
    folder = data_dir / "mtw-leg-vicon"
    return read_recording(placements={p: folder / f"S02-Trial-Walk-1-000_{d}.txt" for p, d in LEG.items()})


def _refusal(recording: Recording, settings: Settings | None = None) -> InputError:
    with pytest.raises(InputError) as caught:
        analyze(recording, settings)
    assert caught.value.message
    assert caught.value.hint
    return caught.value


def test_an_unknown_method_and_an_impossible_course_are_refused() -> None:
    recording = out_and_back().recording
    assert _refusal(recording, Settings(method="nobody2020")).code == "unknown_method"
    assert _refusal(recording, Settings(course_m=0.1)).code == "course_length"


def test_knees_without_a_foot_are_refused() -> None:
    recording = without(out_and_back().recording, Placement.LEFT_FOOT, Placement.RIGHT_FOOT)
    assert _refusal(recording).code == "no_foot"


@pytest.mark.parametrize("n", [1, 19, 99])
def test_less_than_a_second_is_refused_with_the_file(n: int) -> None:
    recording = out_and_back().recording
    short = Recording({p: cut(s, 0, n) for p, s in recording.sensors.items() if p is Placement.LEFT_FOOT})
    error = _refusal(short)
    assert error.code == "too_short"
    assert error.file


def test_a_sensor_with_neither_gyroscope_nor_orientation_is_refused() -> None:
    sensor = out_and_back().recording.sensors[Placement.LEFT_FOOT]
    bare = replace(sensor, gyr_radps=None, attitude=None)
    assert _refusal(Recording({Placement.LEFT_FOOT: bare})).code == "no_orientation"


def test_foot_and_knee_that_are_swapped_are_refused(data_dir: Path) -> None:
    sensors = _leg(data_dir).sensors
    swapped = {
        Placement.LEFT_FOOT: replace(sensors[Placement.LEFT_KNEE], placement=Placement.LEFT_FOOT),
        Placement.LEFT_KNEE: replace(sensors[Placement.LEFT_FOOT], placement=Placement.LEFT_KNEE),
        Placement.RIGHT_FOOT: sensors[Placement.RIGHT_FOOT],
    }
    error = _refusal(Recording(swapped))
    assert error.code == "placement_swapped"
    assert "left" in error.message


def test_swapped_simulated_legs_are_refused_too() -> None:
    sensors = out_and_back().recording.sensors
    swapped = {
        Placement.RIGHT_FOOT: replace(sensors[Placement.RIGHT_KNEE], placement=Placement.RIGHT_FOOT),
        Placement.RIGHT_KNEE: replace(sensors[Placement.RIGHT_FOOT], placement=Placement.RIGHT_KNEE),
    }
    assert _refusal(Recording(swapped)).code == "placement_swapped"


def test_feet_of_two_different_trials_are_told(data_dir: Path) -> None:
    folder = data_dir / "mtw-10m-walk"
    feet = {Placement.LEFT_FOOT: folder / "1-4_lf.txt", Placement.RIGHT_FOOT: folder / "1-5_rf.txt"}
    result = analyze(read_recording(placements=feet), Settings(course_m=7.62)).result
    assert "not_one_walk" in [warning.code for warning in result.warnings]
    assert not [p.name for p in result.parameters if p.status == "ok" and p.side == "both" and p.n]


def test_two_sensors_of_one_leg_are_refused(data_dir: Path) -> None:
    folder = data_dir / "mtw-leg-vicon"
    feet = {
        Placement.LEFT_FOOT: folder / "S02-Trial-Walk-1-000_00B40C55.txt",
        Placement.RIGHT_FOOT: folder / "S02-Trial-Walk-1-000_00B40C44.txt",
    }
    assert _refusal(read_recording(placements=feet)).code == "same_leg"


def test_the_same_recording_gives_the_same_bytes() -> None:
    recording = out_and_back().recording
    first, second = analyze(recording), analyze(recording)
    assert first.result.to_json() == second.result.to_json()
    assert to_bytes(first.series) == to_bytes(second.series)


def test_turning_every_sensor_on_its_foot_changes_no_length() -> None:
    recording = without(out_and_back().recording, Placement.LEFT_KNEE, Placement.RIGHT_KNEE)
    matrix = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
    other = Recording({p: turned(s, matrix) for p, s in recording.sensors.items()})
    plain, moved = analyze(recording), analyze(other)
    for side in Side:
        np.testing.assert_allclose(plain.gait.feet[side].length_m, moved.gait.feet[side].length_m, atol=0.005)


def test_a_result_survives_json_and_series_survive_packing() -> None:
    result = analysed().result
    assert Result.model_validate_json(result.to_json()) == result
    document = json.loads(result.to_json())
    assert document["schema"] == "gaitlab.result/1"
    unpacked = from_bytes(to_bytes(analysed().series))
    for placement, series in analysed().series.items():
        np.testing.assert_allclose(unpacked[placement].position_m, series.position_m, atol=1e-5)
        np.testing.assert_array_equal(unpacked[placement].rest, series.rest)


def test_series_have_the_fixed_columns_on_the_regular_clock() -> None:
    lines = to_csv(analysed().series[Placement.LEFT_KNEE]).splitlines()
    header = "t_s,lost,rest,ax_mps2,ay_mps2,az_mps2,vx_mps,vy_mps,vz_mps,px_m,py_m,pz_m"
    assert lines[0] == header
    times = np.array([float(line.split(",")[0]) for line in lines[1:]])
    np.testing.assert_allclose(np.diff(times), 0.01, atol=1e-6)


def test_the_world_has_x_along_the_first_straight_part_and_its_origin_between_the_feet() -> None:
    series = analysed().series
    feet = [series[Placement.LEFT_FOOT], series[Placement.RIGHT_FOOT]]
    start = 0.5 * (feet[0].position_m[0] + feet[1].position_m[0])
    np.testing.assert_allclose(start, 0.0, atol=0.01)
    assert feet[0].position_m[0, 1] > feet[1].position_m[0, 1]
    first = analysed().result.walk.straights[0]
    for foot in feet:
        row = int(np.searchsorted(foot.t_s, first.end_s))
        assert abs(foot.position_m[row, 1]) < 0.3 < 8.0 < foot.position_m[row, 0]


def test_a_real_walk_is_the_same_with_the_devices_orientation_within_5_percent(data_dir: Path) -> None:
    recording = _leg(data_dir)
    ours = analyze(recording, Settings(orientation=OrientationSource.VQF)).result
    device = analyze(recording, Settings(orientation=OrientationSource.DEVICE)).result
    for side in ("left", "right"):
        assert ours.feet[side].distance_m == pytest.approx(device.feet[side].distance_m, rel=0.05)


def test_the_paper_to_the_letter_runs_on_a_real_walk_and_finds_fewer_rests(data_dir: Path) -> None:
    recording = _leg(data_dir)
    paper = analyze(recording, Settings(method="ikizoglu2018")).result
    ours = analyze(recording).result
    assert paper.provenance.method == "ikizoglu2018"
    assert len(ours.feet["left"].rests) == 8
    assert len(ours.feet["right"].rests) == 7
    assert ours.provenance.settings_sha256 != paper.provenance.settings_sha256


def test_the_paper_to_the_letter_says_where_it_misses_rests_and_what_the_knee_was_corrected_by(
    data_dir: Path,
) -> None:
    folder = data_dir / "mtw-10m-walk"
    feet = {Placement.LEFT_FOOT: folder / "1-4_lf.txt", Placement.RIGHT_FOOT: folder / "1-4_rf.txt"}
    result = analyze(read_recording(placements=feet), Settings(method="ikizoglu2018")).result
    assert "few_rests" in [warning.code for warning in result.warnings]
    assert all(
        p.status != "ok" for p in result.parameters if p.name in ("traversed_distance", "stride_length")
    )
    residual = analyze(_leg(data_dir), Settings(method="ikizoglu2018")).result.parameter(
        "knee_residual", "right"
    )
    assert residual is not None
    assert residual.value is not None
    assert residual.value > 0.01


def test_the_devices_orientation_is_refused_where_there_is_none(data_dir: Path) -> None:
    recording = read_recording(placements={Placement.LEFT_FOOT: data_dir / "mtw-10m-walk" / "1-4_lf.txt"})
    assert _refusal(recording, Settings(orientation=OrientationSource.DEVICE)).code == "no_device_orientation"


def test_hand_checked_stance_and_swing_agree_within_2_percent_of_the_stride(data_dir: Path) -> None:
    """Mean over the trials of swing minus hand-checked swing, in seconds: no bias beyond a sample."""
    differences: list[float] = []
    for files in find_trials(data_dir / "mtw-10m-walk"):
        if files.name[-1] not in "15":
            continue
        recording, labels = read_trial(files)
        off, contact = check_events(analyze(recording).gait.feet[Side.LEFT], labels, Side.LEFT)
        swing = contact.error_s - off.error_s
        differences += swing[np.isfinite(swing)].tolist()
    assert len(differences) > 200
    assert abs(np.mean(differences)) < 0.01


def test_real_strides_agree_with_the_optical_foot_within_5_cm(data_dir: Path) -> None:
    recording = _leg(data_dir)
    optical = read_optical(data_dir / "mtw-leg-vicon" / "vicon-left-leg.csv", recording, Side.LEFT)
    errors = check_strides(analyze(recording).gait.feet[Side.LEFT], optical["MIDFOOT"]).error_m
    assert len(errors) >= 5
    assert np.abs(errors).max() < 0.05
    assert np.abs(np.mean(errors)) < 0.02


def test_every_trial_of_ten_metres_and_back_is_a_walk_with_a_turn(data_dir: Path) -> None:
    """46 trials, up to a quarter of the samples lost; each way is about 10 m."""
    ways = []
    for files in find_trials(data_dir / "mtw-10m-walk"):
        recording, labels = read_trial(files)
        analysis = analyze(recording, Settings(course_m=7.62))
        ways += [way_of(foot, labels, side) for side, foot in analysis.gait.feet.items()]
        assert analysis.result.walk.turns, files.name
        assert "not_one_walk" not in [warning.code for warning in analysis.result.warnings], files.name
        assert analysis.result.parameter("walk_time") is not None
    assert len(ways) == 92
    assert np.median([way.out_and_back_m for way in ways if way]) == pytest.approx(20.0, abs=1.0)


def test_a_knee_of_the_other_leg_is_told_and_its_numbers_want_attention(data_dir: Path) -> None:
    sensors = _leg(data_dir).sensors
    other = replace(sensors[Placement.RIGHT_KNEE], placement=Placement.LEFT_KNEE)
    feet = {placement: sensors[placement] for placement in (Placement.LEFT_FOOT, Placement.RIGHT_FOOT)}
    result = analyze(Recording({**feet, Placement.LEFT_KNEE: other})).result
    assert ("knee_of_other_leg", "left_knee") in [(one.code, one.placement) for one in result.warnings]
    assert result.knees["left"].place == "unknown"
    sway = result.parameter("knee_sway", "left")
    assert sway is not None
    assert sway.status in ("attention", "not_determinable")
    right = analyze(_leg(data_dir)).result
    assert [right.knees[side].place for side in ("left", "right")] == ["shank", "shank"]


def test_what_was_told_of_the_course_is_said_and_no_longer_a_check() -> None:
    recording = without(out_and_back().recording, Placement.LEFT_KNEE, Placement.RIGHT_KNEE)
    result = analyze(recording, Settings(closed=True, way_m=10.0)).result
    told = next(one.message for one in result.warnings if one.code == "course_used")
    assert "ended where it began" in told
    assert "10 m" in told
    closing = result.parameter("closing_distance", "left")
    assert closing is not None
    assert closing.status == "attention"
    assert result.provenance.settings["closed"] is True
    assert _refusal(recording, Settings(way_m=0.1)).code == "known_way"


def test_every_foot_says_what_its_heading_rests_on(data_dir: Path) -> None:
    sensors = analyze(_leg(data_dir)).result.sensors
    for foot in ("left_foot", "right_foot"):
        assert sensors[foot].heading is not None
        assert "magnetometer was left out" in str(sensors[foot].heading)
    assert sensors["left_knee"].heading is None
