"""The headings of two feet: what drifts apart between them is taken out, and nothing else."""

from __future__ import annotations

import numpy as np

from gaitlab.motion.course import Course, find_course
from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.motion.together import directions, with_one_heading
from gaitlab.recording.model import Placement, Side
from tests.walks import out_and_back


def feet_of(drift_radps: float = 0.0) -> dict[Side, FootMotion]:
    """Both feet of a walk there and back; the right one's heading drifts."""
    walk = out_and_back(None).recording
    feet = {}
    for side in Side:
        at = Placement.foot(side)
        feet[side] = track_foot(walk.sensors[at], walk.time_s(at))
    right = feet[Side.RIGHT]
    feet[Side.RIGHT] = right.redirected(drift_radps * (right.time_s - right.time_s[0]))
    return feet


def apart_deg(feet: dict[Side, FootMotion], course: Course) -> float:
    """By how much the feet's directions differ more on the second straight part than on the first."""
    left, right = (directions(feet[side], course) for side in Side)
    change = [one[1].angle_rad - one[0].angle_rad for one in (left, right)]
    return float(np.degrees(np.angle(np.exp(1j * (change[1] - change[0])))))


def test_a_drift_between_the_headings_is_taken_out_by_halves() -> None:
    feet = feet_of(0.003)
    course = find_course(feet)
    assert abs(apart_deg(feet, course)) > 1.5
    mended = with_one_heading(feet, course)
    assert abs(apart_deg(mended, course)) < 0.6
    for side in Side:
        moved = mended[side].position_m - feet[side].position_m
        assert 0.05 < np.abs(moved).max() < 0.6
        assert np.abs(moved[:300]).max() < 1e-6


def test_feet_that_agree_stay_as_they_are() -> None:
    feet = feet_of()
    mended = with_one_heading(feet, find_course(feet))
    for side in Side:
        assert np.abs(mended[side].position_m - feet[side].position_m).max() < 0.05


def test_one_straight_part_or_one_foot_tells_nothing() -> None:
    feet = feet_of(0.003)
    course = find_course(feet)
    first = Course(course.bouts, (), course.straights[:1])
    assert with_one_heading(feet, first)[Side.RIGHT] is feet[Side.RIGHT]
    alone = {Side.RIGHT: feet[Side.RIGHT]}
    assert with_one_heading(alone, course)[Side.RIGHT] is feet[Side.RIGHT]


def test_redirecting_by_a_constant_is_turning_about_the_start() -> None:
    foot = feet_of()[Side.LEFT]
    one, other = foot.redirected(np.full(foot.n_samples, 0.4)), foot.turned(0.4)
    shift = other.position_m[0] - one.position_m[0]
    np.testing.assert_allclose(one.position_m + shift, other.position_m, atol=1e-9)
    np.testing.assert_allclose(one.velocity_mps, other.velocity_mps, atol=1e-12)
    np.testing.assert_allclose(one.attitude, other.attitude, atol=1e-12)
