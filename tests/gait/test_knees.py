"""The knee's sway in stance against what really happened."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gaitlab.analysis import analyze
from gaitlab.gait.knees import SWAY_SD_M, sway_across
from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import LegPlace
from gaitlab.recording import Placement
from gaitlab.simulation import TYPICAL_MTW, simulate
from gaitlab.simulation.presets import timed_25_foot_walk
from tests.motion.test_knee import knee_of, real_walk


def test_sway_is_what_a_straight_line_leaves_across_the_line_of_walking() -> None:
    t = np.linspace(0.0, 1.0, 101)
    wave = 0.01 * np.cos(2.0 * np.pi * t)
    along, left = np.array([0.6, 0.8, 0.0]), np.array([-0.8, 0.6, 0.0])
    path = np.outer(3.0 * t**2, along) + np.outer(0.2 * t + wave, left) + [0.0, 0.0, 7.0]
    np.testing.assert_allclose(sway_across(path, 2.5 * along), wave - wave.mean(), atol=1e-9)


@pytest.mark.parametrize("rate_hz", [50.0, 200.0])
def test_a_simulated_knee_sways_as_much_as_it_did(rate_hz: float) -> None:
    walk = simulate(timed_25_foot_walk(), TYPICAL_MTW, rate_hz=rate_hz, sampling="mean")
    analysis = analyze(walk.recording)
    for side, knee in analysis.gait.knees.items():
        foot, motion = analysis.gait.feet[side], knee.motion
        first = motion.time_s[0]
        truth = walk.truth.knees[side].position_m[round(float(first) * rate_hz) :]
        shift = round(float(foot.motion.time_s[0] - first) * rate_hz)
        inner = [k for k in range(1, len(foot.motion.rests) - 1) if foot.straight[k - 1] and foot.straight[k]]
        assert len(knee.sway_sd_m) == len(inner) > 3
        true = [
            sway_across(
                truth[foot.motion.rests.start[k] + shift : foot.motion.rests.end[k] + shift],
                np.array([1.0, 0.0, 0.0]),
            ).std()
            for k in inner
        ]
        np.testing.assert_allclose(knee.sway_sd_m, true, atol=2e-4)


def test_a_real_shank_sways_as_its_optical_place_does(data_dir: Path) -> None:
    """Six rests: the optical leg at the height of the sensor, two thirds of the way from ankle to knee."""
    walk = real_walk(data_dir / "mtw-leg-vicon", "left foot", "left shank")
    foot = track_foot(walk.sensors[Placement.LEFT_FOOT], walk.time_s(Placement.LEFT_FOOT))
    knee = knee_of(walk, foot)
    shift = walk.sensors[Placement.LEFT_FOOT].first_packet - walk.sensors[Placement.LEFT_KNEE].first_packet
    optical = np.genfromtxt(data_dir / "mtw-leg-vicon" / "vicon-left-leg.csv", delimiter=",", names=True)
    ankle, joint = (
        np.stack([optical[f"{name}_{axis}"] for axis in (1, 2, 3)], axis=1) for name in ("LTIO", "LFEO")
    )
    leg, first, half_cycle = ankle + 0.62 * (joint - ankle), int(optical["row"][0]), 60
    differences = []
    for k in range(1, len(foot.rests) - 1):
        low, high = int(foot.rests.start[k]) + shift, int(foot.rests.end[k]) + shift
        if low - half_cycle < first or high + half_cycle > optical["row"][-1]:
            continue
        own = sway_across(
            knee.position_m[low:high], foot.rest_position_m[k + 1] - foot.rest_position_m[k - 1]
        )
        line = leg[high + half_cycle - first] - leg[low - half_cycle - first]
        differences.append(own - sway_across(leg[low - first : high - first], line))
    assert len(differences) > 3
    assert np.sqrt(np.mean(np.concatenate(differences) ** 2)) < SWAY_SD_M[LegPlace.SHANK]
