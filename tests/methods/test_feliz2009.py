"""Stance and correction of Feliz et al. 2009: by hand, in closed form, on simulated and real walks."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gaitlab.methods import feliz2009_stance as feliz
from gaitlab.methods.closing import closing_of
from gaitlab.methods.heading import foot_heading
from gaitlab.methods.still import rests_where
from gaitlab.motion.integration import position_of
from gaitlab.recording.model import Bools, Floats, Side
from gaitlab.simulation import TYPICAL_MTW
from gaitlab.validation.ten_metres_events import check_stances
from tests.methods.feet import built, real_feet, remounted, walk, walked


def swinging(*still: slice) -> Bools:
    """Rows in which the foot is taken to be still, of ten."""
    rows = np.zeros(10, dtype=np.bool_)
    for part in still:
        rows[part] = True
    return rows


def test_short_flips_are_removed_on_both_sides() -> None:
    gyr = np.zeros((400, 3))
    gyr[100:200, 2] = 2.0
    gyr[140:146] = 0.0  # a wrong stop
    gyr[300:306, 2] = 2.0  # a wrong movement
    rests = feliz.rests(built(gyr_radps=gyr))
    assert rests.start.tolist() == [0, 200]
    assert rests.end.tolist() == [100, 400]


def test_the_threshold_itself_is_still() -> None:
    """Eq. 2: s = 0 for ω ≤ τ."""
    assert len(feliz.rests(built(gyr_radps=np.tile([0.6, 0.0, 0.8], (50, 1))))) == 1
    assert len(feliz.rests(built(gyr_radps=np.tile([0.6, 0.0, 0.81], (50, 1))))) == 0


def test_a_foot_that_turns_about_is_not_still_however_slowly_it_turns() -> None:
    gyr = np.zeros((200, 3))
    gyr[:, 1] = 0.9 * (-1.0) ** np.arange(200)  # 180 rad/s²
    assert not len(feliz.rests(built(gyr_radps=gyr)))
    about_vertical = gyr[:, [0, 2, 1]]  # the paper looks at pitch and roll alone
    assert len(feliz.rests(built(gyr_radps=about_vertical))) == 1


def velocity() -> Floats:
    """Two stances, rows 0 and 1, and 4 to 6; the velocity of the second has drifted to 3 m/s."""
    raw = np.zeros((10, 3))
    raw[:, 0] = [0.0, 0.0, 1.0, 2.0, 3.0, 3.3, 3.0, 3.5, 4.0, 4.5]
    return raw


def test_the_correction_by_hand() -> None:
    """µ = (3 + 3.3 + 3) / 3 = 3.1; the swing from row 1 to row 4 loses µ/3 a row; the next step counts from row 6."""
    corrected = feliz.correct(velocity(), rests_where(swinging(slice(0, 2), slice(4, 7))))[:, 0]
    wanted = [0.0, 0.0, 1.0 - 3.1 / 3, 2.0 - 6.2 / 3, -0.1, 0.2, 0.0, 0.5, 1.0, 1.5]
    np.testing.assert_allclose(corrected, wanted, atol=1e-12)


def test_equation_4_as_printed_sums_one_sample_more_than_it_divides_by() -> None:
    """µ = 9.3 / 2 = 4.65 instead of 3.1."""
    corrected = feliz.correct(velocity(), rests_where(swinging(slice(0, 2), slice(4, 7))), letter=True)[:, 0]
    np.testing.assert_allclose(corrected[4:6], [3.0 - 4.65, 3.3 - 4.65])


def test_a_stance_of_one_sample_is_at_rest_by_either_reading() -> None:
    for letter in (False, True):
        corrected = feliz.correct(velocity(), rests_where(swinging(slice(0, 2), slice(4, 5))), letter=letter)
        assert corrected[4, 0] == 0.0


def test_what_a_constant_offset_leaves_in_closed_form() -> None:
    """An offset b over a swing T and a stance S: µ = b·(T + S/2), and a ramp to it takes bT²/2 − µT/2 = −bST/4 too much."""
    rate, swing, stance, offset = 1000.0, 0.6, 0.4, 0.05
    rows = np.arange(2001)
    still = (rows < 401) | ((rows >= 1001) & (rows < 1401))
    raw = np.zeros((len(rows), 3))
    raw[:, 1] = offset * rows / rate
    place = position_of(feliz.correct(raw, rests_where(still)), rate)[:, 1]
    moved = place[1000] - place[400]
    np.testing.assert_allclose(moved, -offset * stance * swing / 4, rtol=0.01)


def test_no_stance_no_correction() -> None:
    np.testing.assert_array_equal(feliz.correct(velocity(), rests_where(swinging())), velocity())


def test_a_perfect_walk_is_followed() -> None:
    truth = walk(None).truth.feet[Side.LEFT]
    foot = walked(None)
    track = feliz.position(foot)
    assert len(track.time_s) == len(truth.rests_s)
    lengths = np.linalg.norm(np.diff(track.place_m, axis=0)[:, :2], axis=1)
    np.testing.assert_allclose(lengths, truth.stride_length_m, atol=0.05)
    climbed = np.diff(feliz.height(foot)[foot.motion.rests.moment])
    assert np.abs(climbed).max() < 0.05  # below 1 rad/s the foot still rolls
    letter = feliz.position(foot, letter=True)
    assert np.abs(letter.place_m - track.place_m).max() > 1e-4


def test_another_heading_bends_the_path_as_much() -> None:
    """A heading that grows by 1 rad over the walk turns its last stride by 1 rad more than its first."""
    foot = walked(None)
    ours = foot_heading(foot.motion)
    plain, same = feliz.position(foot), feliz.position(foot, heading_rad=ours)
    np.testing.assert_allclose(same.place_m, plain.place_m, atol=1e-9)
    bent = feliz.position(foot, heading_rad=ours + foot.time_s / foot.time_s[-1])
    first, last = (np.diff(track.place_m, axis=0)[[1, -2], :2] @ [1.0, 1j] for track in (plain, bent))
    middle = 0.5 * (plain.time_s[1:] + plain.time_s[:-1])[[1, -2]] / foot.time_s[-1]
    np.testing.assert_allclose(np.angle(last / first), middle, atol=0.03)


def test_the_mounting_does_not_matter() -> None:
    turn = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])
    plain, other = feliz.position(walked()), feliz.position(remounted(TYPICAL_MTW, turn))
    np.testing.assert_allclose(other.time_s, plain.time_s, atol=0.011)
    np.testing.assert_allclose(closing_of(other).path_m, closing_of(plain).path_m, rtol=0.01)


def test_the_stances_of_real_walks_are_found(data_dir: Path) -> None:
    checks = [
        check_stances(foot.time_s[feliz.rests(foot).moment], swings)
        for foot, swings, _ in real_feet(data_dir)
    ]
    stances = sum(check.stances for check in checks)
    assert sum(check.missed for check in checks) <= 0.02 * stances
    assert sum(check.doubled for check in checks) <= 0.01 * stances


def test_without_the_filter_real_stances_fall_apart(data_dir: Path) -> None:
    unfiltered = [
        check_stances(foot.time_s[rests_where(np.linalg.norm(foot.gyr_radps, axis=1) <= 1.0).moment], swings)
        for foot, swings, _ in real_feet(data_dir)
    ]
    assert sum(check.doubled for check in unfiltered) > 0.3 * sum(check.stances for check in unfiltered)
