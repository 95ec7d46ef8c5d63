"""What is walked is what was planned."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.recording import Side
from gaitlab.simulation import Gait, Plan, SensorErrors, Stand, Turn, Walk, presets, simulate
from gaitlab.simulation.footfalls import Course, lay_course


def contacts(course: Course) -> list[tuple[float, Side]]:
    both = [(t, side) for side, falls in course.footfalls.items() for t in falls.initial_contact_s[1:]]
    return sorted(both)


@pytest.mark.parametrize("gait", [presets.COMFORTABLE, presets.LIMPING, presets.SHUFFLING, presets.ATAXIC])
def test_feet_alternate_and_one_always_stands(gait: Gait) -> None:
    course = lay_course(presets.ten_metre_and_back(gait))
    assert all(a[1] is not b[1] for a, b in pairwise(contacts(course)))
    for side in Side:
        falls, other = course.footfalls[side], course.footfalls[side.other]
        for off, on in zip(falls.foot_off_s[:-1], falls.initial_contact_s[1:], strict=True):
            stands = (other.initial_contact_s <= off) & (other.foot_off_s >= on)
            assert stands.any()


def test_events_of_each_foot_come_in_order() -> None:
    course = lay_course(presets.stop_and_go(presets.ATAXIC))
    for falls in course.footfalls.values():
        order = np.column_stack(
            [falls.initial_contact_s, falls.flat_s, falls.heel_off_s, falls.foot_off_s]
        ).ravel()
        assert np.all(np.diff(order) >= 0.0)
        assert order[0] == 0.0
        assert order[-1] == pytest.approx(course.duration_s)


@pytest.mark.parametrize("length_m", [0.5, 3.0, 7.62, 10.0])
def test_both_feet_walk_the_length_of_the_course_and_end_side_by_side(length_m: float) -> None:
    course = lay_course(Plan((Stand(), Walk(length_m), Stand())))
    for side, y in ((Side.LEFT, 0.05), (Side.RIGHT, -0.05)):
        falls = course.footfalls[side]
        np.testing.assert_allclose(falls.position_m[0], [0.0, y], atol=1e-12)
        np.testing.assert_allclose(falls.position_m[-1], [length_m, y], atol=1e-9)


def test_first_and_last_stride_are_half_as_long_as_the_others() -> None:
    truth = simulate(Plan((Stand(), Walk(n_strides=4), Stand())), knees=False).truth
    right, left = truth.feet[Side.RIGHT].stride_length_m, truth.feet[Side.LEFT].stride_length_m
    np.testing.assert_allclose(right, [0.65, 1.3, 1.3, 1.3, 0.65], atol=1e-9)
    np.testing.assert_allclose(left, [1.3, 1.3, 1.3, 1.3], atol=1e-9)
    assert right.sum() == pytest.approx(left.sum())


def test_steps_have_the_length_width_and_time_of_the_gait() -> None:
    gait = Gait(
        stride_length_m=1.2, stride_time_s=1.1, step_width_m=0.13, length_asymmetry=0.1, time_asymmetry=0.05
    )
    steps = simulate(Plan((Stand(), Walk(n_strides=6), Stand()), gait), knees=False).truth.steps
    left = np.array([side is Side.LEFT for side in steps.side])
    np.testing.assert_allclose(steps.length_m[left], 0.66, atol=1e-9)
    np.testing.assert_allclose(steps.length_m[~left], 0.54, atol=1e-9)
    np.testing.assert_allclose(steps.time_s[left], 0.5775, atol=1e-9)
    np.testing.assert_allclose(steps.time_s[~left], 0.5225, atol=1e-9)
    np.testing.assert_allclose(steps.width_m, 0.13, atol=1e-9)


def test_step_width_and_length_do_not_depend_on_the_direction_of_walking() -> None:
    legs = (Stand(), Walk(n_strides=3), Turn(1.1), Walk(n_strides=3), Stand())
    steps = simulate(Plan(legs), knees=False).truth.steps
    np.testing.assert_allclose(steps.width_m, 0.10, atol=1e-9)
    np.testing.assert_allclose(steps.length_m, 0.65, atol=1e-9)
    assert len(steps.side) == 10


@pytest.mark.parametrize(("angle", "n"), [(math.pi, None), (-math.pi / 2, 2), (math.pi / 3, 1)])
def test_turns_add_up_to_their_angle(angle: float, n: int | None) -> None:
    truth = simulate(Plan((Stand(), Walk(3.0), Turn(angle, n), Walk(3.0), Stand())), knees=False).truth
    for foot in truth.feet.values():
        assert foot.heading_rad[-1] - foot.heading_rad[0] == pytest.approx(angle)
        assert foot.turning.sum() >= 1
        np.testing.assert_array_equal(np.abs(np.diff(foot.heading_rad)) > 1e-9, foot.turning)
    assert [span.leg.angle_rad for span in truth.turns if isinstance(span.leg, Turn)] == [angle]


def test_once_around_a_square_ends_where_it_began() -> None:
    for to in Side:
        truth = simulate(presets.square(to=to), knees=False).truth
        for foot in truth.feet.values():
            np.testing.assert_allclose(foot.footfall_m[-1], foot.footfall_m[0], atol=1e-9)
            np.testing.assert_allclose(foot.position_m[-1], foot.position_m[0], atol=1e-9)


def test_parts_of_the_course_follow_one_another_without_a_gap() -> None:
    course = lay_course(presets.stop_and_go())
    assert course.spans[0].start_s == 0.0
    assert all(a.end_s == b.start_s for a, b in pairwise(course.spans))
    for span in course.spans:
        if isinstance(span.leg, Stand):
            assert span.end_s - span.start_s >= span.leg.duration_s


def test_standing_lasts_as_long_as_planned() -> None:
    course = lay_course(Plan((Stand(2.0), Walk(2.0), Stand(1.5), Walk(2.0), Stand(4.0))))
    for falls in course.footfalls.values():
        stand = falls.stand_end_s - falls.stand_start_s
        np.testing.assert_allclose(stand[np.isfinite(stand)], [2.0, 1.5, 4.0], atol=1e-9)


def test_variability_is_that_of_the_gait_and_keeps_the_length_of_the_course() -> None:
    gait = Gait(variability=0.03)
    truth = simulate(Plan((Stand(), Walk(200.0), Stand()), gait, seed=2), knees=False).truth
    lengths, times = truth.steps.length_m, truth.steps.time_s
    assert np.std(lengths) / np.mean(lengths) == pytest.approx(0.03, rel=0.15)
    assert np.std(times) / np.mean(times) == pytest.approx(0.03, rel=0.15)
    assert truth.feet[Side.LEFT].distance_m == pytest.approx(200.0)


def test_crossing_is_when_the_leading_foot_reaches_the_end_of_the_course() -> None:
    truth = simulate(presets.timed_25_foot_walk(), knees=False).truth
    crossing = truth.crossing_s(7.62)
    assert crossing is not None
    ahead = [truth.body.feet[side].pose(np.array([crossing])).x.value[0] for side in Side]
    assert max(ahead) == pytest.approx(7.62, abs=1e-6)
    assert truth.crossing_s(20.0) is None
    first = truth.first_movement_s
    assert first == pytest.approx(4.0)
    assert 1.0 < 7.62 / (crossing - first) < 1.3


def test_same_plan_gives_the_same_walk_and_another_seed_another() -> None:
    plan = presets.timed_25_foot_walk(presets.ATAXIC)
    first, again = (lay_course(plan).footfalls[Side.LEFT].position_m for _ in range(2))
    other = lay_course(Plan(plan.legs, plan.gait, seed=1)).footfalls[Side.LEFT].position_m
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Plan((Walk(3.0), Stand())),
        lambda: Plan(()),
        lambda: Walk(),
        lambda: Walk(3.0, n_strides=2),
        lambda: Walk(-1.0),
        lambda: Stand(0.0),
        lambda: Gait(stance_share=0.4),
        lambda: Gait(heel_off_share=0.6),
        lambda: Gait(stride_length_m=0.0),
        lambda: Gait(stance_share=0.52, landing_share=0.05, heel_off_share=0.1, time_asymmetry=1.2),
        lambda: lay_course(Plan((Stand(), Walk(50.0), Stand()), Gait(variability=0.5))),
        lambda: simulate(Plan(), rate_hz=1.0),
        lambda: SensorErrors(lost_share=1.0),
        lambda: SensorErrors(lost_burst=0.5),
    ],
)
def test_what_cannot_be_walked_is_refused_in_words(make: object) -> None:
    assert callable(make)
    with pytest.raises(InputError) as refused:
        make()
    assert refused.value.message.endswith(".")


def test_with_gait_changes_the_gait_and_keeps_the_course() -> None:
    plan = presets.timed_25_foot_walk()
    wide = plan.with_gait(step_width_m=0.2)
    assert wide.legs == plan.legs
    np.testing.assert_allclose(simulate(wide, knees=False).truth.steps.width_m, 0.2, atol=1e-9)


def test_the_example_walk_crosses_25_feet_with_four_sensors() -> None:
    example = presets.example_walk()
    assert len(example.recording.sensors) == 4
    crossing = example.truth.crossing_s(presets.T25FW_M)
    assert crossing is not None
    assert 3.0 < crossing - example.truth.first_movement_s < 8.0
    assert all(sensor.n_lost > 0 for sensor in example.recording.sensors.values())
