"""Positions: the three of Jiménez et al. 2009, the reset of İkizoğlu et al. 2018, and closing errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gaitlab.methods import ikizoglu2018_foot as ikizoglu
from gaitlab.methods import jimenez2009_position as jimenez
from gaitlab.methods.catalogue import method, of
from gaitlab.methods.closing import closing_of
from gaitlab.methods.jimenez2009_position import WeinbergParams
from gaitlab.methods.jimenez2009_steps import Stances
from gaitlab.methods.model import Method, Question, Track
from gaitlab.recording.model import Side
from tests.methods.feet import built, real_feet, walk, walked

WORKING = [one for one in of(Question.POSITION) if one.name != "ikizoglu2018"]


def test_closing_error_by_hand() -> None:
    track = Track(np.arange(4.0), np.array([[0, 0, 0], [3, 0, 1], [3, 4, 2], [0.6, 0.8, 3.0]], dtype=float))
    closing = closing_of(track)
    assert closing.error_m == pytest.approx(1.0)
    assert closing.path_m == pytest.approx(3 + 4 + np.hypot(2.4, 3.2))
    assert closing.percent == pytest.approx(100 / 11)


def test_a_track_of_one_place_has_no_closing_error() -> None:
    assert np.isnan(closing_of(Track(np.zeros(1), np.zeros((1, 3)))).percent)
    assert np.isnan(closing_of(Track(np.arange(2.0), np.zeros((2, 3)))).percent)


def test_a_constant_offset_of_the_acceleration_is_removed_by_zupt() -> None:
    """Its velocity grows linearly, and so does what is removed."""
    foot = built(free_mps2=np.tile([0.05, -0.02, 0.1], (400, 1)))
    moved = jimenez.increments(foot, Stances(np.array([50, 150, 350]), 15))
    np.testing.assert_allclose(moved, 0.0, atol=1e-12)


def test_increments_by_hand_and_with_the_stance_counted_twice() -> None:
    """w = 0: velocities 0 2 4 3 1 at rows 0 to 4, stances at rows 0 and 4; drift 0 ¼ ½ ¾ 1 is removed."""
    foot = built(n=5, rate_hz=10.0)
    raw = np.zeros((5, 3))
    raw[:, 0] = [0.0, 2.0, 4.0, 3.0, 1.0]
    foot = replace(foot, motion=replace(foot.motion, raw_velocity_mps=raw))
    at = Stances(np.array([0, 4]), 0)
    assert jimenez.increments(foot, at)[0, 0] == pytest.approx((1.75 + 3.5 + 2.25) / 10.0)
    assert jimenez.zupt_lengths(foot, at)[0] == pytest.approx(0.75)
    moving = Stances(np.array([1, 4]), 1)  # means 2 and 2: 0 is left at row 1, 2, 1, −1 after it
    np.testing.assert_allclose(jimenez.drift_free_velocity(foot, moving)[:, 0], [-2.0, 0.0, 2.0, 1.0, -1.0])
    both = Stances(np.array([0, 2, 4]), 1)  # means 1, 3, 2 around rows 0, 2, 4
    np.testing.assert_allclose(jimenez.drift_free_velocity(foot, both)[:, 0], [-1.0, 0.0, 1.0, 0.5, -1.0])
    np.testing.assert_allclose(jimenez.increments(foot, both)[:, 0], [0.1, -0.05])
    np.testing.assert_allclose(jimenez.increments(foot, both, letter=True)[:, 0], [0.0, 0.05])


def test_weinberg_by_hand() -> None:
    """A slow swing of the acceleration between 8 and 12 m/s² passes the low pass: 0.364 · 4^¼ = 0.515 m."""
    acc = np.zeros((2000, 3))
    acc[:, 2] = 10.0 + 2.0 * np.sin(2 * np.pi * 0.25 * np.arange(2000) / 100.0)
    at = Stances(np.array([0, 1000]), 250)
    paper = WeinbergParams(calibration=1.0)
    assert jimenez.weinberg_lengths(built(acc), at, paper)[0] == pytest.approx(0.364 * 4**0.25, rel=1e-3)
    assert jimenez.weinberg_lengths(built(acc), at)[0] == pytest.approx(1.9 * 0.364 * 4**0.25, rel=1e-3)
    acc[:, 2] = 10.0 + 2.0 * np.sin(2 * np.pi * 20.0 * np.arange(2000) / 100.0)
    assert jimenez.weinberg_lengths(built(acc), at, paper)[0] < 0.1  # 20 Hz does not


def test_strides_along_headings_by_hand() -> None:
    place = jimenez.along_headings(np.array([1.0, 2.0, 1.0]), np.array([0.0, np.pi / 2, np.pi]))
    np.testing.assert_allclose(place, [[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0]], atol=1e-12)


def test_the_heading_of_the_axis_goes_all_the_way_round() -> None:
    """The arctangent of a ratio, as printed, would show 200° as 20°."""
    foot = built(n=10)
    angle = np.deg2rad([0.0, 100.0, 200.0, 300.0])
    attitude = foot.motion.attitude.copy()
    attitude[:4, 0], attitude[:4, 3] = np.cos(angle / 2), np.sin(angle / 2)
    foot = replace(foot, motion=replace(foot.motion, attitude=attitude))
    found = jimenez.axis_headings(foot, Stances(np.arange(4), 0))
    np.testing.assert_allclose(np.mod(found, 2 * np.pi), angle)


@pytest.mark.parametrize("one", WORKING, ids=lambda m: m.name)
def test_a_simulated_walk_of_ten_metres_and_back_closes(one: Method) -> None:
    track = one.run(walked())
    np.testing.assert_array_equal(track.place_m[0], 0.0)
    assert np.all(np.diff(track.time_s) > 0.0)
    assert track.place_m.shape == (len(track.time_s), 3)
    assert closing_of(track).percent < (12.0 if "_sl_" in one.name else 4.0)


@pytest.mark.parametrize("one", WORKING, ids=lambda m: m.name)
def test_its_path_is_as_long_as_the_true_one(one: Method) -> None:
    """But for Weinberg's, whose factor is another person's."""
    truth = walk(None).truth.feet[Side.LEFT].distance_m
    within = 0.3 if one.name.endswith("weinberg") else 0.04
    assert closing_of(one.run(walked(None))).path_m == pytest.approx(truth, rel=within)


@pytest.mark.parametrize("one", WORKING, ids=lambda m: m.name)
def test_the_world_turns_the_track_and_nothing_else(one: Method) -> None:
    foot = walked()
    plain, turned = one.run(foot), one.run(replace(foot, motion=foot.motion.turned(0.5)))
    c, s = np.cos(0.5), np.sin(0.5)
    wanted = plain.place_m @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(turned.place_m, wanted, atol=1e-6)


def test_the_letter_of_equation_7_turns_the_track_by_the_sensors_mounting() -> None:
    foot = walked(None)
    for run in (jimenez.sl_zupt, jimenez.sl_weinberg):
        plain, letter = run(foot), run(foot, letter=True)
        assert closing_of(letter).path_m == pytest.approx(closing_of(plain).path_m)
        assert closing_of(letter).error_m == pytest.approx(closing_of(plain).error_m, abs=0.5)


def test_the_reset_of_ikizoglu_leaves_what_drifted_since_the_rest() -> None:
    """An offset b over T seconds from rest to rest leaves bT²/2 (§3.2)."""
    free = np.zeros((300, 3))
    free[:, 0] = 0.5
    free[50:60] = free[160:170] = 0.0
    foot = built(free_mps2=free)
    track = ikizoglu.position(foot)
    assert track.time_s.tolist() == [0.55, 1.65]
    np.testing.assert_allclose(track.place_m[-1], [0.5 * 0.5 * 1.0**2, 0.0, 0.0], rtol=0.02)


def test_with_rests_that_are_found_its_reset_closes_a_real_walk(data_dir: Path) -> None:
    feet = [foot for foot, _, _ in real_feet(data_dir)]
    ours = [closing_of(ikizoglu.reset_position(foot, foot.motion.rests)).percent for foot in feet]
    own = [closing_of(ikizoglu.position(foot)).percent for foot in feet]
    assert np.median(ours) < 3.0
    assert np.nanmedian(own) > 2.0 * np.median(ours)


@pytest.mark.parametrize(
    ("name", "median", "most"),
    [
        ("gaitlab", 3.0, 6.0),
        ("feliz2009", 3.5, 8.0),
        ("jimenez2009_zupt", 4.0, 10.0),
        ("jimenez2009_sl_zupt", 8.0, 14.0),
        ("jimenez2009_sl_weinberg", 13.0, 25.0),
    ],
)
def test_closing_errors_of_real_walks(name: str, median: float, most: float, data_dir: Path) -> None:
    """In % of the method's own path, 10 m and back; the papers name 5 % of 100 m and more."""
    run = method(name, Question.POSITION).run
    closings = [closing_of(run(foot)) for foot, _, _ in real_feet(data_dir)]
    percent = np.array([closing.percent for closing in closings])
    assert np.median(percent) < median
    assert np.quantile(percent, 0.95) < most
    assert np.median([closing.path_m for closing in closings]) == pytest.approx(20.3, abs=1.5)
