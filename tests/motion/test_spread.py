"""The covariance of every place and velocity: the smoother's at the rests, wider between, and as wide as the errors are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.motion.spread import spread_of
from gaitlab.recording.model import Placement, Side
from gaitlab.simulation import TYPICAL_MTW, SensorErrors
from tests.walks import analysed, out_and_back

LEFT = Placement.LEFT_FOOT


def foot_of(errors: SensorErrors = TYPICAL_MTW) -> FootMotion:
    walk = out_and_back(errors).recording
    return track_foot(walk.sensors[LEFT], walk.time_s(LEFT))


def test_at_the_rests_it_is_the_smoothers_and_the_scales() -> None:
    foot = foot_of()
    spread = spread_of(foot)
    rows = foot.rests.moment
    way = foot.position_m[rows] - foot.position_m[rows[0]]
    expected = foot.place_covariance_m2 + foot.scale_sd**2 * way[:, :, None] * way[:, None, :]
    np.testing.assert_allclose(spread.place_m2[rows], expected, atol=1e-12)
    assert (np.linalg.eigvalsh(spread.velocity_m2ps2) > 0.0).all()


def test_a_passage_with_doubtful_samples_is_wider_in_its_middle() -> None:
    foot = foot_of()
    hurt = replace(foot, velocity_var_m2ps2=foot.velocity_var_m2ps2 + 0.04)
    middle = (foot.rests.end[3] + foot.rests.start[4]) // 2
    plain, wide = spread_of(foot), spread_of(hurt)
    assert np.trace(wide.place_m2[middle]) > np.trace(plain.place_m2[middle])
    assert np.trace(wide.velocity_m2ps2[middle]) > np.trace(plain.velocity_m2ps2[middle]) + 0.007
    np.testing.assert_allclose(wide.place_m2[foot.rests.moment], plain.place_m2[foot.rests.moment])


def test_true_velocities_and_heights_lie_within_three_standard_deviations() -> None:
    """In the analysis's world, which the truth shares but for a fraction of a degree of heading."""
    walk, foot = out_and_back(), analysed().gait.feet[Side.LEFT].motion
    truth = walk.truth.feet[Side.LEFT]
    at = [np.interp(foot.time_s, walk.truth.t_s, truth.velocity_mps[:, k]) for k in range(3)]
    height = np.interp(foot.time_s, walk.truth.t_s, truth.position_m[:, 2])
    spread = spread_of(foot)
    inside = slice(int(foot.rests.end[0]), int(foot.rests.start[-1]))
    speed = np.linalg.norm(foot.velocity_mps[inside], axis=1) - np.linalg.norm(
        np.stack(at, axis=1)[inside], axis=1
    )
    sd = np.sqrt(np.linalg.eigvalsh(spread.velocity_m2ps2[inside])[:, -1])
    assert np.mean(np.abs(speed) < 3.0 * sd) > 0.95
    error = foot.position_m[inside, 2] - (height[inside] - height[foot.rests.moment[0]])
    error -= foot.position_m[foot.rests.moment[0], 2]
    assert np.mean(np.abs(error) < 3.0 * np.sqrt(spread.place_m2[inside, 2, 2])) > 0.9


def test_a_foot_without_rests_has_a_spread_too() -> None:
    foot = foot_of()
    still = track_foot(
        replace(out_and_back().recording.sensors[LEFT], gyr_radps=np.zeros((foot.n_samples, 3))), foot.time_s
    )
    assert spread_of(still).place_m2.shape == (foot.n_samples, 3, 3)
