"""Thigh navigation: how the sensor sits, strides by the swing, corrections by the comfort zone, and real thighs."""

from __future__ import annotations

import csv
import os
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gaitlab.methods.leg_model import LegAngles, hip_angles
from gaitlab.methods.posture_bousdar2017 import ZONE, judge
from gaitlab.methods.thigh_bousdar2017 import METHODS, correction_turn, filtered, track, track_corrected
from gaitlab.methods.thigh_gaitlab import track as track_ours
from gaitlab.methods.thigh_model import (
    SwingFactors,
    ThighView,
    calibrated,
    fit_factors,
    foot_lengths,
    leg_angles,
    mounting,
    swings_of,
    thigh_view,
)
from gaitlab.motion.model import Rests
from gaitlab.recording.model import Placement, Side
from tests import walks
from tests.methods.thighs import STRIDES, swinging_thigh

MOUNTS = (Rotation.identity(), Rotation.from_rotvec([0.5, -1.0, 2.0]), Rotation.from_rotvec([3.0, 0.3, 0.0]))
FOLDER = (
    Path(os.environ.get("GAITLAB_DATA", Path(__file__).resolve().parents[3] / "shared" / "data"))
    / "mtw-leg-vicon"
)
ALL = (track, track_corrected, track_ours)


@pytest.mark.parametrize("mount", MOUNTS)
def test_how_the_sensor_sits_is_found(mount: Rotation) -> None:
    thigh = swinging_thigh(mount=mount)
    found = mounting(thigh.view)
    assert found is not None
    assert np.degrees((mount * Rotation.from_quat(found, scalar_first=True)).magnitude()) < 0.5


@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 200.0])
@pytest.mark.parametrize("mount", MOUNTS)
def test_a_stride_for_each_swing_and_its_length_by_the_swing(mount: Rotation, rate_hz: float) -> None:
    thigh = swinging_thigh(rate_hz=rate_hz, mount=mount, heading_deg=70.0)
    found = track(thigh.view)
    assert len(found.stride_row) == STRIDES
    assert np.abs(found.stride_row - thigh.forward).max() <= 0.03 * rate_hz
    expected = np.full(STRIDES, 40.0)
    expected[0] = 20.0  # out of standing
    np.testing.assert_allclose(np.degrees(found.swing_rad), expected, atol=0.7)
    np.testing.assert_allclose(found.length_m, 1.8 * found.swing_rad, atol=1e-12)
    np.testing.assert_allclose(found.place_m[-1], [found.length_m.sum(), 0.0, 0.0], atol=0.15)


def test_a_turn_of_the_walk_turns_the_way() -> None:
    thigh = swinging_thigh(turn_deg=90.0)
    found = track(thigh.view)
    way = np.diff(found.place_m, axis=0)
    direction = np.degrees(np.arctan2(way[:, 1], way[:, 0]))
    np.testing.assert_allclose(direction[[0, 1, 2, -2, -1]], [0.0, 0.0, 0.0, 90.0, 90.0], atol=3.0)


def test_equation_5_is_the_pitch_s_turn_and_then_the_roll_s() -> None:
    roll, pitch = 0.1, -0.2
    about_y = [[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]]
    about_x = [[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]]
    found = Rotation.from_quat(correction_turn(roll, pitch), scalar_first=True).as_matrix()
    np.testing.assert_allclose(found, np.array(about_y) @ np.array(about_x), atol=1e-12)


def test_a_thigh_that_leans_out_of_the_zone_is_led_back_to_its_limit_until_gravity_speaks_against_it() -> (
    None
):
    """It is taken to roll by 8°, so that the first stance gets −4.5°; but this is how it sits, and gravity knows."""
    thigh = swinging_thigh()
    mount = Rotation.from_euler("x", np.radians(8.0)).as_quat(scalar_first=True)
    free, none_given = filtered(thigh.view, mount, None)
    held, given = filtered(thigh.view, mount, ZONE)
    assert not np.any(none_given)
    assert np.degrees(given[0]) == pytest.approx([-4.5, 0.0], abs=0.05)
    assert np.all(given[:, 0] <= 1e-6)
    roll = np.degrees([hip_angles(attitude)[1] for attitude in (free, held)])
    end = thigh.view.stances[1][0]
    np.testing.assert_allclose(roll[0], 8.0, atol=0.5)
    np.testing.assert_allclose(roll[1, :end], 8.0, atol=0.05)
    assert 3.4 < roll[1, end] < roll[1, end + 20] < 6.0
    assert roll[1, end:].max() > 7.0


def test_a_correction_changes_the_heading_too() -> None:
    """Equation 6 turns about the thigh's own axes: with the thigh pitched, a roll is partly a turn about the vertical."""
    thigh = swinging_thigh()
    mount = Rotation.from_euler("x", np.radians(8.0)).as_quat(scalar_first=True)
    headings = [hip_angles(filtered(thigh.view, mount, zone)[0])[0] for zone in (None, ZONE)]
    assert np.degrees(np.abs(headings[0] - headings[1]).max()) > 0.5


def test_a_coherent_walk_is_left_as_it_is() -> None:
    view = swinging_thigh(swing_deg=30.0).view
    free, held = track(view), track_corrected(view)
    assert not np.any(held.correction_rad)
    np.testing.assert_allclose(free.place_m, held.place_m, atol=1e-12)
    assert np.all(judge(leg_angles(view, free.attitude)).coherent)


@pytest.mark.parametrize("run", ALL)
def test_turning_the_sensor_or_the_world_changes_no_stride(run) -> None:
    first = run(swinging_thigh(roll_deg=6.0).view)
    for other in (
        run(swinging_thigh(roll_deg=6.0, mount=MOUNTS[1]).view),
        run(swinging_thigh(roll_deg=6.0, heading_deg=100.0).view),
    ):
        np.testing.assert_array_equal(first.stride_row, other.stride_row)
        np.testing.assert_allclose(first.length_m, other.length_m, atol=2e-3)
        np.testing.assert_allclose(first.correction_rad, other.correction_rad, atol=2e-3)
        np.testing.assert_allclose(first.pitch_rad, other.pitch_rad, atol=2e-3)


@pytest.mark.parametrize("run", ALL)
def test_what_cannot_be_known_is_said(run) -> None:
    whole = swinging_thigh().view
    no_walk = replace(whole, foot=replace(whole.foot, rests=_first_rests(whole, 1)))
    still = replace(whole, gyr_radps=np.zeros_like(whole.gyr_radps))
    nothing = replace(whole, acc_mps2=np.zeros_like(whole.acc_mps2))
    unseen = replace(whole, foot=replace(whole.foot, rests=_first_rests(whole, 0)))
    for view in (no_walk, still, nothing, unseen, _rows(whole, 1), _rows(whole, 0)):
        found = run(view)
        assert found.reason
        assert len(found.stride_row) == len(found.length_m) == 0
        assert found.place_m.shape == (1, 3)


def _first_rests(view: ThighView, k: int) -> Rests:
    rests = view.foot.rests
    return Rests(rests.start[:k], rests.end[:k], rests.moment[:k], rests.residual_mps[:k])


def _rows(view: ThighView, n: int) -> ThighView:
    return replace(
        view,
        time_s=view.time_s[:n],
        acc_mps2=view.acc_mps2[:n],
        gyr_radps=view.gyr_radps[:n],
        standing=(0, n),
    )


def test_a_swing_is_found_in_no_rows_one_row_and_a_still_thigh() -> None:
    for pitch in (np.zeros(0), np.zeros(1), np.zeros(500), 0.02 * np.sin(np.arange(500) / 10.0)):
        assert len(swings_of(pitch, 100.0).forward) == 0


def test_factors_are_those_of_least_squares_through_0() -> None:
    swing, length = np.array([0.5, 1.0, np.nan]), np.array([1.0, 1.5, 1.0])
    assert fit_factors(swing, length).per_rad_m == pytest.approx((0.5 + 1.5) / 1.25)
    assert fit_factors(np.zeros(0), np.zeros(0)) == SwingFactors()
    assert fit_factors(np.array([0.5]), np.array([np.nan])) == SwingFactors()


def test_a_foot_s_stride_is_the_known_length_of_its_thigh_s() -> None:
    thigh = swinging_thigh(stride_m=1.3)
    found = track(thigh.view)
    np.testing.assert_allclose(foot_lengths(thigh.view, found.stride_row), 1.3, atol=1e-9)
    again = track(calibrated(thigh.view, found, STRIDES))
    assert again.length_m[1:] == pytest.approx(1.3, rel=0.1)
    rests = thigh.view.foot.rests.moment
    np.testing.assert_allclose(np.diff(found.places_at(rests)[:, 0]), found.length_m, atol=0.02)
    assert np.isnan(foot_lengths(thigh.view, np.array([0, 10**6]))).all()


def test_the_catalogue_says_what_each_method_rests_on() -> None:
    names = {method.name: {one.name for one in method.constants} for method in METHODS}
    assert names["bousdar2017_thigh_corrected"] - names["bousdar2017_thigh"] == {
        "roll_min_rad",
        "roll_max_rad",
        "pitch_min_rad",
        "pitch_max_rad",
    }
    assert all(method.deviations and method.needs for method in METHODS)


@cache
def real_thighs() -> dict[Side, ThighView]:
    from gaitlab.analysis import analyze
    from gaitlab.recording import read_recording

    files = {
        Placement.LEFT_FOOT: "00B40C55",
        Placement.RIGHT_FOOT: "00B40C48",
        Placement.LEFT_KNEE: "00B40C45",
        Placement.RIGHT_KNEE: "00B40C3C",
    }
    recording = read_recording(
        placements={p: next(FOLDER.glob(f"*_{name}.txt")) for p, name in files.items()}
    )
    gait = analyze(recording).gait
    views = {}
    for side in Side:
        sensor = recording.sensors[Placement.knee(side)]
        shift = recording.sensors[Placement.foot(side)].first_packet - sensor.first_packet
        time = recording.time_s(Placement.knee(side))
        views[side] = thigh_view(sensor, time, gait.feet[side].motion, shift, gait.knees[side].motion)
    return views


on_real_thighs = pytest.mark.skipif(
    not FOLDER.is_dir(), reason="the public recordings are not here (GAITLAB_DATA)"
)


@on_real_thighs
@pytest.mark.parametrize("side", Side)
def test_strides_of_a_real_thigh_by_a_leg_of_usual_length(side: Side) -> None:
    """Within 0.16 m on average, and the strides of our own path, tied to the foot, within 0.1 m."""
    view = real_thighs()[side]
    for run, allowed in ((track, 0.16), (track_corrected, 0.16), (track_ours, 0.1)):
        found = run(view)
        error = found.length_m - foot_lengths(view, found.stride_row)
        assert len(error) >= 5
        assert np.mean(np.abs(error)) < allowed


@on_real_thighs
def test_the_filter_tilts_a_real_thigh_as_vqf_does() -> None:
    for view in real_thighs().values():
        found, ours = track(view), track_ours(view)
        assert np.degrees(np.sqrt(np.mean((found.pitch_rad - ours.pitch_rad) ** 2))) < 1.5
        assert np.degrees(np.sqrt(np.mean((found.roll_rad - ours.roll_rad) ** 2))) < 1.5


@on_real_thighs
def test_the_stances_of_straight_walking_are_coherent_and_that_of_the_turn_is_not() -> None:
    """By the thigh that cameras saw: roll and pitch within the paper's limits but in the one stance that turns."""
    rows = list(csv.reader((FOLDER / "vicon-left-leg.csv").read_text().splitlines()))
    names, values = rows[0], np.array(rows[1:], float)
    first, last = (int(values[k, names.index("row")]) for k in (0, -1))
    thigh = values[:, [names.index(f"qLTH_{k}") for k in (1, 2, 3, 4)]]
    heading, roll, pitch = hip_angles(thigh)
    start, end = real_thighs()[Side.LEFT].stances
    seen = (start >= first) & (end <= last)
    angles = np.column_stack([roll, pitch, np.zeros((len(roll), 3))])
    found = judge(LegAngles(angles, heading, start[seen] - first, end[seen] - first))
    turning = np.ptp(
        np.unwrap(heading)[np.linspace(start[seen], end[seen] - 1, 9).astype(int) - first], axis=0
    )
    assert len(turning) == 6
    assert np.argmax(turning) == np.flatnonzero(~found.coherent)
    assert 0.03 < found.outside_m.max() < 0.08


@on_real_thighs
def test_the_corrections_help_a_bad_gyroscope() -> None:
    """Its offset walks by 0.04 rad/s/√s, three times on each thigh: tilt against VQF of the sensor as it was."""
    errors = []
    for seed in range(3):
        for view in real_thighs().values():
            walk = np.cumsum(np.random.default_rng(seed).normal(0.0, 0.004, view.gyr_radps.shape), axis=0)
            bad = replace(view, gyr_radps=view.gyr_radps + walk)
            truth = _up(track_ours(view).attitude)
            errors.append(
                [np.linalg.norm(_up(run(bad).attitude) - truth, axis=1) for run in (track, track_corrected)]
            )
    without, corrected = (
        np.degrees(np.sqrt(np.mean(np.concatenate(one) ** 2))) for one in zip(*errors, strict=True)
    )
    assert without > 8.0
    assert corrected < 0.85 * without


def _up(attitude: np.ndarray) -> np.ndarray:
    return Rotation.from_quat(attitude, scalar_first=True).inv().apply([0.0, 0.0, 1.0])


def _simulated(start: int = 0, end: int | None = None) -> ThighView:
    """The leg's sensor of a simulated walk (on its shank, which swings as a thigh does), from a row to a row."""
    analysis, side = walks.analysed(), Side.LEFT
    whole = analysis.recording.sensors[Placement.knee(side)]
    sensor = walks.cut(whole, start, end or whole.n_samples)
    time = np.arange(sensor.n_samples) / sensor.rate_hz
    shift = analysis.recording.sensors[Placement.foot(side)].first_packet - sensor.first_packet
    return thigh_view(sensor, time, analysis.gait.feet[side].motion, shift)


def test_a_simulated_walk_gives_a_stride_for_a_stride() -> None:
    view = _simulated()
    found = track(view)
    length = foot_lengths(view, found.stride_row)
    full = length > 1.0
    assert (
        abs(np.count_nonzero(full) - np.count_nonzero(np.diff(view.foot.rest_position_m[:, 0]) ** 2 > 1.0))
        <= 2
    )
    again = track(calibrated(view, found, len(length) // 2))
    assert np.mean(np.abs(again.length_m - length)[full]) < 0.1


def test_without_standing_the_mounting_is_not_determinable() -> None:
    view = _simulated(600, 1100)
    assert view.standing[0] == view.standing[1]
    assert "standing" in track(view).reason
