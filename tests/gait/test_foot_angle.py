"""How feet point: the angle is said to be unknown with what it would be, its scatter is given."""

from __future__ import annotations

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.gait.foot_angle import foot_angles, toe_out_deg
from gaitlab.recording.model import Placement, Recording, Side
from tests.walks import analysed, out_and_back, turned, without


def test_the_angle_is_not_given_and_says_what_it_would_be() -> None:
    for side in Side:
        angle = analysed().result.parameter("foot_progression_angle", side.value)
        assert angle is not None
        assert angle.status == "not_determinable"
        assert "°" in angle.reason
        assert angle.n > 10


def test_the_scatter_of_a_walk_without_variability_is_small() -> None:
    for side in Side:
        scatter = analysed().result.parameter("foot_progression_sd", side.value)
        assert scatter is not None
        assert scatter.value is not None
        assert 0.0 <= scatter.value < 2.0


def test_turning_the_sensor_on_the_foot_changes_no_angle() -> None:
    recording = without(out_and_back().recording, Placement.LEFT_KNEE, Placement.RIGHT_KNEE)
    matrix = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
    other = analyze(Recording({p: turned(s, matrix) for p, s in recording.sensors.items()}))
    plain = analyze(recording)
    for side in Side:
        angles = [toe_out_deg(one.gait.feet[side], side) for one in (plain, other)]
        np.testing.assert_allclose(angles[0], angles[1], atol=0.3)


def test_a_foot_turned_outwards_points_outwards_by_as_much() -> None:
    gait = analysed().gait
    for side, sign in ((Side.LEFT, 1.0), (Side.RIGHT, -1.0)):
        foot = gait.feet[side]
        before = toe_out_deg(foot, side)
        # the foot turns to the left in the sensor's world, the path stays
        motion = foot.motion.turned(np.radians(5.0))
        kept = type(motion)(**(vars(motion) | {"position_m": foot.motion.position_m}))
        after = toe_out_deg(type(foot)(**(vars(foot) | {"motion": kept})), side)
        np.testing.assert_allclose(after - before, 5.0 * sign, atol=1e-6)


def test_a_missing_foot_says_so() -> None:
    feet = {Side.LEFT: analysed().gait.feet[Side.LEFT]}
    reasons = {one.reason for one in foot_angles(feet) if one.side.value == "right"}
    assert reasons == {"The right foot was not recorded."}
