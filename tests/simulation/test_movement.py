"""The simulated body moves as a body can, and its derivatives are exact."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.recording import Placement, Side
from gaitlab.recording.model import Floats
from gaitlab.simulation import Gait, Plan, Stand, Turn, Walk, presets
from gaitlab.simulation.body import Body, build_body

GAITS = {
    "comfortable": presets.COMFORTABLE,
    "fast": presets.FAST,
    "slow": presets.SLOW,
    "shuffling": presets.SHUFFLING,
    "limping": presets.LIMPING,
    "ataxic": presets.ATAXIC,
}
every_gait = pytest.mark.parametrize("gait", GAITS)
every_place = pytest.mark.parametrize("placement", list(Placement))


@cache
def body_of(gait: str) -> Body:
    legs = (
        Stand(1.0),
        Walk(3.0),
        Turn(np.pi),
        Walk(2.0),
        Stand(0.7),
        Walk(1.5),
        Turn(-np.pi / 2),
        Stand(1.0),
    )
    return build_body(Plan(legs, GAITS[gait], seed=4))


def instants(body: Body, step_s: float = 0.003) -> Floats:
    return np.arange(-0.5, body.course.duration_s + 0.5, step_s)


def knots_s(body: Body) -> Floats:
    """Instants at which the quintic pieces of any track of a foot or its knee meet."""
    tracks = [
        track
        for part in (*body.feet.values(), *body.knees.values())
        for value in vars(part).values()
        for track in (value.values() if isinstance(value, dict) else [value])
        if hasattr(track, "polynomial")
    ]
    return np.concatenate([track.polynomial.x for track in tracks])


@every_gait
@every_place
def test_velocity_and_acceleration_are_the_derivatives_of_the_path(gait: str, placement: Placement) -> None:
    body = body_of(gait)
    h = 1e-5
    t = instants(body)
    t = t[np.min(np.abs(t[:, None] - knots_s(body)), axis=1) > 3 * h]
    before, now, after = (body.sensor(placement, t + shift) for shift in (-h, 0.0, h))
    velocity = (after.position_m - before.position_m) / (2 * h)
    acceleration = (after.velocity_mps - before.velocity_mps) / (2 * h)
    np.testing.assert_allclose(now.velocity_mps, velocity, atol=2e-5)
    np.testing.assert_allclose(now.acceleration_mps2, acceleration, atol=2e-3)


@every_gait
@every_place
def test_path_velocity_and_acceleration_never_jump(gait: str, placement: Placement) -> None:
    body = body_of(gait)
    h = 1e-7
    knots = np.unique(knots_s(body))
    before, after = (body.sensor(placement, knots + shift) for shift in (-h, h))
    np.testing.assert_allclose(after.position_m, before.position_m, atol=1e-5)
    np.testing.assert_allclose(after.velocity_mps, before.velocity_mps, atol=1e-4)
    np.testing.assert_allclose(after.acceleration_mps2, before.acceleration_mps2, atol=0.02)


@every_gait
@every_place
def test_angular_rate_is_the_rate_at_which_the_orientation_turns(gait: str, placement: Placement) -> None:
    body = body_of(gait)
    h = 1e-4
    t = instants(body)
    before, now, after = (body.sensor(placement, t + shift) for shift in (-h, 0.0, h))
    turned = (before.rotation.inv() * after.rotation).as_rotvec() / (2 * h)
    np.testing.assert_allclose(now.angular_rate_radps, turned, atol=0.01)


@every_place
def test_orientation_is_yaw_then_pitch_then_roll(placement: Placement) -> None:
    body = body_of("comfortable")
    motion = body.sensor(placement, instants(body, 0.05))
    expected = Rotation.from_euler("ZYX", motion.yaw_pitch_roll_rad)
    assert np.max((motion.rotation.inv() * expected).magnitude()) < 1e-12
    product = motion.rotation.as_matrix() @ motion.rotation.as_matrix().transpose(0, 2, 1)
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(3), product.shape), atol=1e-12)


@every_gait
def test_a_foot_is_perfectly_still_and_flat_in_every_rest(gait: str) -> None:
    body = body_of(gait)
    for side in Side:
        falls = body.course.footfalls[side]
        for k, (start, end) in enumerate(zip(falls.flat_s, falls.heel_off_s, strict=True)):
            motion = body.feet[side].sensor(np.linspace(start, end, 20))
            assert np.ptp(motion.position_m, axis=0).max() < 1e-12
            assert np.abs(motion.velocity_mps).max() < 1e-9
            assert np.abs(motion.acceleration_mps2).max() < 1e-6
            assert np.abs(motion.yaw_pitch_roll_rad[:, 1:]).max() < 1e-9
            sole = body.feet[side].pose(np.array([start, end]))
            np.testing.assert_allclose(sole.x.value, falls.position_m[k, 0], atol=1e-12)
            np.testing.assert_allclose(sole.y.value, falls.position_m[k, 1], atol=1e-12)
            np.testing.assert_allclose(sole.z.value, 0.0, atol=1e-12)


@every_gait
def test_the_sole_is_never_below_the_floor_and_stands_on_it_in_contact(gait: str) -> None:
    body = body_of(gait)
    t = instants(body)
    for side in Side:
        foot = body.feet[side]
        edges = [
            foot.pose(t).point((x, 0.0, 0.0))[2].value for x in (-foot.person.heel_m, foot.person.forefoot_m)
        ]
        lowest = np.minimum(*edges)
        assert lowest.min() > -1e-12
        falls = foot.footfalls
        contact = np.searchsorted(falls.initial_contact_s, t, side="right") - 1
        standing = (contact >= 0) & (t >= falls.flat_s[contact]) & (t <= falls.foot_off_s[contact])
        assert lowest[standing].max() < 1e-9
        swinging = (contact >= 0) & (t > falls.foot_off_s[contact] + 0.1) & (contact < len(falls.flat_s) - 1)
        assert lowest[swinging].min() > 1e-4


@settings(max_examples=30, deadline=None)
@given(
    gait=st.builds(
        Gait,
        stride_length_m=st.floats(0.2, 1.9),
        stride_time_s=st.floats(0.7, 2.5),
        step_width_m=st.floats(0.0, 0.3),
        stance_share=st.floats(0.55, 0.8),
        toe_up_rad=st.floats(0.02, 0.5),
        heel_rise_rad=st.floats(0.05, 1.3),
        lift_m=st.floats(0.0, 0.12),
        heel_strike_mps2=st.floats(0.0, 120.0),
    ),
    angle=st.floats(-3.5, 3.5),
)
def test_whatever_the_gait_no_sole_is_below_the_floor_and_no_speed_beyond_reason(
    gait: Gait, angle: float
) -> None:
    other = Walk(2.0, gait=presets.COMFORTABLE)
    body = build_body(Plan((Stand(1.0), other, Turn(angle), Walk(2.0), Stand(1.0)), gait))
    t = instants(body, 0.01)
    for side in Side:
        foot = body.feet[side]
        for x in (-foot.person.heel_m, foot.person.forefoot_m):
            assert foot.pose(t).point((x, 0.0, 0.0))[2].value.min() > -1e-9
        mean = gait.stride_length_m / (gait.stride_time_s * (1.0 - gait.stance_share))
        limit = 3.0 * max(mean, 3.5)
        assert np.linalg.norm(foot.sensor(t).velocity_mps, axis=1).max() < limit


@every_gait
def test_knee_and_ankle_keep_their_distance(gait: str) -> None:
    body = body_of(gait)
    t = instants(body)
    person = body.course.plan.person
    for side in Side:
        ankle = body.feet[side].pose(t).point((0.0, 0.0, person.ankle_height_m))
        apart = body.knees[side].joint(t).position_m - np.column_stack([axis.value for axis in ankle])
        np.testing.assert_allclose(np.linalg.norm(apart, axis=1), person.shank_length_m, atol=1e-12)


def test_a_knee_hardly_ever_rests() -> None:
    body = body_of("comfortable")
    t = instants(body)
    for side in Side:
        motion = body.sensor(Placement.knee(side), t)
        speed = np.linalg.norm(motion.velocity_mps, axis=1)
        assert np.mean(speed < 1e-4) < 0.01


def test_the_signals_resemble_those_of_a_healthy_walker() -> None:
    """Ranges as found in public recordings: foot 5 to 10 rad/s, sensor lifted 0.08 to 0.2 m, 3 to 5 m/s."""
    body = build_body(Plan((Stand(2.0), Walk(10.0), Stand(2.0))))
    gait = body.course.plan.gait
    motion = body.sensor(Placement.LEFT_FOOT, instants(body))
    assert 5.0 < np.abs(motion.angular_rate_radps[:, 1]).max() < 10.0
    assert 0.08 < np.ptp(motion.position_m[:, 2]) < 0.2
    assert 3.0 < motion.velocity_mps[:, 0].max() < 5.0
    assert 25.0 < np.linalg.norm(motion.acceleration_mps2, axis=1).max() < 80.0
    assert 0.25 < gait.rest_share < 0.35
    knee = body.sensor(Placement.LEFT_KNEE, instants(body))
    assert 4.0 < np.abs(knee.angular_rate_radps[:, 1]).max() < 9.0
    joint = body.knees[Side.LEFT].joint(instants(body)).position_m[:, 2]
    assert 0.35 < joint.min() < joint.max() < 0.55


def test_a_person_who_only_stands_does_not_step() -> None:
    body = build_body(Plan((Stand(2.0), Stand(1.0))))
    motion = body.sensor(Placement.RIGHT_FOOT, np.linspace(0.0, 3.0, 50))
    assert np.ptp(motion.position_m, axis=0).max() == 0.0
    assert body.course.duration_s == pytest.approx(3.0)
