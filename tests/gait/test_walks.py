"""Parameters of simulated walks against the truth, and what is said where it cannot be known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.recording.model import Placement, Recording, Side
from gaitlab.result import Parameter
from gaitlab.simulation import TYPICAL_MTW, Plan, SensorErrors, Stand, Turn, Walk, simulate
from tests.walks import STRAIGHT, analysed, cut, out_and_back, without


def _parameter(analysis: Analysis, name: str, side: str = "both") -> Parameter:
    found = analysis.result.parameter(name, side)
    assert found is not None
    return found


def _value(analysis: Analysis, name: str, side: str = "both") -> float:
    value = _parameter(analysis, name, side).value
    assert value is not None
    return value


@pytest.mark.parametrize("errors", [None, TYPICAL_MTW], ids=["perfect", "typical"])
def test_stride_lengths_are_right_within_2_cm(errors: SensorErrors | None) -> None:
    for side in Side:
        truth = out_and_back(errors).truth.feet[side]
        foot = analysed(errors).gait.feet[side]
        np.testing.assert_allclose(foot.length_m, truth.stride_length_m, atol=0.02)


def test_the_interval_of_a_stride_length_covers_the_truth() -> None:
    inside = []
    for lost in (0.0, 0.1):
        errors = replace(TYPICAL_MTW, lost_share=lost)
        for side in Side:
            truth = out_and_back(errors).truth.feet[side]
            foot = analysed(errors).gait.feet[side]
            inside += list(np.abs(foot.length_m - truth.stride_length_m) < 1.96 * foot.length_sd_m)
    assert np.mean(inside) >= 0.9


def test_lost_samples_widen_the_interval() -> None:
    clean = analysed(TYPICAL_MTW).gait.feet[Side.LEFT]
    lossy = analysed(replace(TYPICAL_MTW, lost_share=0.15)).gait.feet[Side.LEFT]
    hurt = (lossy.motion.doubtful_share > 0.0) & ~lossy.turning
    assert hurt.sum() > 5
    assert lossy.length_sd_m[hurt].mean() > 1.02 * clean.length_sd_m[hurt].mean()


def test_distance_cadence_and_stride_time_are_those_of_the_plan() -> None:
    truth = out_and_back().truth
    for side in Side:
        foot = truth.feet[side]
        assert _value(analysed(), "traversed_distance", side.value) == pytest.approx(
            foot.distance_m, rel=0.02
        )
        assert _value(analysed(), "stride_time", side.value) == pytest.approx(1.08, abs=0.01)
    assert _value(analysed(), "cadence") == pytest.approx(60 / 0.54, abs=1.0)


def test_events_follow_the_truth_at_a_constant_distance() -> None:
    """The simulated foot's shape around its events is not a real one's; the real ones are checked against hand labels."""
    for side in Side:
        events, truth = analysed().gait.feet[side].events, out_and_back().truth.feet[side]
        assert np.ptp(events.foot_off_s - truth.foot_off_s) <= 0.03
        assert np.ptp(events.initial_contact_s - truth.initial_contact_s) <= 0.03
        assert np.abs(events.initial_contact_s - truth.initial_contact_s).max() <= 0.08


def test_the_mean_step_is_half_a_stride_and_each_side_says_what_it_assumes() -> None:
    stride, step = _value(analysed(), "stride_length"), _value(analysed(), "step_length")
    assert step == pytest.approx(stride / 2, abs=0.01)
    left = _parameter(analysed(), "step_length", "left")
    assert left.status == "attention"
    assert "side by side" in left.reason


def test_step_width_says_its_assumption_or_that_it_cannot_be_known() -> None:
    width = _parameter(analysed(), "step_width")
    assert width.status in ("attention", "not_determinable")
    assert "17 ± 5 cm" in width.reason


def test_the_turn_is_found_with_its_angle_and_sign() -> None:
    for angle in (np.pi, -np.pi, np.pi / 2):
        plan = Plan((Stand(3.0), Walk(6.0), Turn(angle), Walk(6.0), Stand(2.0)))
        walk = simulate(plan, TYPICAL_MTW, knees=False, sampling="mean")
        turns = analyze(walk.recording).result.walk.turns
        assert len(turns) == 1
        assert turns[0].angle_deg == pytest.approx(np.degrees(angle), abs=5.0)


def test_a_straight_walk_has_no_turn_and_its_line_is_straight() -> None:
    analysis = analyze(simulate(STRAIGHT, TYPICAL_MTW, knees=False, sampling="mean").recording)
    assert analysis.result.walk.turns == ()
    assert len(analysis.result.walk.straights) == 1
    assert _value(analysis, "path_deviation") < 0.03


def test_the_time_over_the_course_is_the_truth_with_its_start_rule() -> None:
    truth = out_and_back().truth
    began = min(float(foot.foot_off_s[0]) for foot in truth.feet.values())
    expected = truth.crossing_s(7.62) - began
    measured = _parameter(analysed(), "walk_time")
    assert measured.value == pytest.approx(expected, abs=0.15)
    timed = analysed().result.walk.timed
    assert timed is not None
    assert timed.rule == "first foot off after standing"


def test_a_walk_shorter_than_the_course_cannot_be_timed_and_says_how_far_it_came() -> None:
    analysis = analyze(out_and_back().recording, Settings(course_m=25.0))
    assert _parameter(analysis, "walk_time").status == "not_determinable"
    assert "the course is 25 m" in _parameter(analysis, "walk_time").reason


def test_a_stop_on_the_way_is_timed() -> None:
    plan = Plan((Stand(3.0), Walk(5.0), Stand(3.0), Walk(5.0), Stand(2.0)))
    walk = simulate(plan, TYPICAL_MTW, knees=False, sampling="mean")
    stop = _value(analyze(walk.recording), "stop_duration")
    assert stop == pytest.approx(3.0, abs=0.4)
    assert _value(analysed(), "stop_duration") == 0.0


def test_one_foot_alone_gives_its_own_parameters_and_says_what_it_cannot() -> None:
    recording = without(out_and_back().recording, Placement.RIGHT_FOOT, Placement.RIGHT_KNEE)
    analysis = analyze(recording, Settings(course_m=7.62))
    assert _parameter(analysis, "stride_length", "left").status == "ok"
    for name in ("step_length", "step_width", "cadence", "double_support_share", "stop_duration"):
        parameter = _parameter(analysis, name)
        assert parameter.status == "not_determinable"
        assert "right foot was not recorded" in parameter.reason
    assert _value(analysis, "steady_speed") > 1.0
    assert "one_foot" in [warning.code for warning in analysis.result.warnings]


def test_a_recording_without_walking_has_no_stride_and_says_so() -> None:
    recording = out_and_back().recording
    standing = Recording({p: cut(s, 0, 350) for p, s in recording.sensors.items() if p.is_foot})
    result = analyze(standing, Settings(course_m=7.62)).result
    assert all(foot.strides == () for foot in result.feet.values())
    assert "no_walking" in [warning.code for warning in result.warnings]
    lengths = [p for p in result.parameters if p.name == "stride_length"]
    assert all(p.status == "not_determinable" for p in lengths)


def test_a_recording_that_begins_in_mid_walk_is_analysed_and_marked() -> None:
    recording = out_and_back().recording
    walking = Recording({p: cut(s, 700, 1500) for p, s in recording.sensors.items() if p.is_foot})
    analysis = analyze(walking, Settings(course_m=7.62))
    assert "no_standing" in [warning.code for warning in analysis.result.warnings]
    assert _parameter(analysis, "stride_length").status == "attention"
    assert _value(analysis, "stride_length") == pytest.approx(1.333, abs=0.08)
    assert _parameter(analysis, "walk_time").status == "not_determinable"


def test_the_knee_goes_as_far_as_its_foot_and_hardly_sways() -> None:
    for side in Side:
        knee = analysed().gait.knees[side].motion
        truth = out_and_back().truth
        rows = np.searchsorted(truth.t_s, knee.time_s[500:1200] - 1e-6)
        path, true_path = knee.position_m[500:1200], truth.knees[side].position_m[rows]
        difference = (path - path[0]) - (true_path - true_path[0])
        assert np.sqrt(np.mean(difference[:, :2] ** 2)) < 0.06
        assert _value(analysed(), "knee_sway", side.value) < 0.01


def test_a_left_knee_alone_leaves_the_right_one_not_determinable() -> None:
    analysis = analyze(without(out_and_back().recording, Placement.RIGHT_KNEE))
    assert _parameter(analysis, "knee_sway", "right").status == "not_determinable"
    assert _parameter(analysis, "knee_sway", "left").value is not None


def _analysed(plan: Plan, course_m: float | None = None, **options: object) -> Analysis:
    walk = simulate(plan, TYPICAL_MTW, knees=False, sampling="mean", **options)  # type: ignore[arg-type]
    return analyze(walk.recording, Settings(course_m=course_m))


def test_a_stop_changes_neither_stride_time_nor_stride_length_nor_speed() -> None:
    plan = Plan((Stand(3.0), Walk(6.0), Stand(2.5), Walk(6.0), Stand(2.0)))
    analysis = _analysed(plan)
    assert _value(analysis, "stride_time") == pytest.approx(1.08, abs=0.02)
    assert _value(analysis, "stride_length") == pytest.approx(6.0 / 4.5, abs=0.03)
    assert len(analysis.result.walk.straights) == 2


def test_a_step_to_the_line_before_the_walk_is_not_in_its_time() -> None:
    plain = _value(_analysed(Plan((Stand(4.0), Walk(10.0), Stand(2.0))), 7.62), "walk_time")
    stepped = _value(
        _analysed(Plan((Stand(4.0), Walk(0.6), Stand(5.0), Walk(10.0), Stand(2.0))), 7.62), "walk_time"
    )
    assert stepped == pytest.approx(plain, abs=0.3)


def test_a_turn_on_the_spot_before_the_walk_does_not_hide_it() -> None:
    plan = Plan((Stand(4.0), Turn(np.pi), Stand(3.0), Walk(10.0), Stand(2.0)))
    assert _value(_analysed(plan, 7.62), "walk_time") == pytest.approx(6.2, abs=0.4)


def test_one_foot_alone_does_not_tell_who_started() -> None:
    recording = without(out_and_back().recording, Placement.RIGHT_FOOT, Placement.RIGHT_KNEE)
    time = _parameter(analyze(recording, Settings(course_m=7.62)), "walk_time")
    assert time.status == "attention"
    assert time.sd is not None
    assert time.sd > 0.2


def test_a_foot_that_makes_no_stride_is_said_and_stops_nothing() -> None:
    sensors = out_and_back().recording.sensors
    still = cut(sensors[Placement.RIGHT_FOOT], 0, 300)
    recording = Recording({Placement.LEFT_FOOT: sensors[Placement.LEFT_FOOT], Placement.RIGHT_FOOT: still})
    result = analyze(recording, Settings(course_m=7.62)).result
    assert "foot_without_stride" in [warning.code for warning in result.warnings]
    assert "right" not in result.walk.closing_error_m
    step = result.parameter("step_length", "both")
    assert step is not None
    assert step.status == "not_determinable"


def test_a_foot_that_is_recorded_late_is_not_joined_to_the_other() -> None:
    sensors = out_and_back().recording.sensors
    right = sensors[Placement.RIGHT_FOOT]
    late = cut(right, 900, right.n_samples)
    analysis = analyze(
        Recording({Placement.LEFT_FOOT: sensors[Placement.LEFT_FOOT], Placement.RIGHT_FOOT: late})
    )
    for name in ("step_length", "step_width", "path_deviation"):
        assert _parameter(analysis, name).status == "not_determinable"
    assert "partly_recorded" in [warning.code for warning in analysis.result.warnings]


def test_three_seconds_that_were_lost_leave_nothing_ok_that_rests_on_them() -> None:
    sensors = out_and_back().recording.sensors
    left = sensors[Placement.LEFT_FOOT]
    received = left.received.copy()
    received[700:1000] = False
    lossy = replace(left, received=received)
    recording = Recording({Placement.LEFT_FOOT: lossy, Placement.RIGHT_FOOT: sensors[Placement.RIGHT_FOOT]})
    distance = _parameter(analyze(recording), "traversed_distance", "left")
    assert distance.status == "not_determinable"
    assert "lost" in distance.reason


def test_a_knees_troubles_mark_no_parameter_of_the_feet() -> None:
    sensors = dict(out_and_back().recording.sensors)
    sensors[Placement.LEFT_KNEE] = cut(sensors[Placement.LEFT_KNEE], 700, 1500)
    analysis = analyze(Recording(sensors), Settings(course_m=7.62))
    assert _parameter(analysis, "stride_length", "left").status == "ok"


def test_standing_is_in_no_stride() -> None:
    for foot in analysed().result.feet.values():
        assert max(stride.duration_s for stride in foot.strides) < 2.0


def test_stance_and_double_support_are_those_of_the_plan_within_their_intervals() -> None:
    for name, truth in (("stance_share", 62.0), ("double_support_share", 24.0)):
        parameter = _parameter(analysed(), name)
        assert parameter.ci95 is not None
        assert parameter.ci95[0] - 1.0 <= truth <= parameter.ci95[1] + 1.0
