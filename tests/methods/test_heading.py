"""Heading by compass, by gyroscope, and by both."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gaitlab.methods import heading
from gaitlab.methods.catalogue import of
from gaitlab.methods.model import FootView, Method, Question
from gaitlab.methods.view import foot_view
from gaitlab.motion.foot import track_foot
from gaitlab.motion.quaternions import conjugate, rotate
from gaitlab.recording.model import Floats
from gaitlab.simulation import TYPICAL_MTW
from tests.methods.feet import LEFT, built, real_feet, remounted, walk, walked

ALL = of(Question.HEADING)
EARTH = np.array([0.2, 0.35, -0.9])


@cache
def drifting(drift_radps: float, disturbed: float = 0.0) -> FootView:
    """A perfect foot in the earth's field whose gyroscope drifts about the vertical once it walks; the field may be that
    of a noisy place instead."""
    recording = walk(None).recording
    sensor, time_s = recording.sensors[LEFT], recording.time_s(LEFT)
    assert sensor.gyr_radps is not None
    back = conjugate(track_foot(sensor, time_s).attitude)
    up = rotate(back, np.broadcast_to([0.0, 0.0, 1.0], sensor.gyr_radps.shape))
    walking = (time_s > 4.5)[:, None]
    noise = np.random.default_rng(2).normal(0.0, 1e-3 + disturbed, sensor.gyr_radps.shape)
    mag = rotate(back, np.broadcast_to(EARTH, sensor.gyr_radps.shape)) + noise
    sensor = replace(sensor, gyr_radps=sensor.gyr_radps + drift_radps * walking * up, mag=mag)
    return foot_view(sensor, track_foot(sensor, time_s))


def last(foot: FootView, values: Floats) -> float:
    return float(values[foot.motion.rests.moment[-1]])


@pytest.mark.parametrize("method", ALL, ids=lambda m: m.name)
def test_half_a_turn_to_the_left_is_half_a_turn_to_the_left(method: Method) -> None:
    foot = drifting(0.0)
    found = method.run(foot)
    assert found.shape == foot.time_s.shape
    assert found[foot.motion.rests.moment[0]] == pytest.approx(0.0, abs=1e-12)
    assert last(foot, found) == pytest.approx(np.pi, abs=0.03)


@pytest.mark.parametrize("method", ALL, ids=lambda m: m.name)
def test_neither_the_world_nor_the_mounting_turns_it(method: Method) -> None:
    foot = walked()
    turned = replace(foot, motion=foot.motion.turned(2.0))
    np.testing.assert_allclose(method.run(turned), method.run(foot), atol=1e-9)
    turn = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])
    moments = foot.motion.rests.moment
    other = method.run(remounted(TYPICAL_MTW, turn))
    np.testing.assert_allclose(other[moments], method.run(foot)[moments], atol=0.05)


def test_the_gyroscope_drifts_and_the_compass_does_not() -> None:
    foot = drifting(0.004)
    walked_s = foot.time_s[foot.motion.rests.moment[-1]] - 4.5
    assert last(foot, heading.by_gyroscope(foot)) == pytest.approx(np.pi + 0.004 * walked_s, abs=0.03)
    assert last(foot, heading.by_compass(foot)) == pytest.approx(np.pi, abs=0.03)


def test_the_two_together_drift_less_where_the_field_agrees() -> None:
    foot = drifting(0.004)
    assert foot.motion.field is not None
    assert foot.motion.field.used
    alone = abs(last(foot, heading.by_gyroscope(foot)) - np.pi)
    assert abs(last(foot, heading.combined(foot)) - np.pi) < 0.5 * alone


def test_a_disturbed_field_leaves_the_gyroscope_alone() -> None:
    foot = drifting(0.004, 1.0)
    np.testing.assert_array_equal(heading.combined(foot), heading.by_gyroscope(foot))


def test_the_rate_about_the_vertical_alone_is_no_heading() -> None:
    """Pitch by θ, roll by φ, pitch back, roll back: the vertical rate alone turns by −φ·sin θ, the foot hardly."""
    quarter, pitch, roll = 50, 0.8, 0.2
    rows = np.arange(4 * quarter)
    pitched = pitch * np.interp(rows, [0, quarter, 2 * quarter, 3 * quarter], [0, 1, 1, 0])
    rolled = roll * np.interp(rows, [quarter, 2 * quarter, 3 * quarter, 4 * quarter - 1], [0, 1, 1, 0])
    attitude = Rotation.from_euler("ZYX", np.stack([0.0 * rows, pitched, rolled], axis=1))
    foot = built(n=4 * quarter)
    rate = (attitude[1:] * attitude[:-1].inv()).as_rotvec() * foot.rate_hz
    motion = replace(
        foot.motion,
        attitude=attitude.as_quat(scalar_first=True),
        rate_radps=np.concatenate([np.zeros((1, 3)), rate]),
    )
    turned = replace(foot, motion=motion)
    assert heading.by_gyroscope(turned)[-1] == pytest.approx(0.0, abs=1e-9)
    assert heading.by_gyroscope(turned, letter=True)[-1] == pytest.approx(-roll * np.sin(pitch), abs=1e-3)


def test_on_a_real_foot_it_goes_astray_by_tens_of_degrees(data_dir: Path) -> None:
    apart = [
        last(foot, heading.by_gyroscope(foot)) - last(foot, heading.by_gyroscope(foot, letter=True))
        for foot, _, _ in real_feet(data_dir)
    ]
    assert np.degrees(np.std(apart)) > 40.0


def test_the_turns_from_rest_to_rest_are_added_up_whole_ones_too() -> None:
    foot = drifting(0.0)
    turns = foot.motion.turn_rad.copy()
    turns[2] += 2 * np.pi
    spun = replace(foot.motion, turn_rad=turns)
    moments = foot.motion.rests.moment
    added = np.concatenate([[0.0], np.cumsum(turns)])
    np.testing.assert_allclose(heading.foot_heading(spun)[moments], added, atol=1e-9)
    before = slice(0, moments[2])
    np.testing.assert_array_equal(
        heading.foot_heading(spun)[before], heading.foot_heading(foot.motion)[before]
    )
