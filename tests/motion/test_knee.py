"""The knee's path against the truth of simulated walks and against optical markers; which leg it is on."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from gaitlab.motion.foot import track_foot
from gaitlab.motion.knee import track_knee
from gaitlab.motion.model import FootMotion, KneeMotion, LegPlace
from gaitlab.motion.quaternions import matrices, turn_to_left
from gaitlab.recording import InputFile, Placement, Recording, Side, read_files
from gaitlab.recording.model import Floats
from gaitlab.simulation import TYPICAL_MTW, simulate
from gaitlab.simulation.presets import FAST, SHUFFLING, SLOW, ten_metre_and_back
from gaitlab.simulation.walk import Gait, Plan, Stand, Walk
from tests.walks import turned

DEVICES = {
    "left foot": "00B40C55",
    "right foot": "00B40C48",
    "left shank": "00B40BA5",
    "right shank": "00B40C35",
    "left ankle": "00B40C44",
    "right ankle": "00B40C47",
    "left thigh": "00B40C45",
    "right thigh": "00B40C3C",
    "pelvis": "00B40B91",
}


def knee_of(
    recording: Recording, foot: FootMotion | None = None, method: str = "gaitlab", side: Side = Side.LEFT
) -> KneeMotion:
    """The knee that the recording calls that of ``side``."""
    at_foot, at_knee = Placement.foot(side), Placement.knee(side)
    sensors = recording.sensors
    if foot is None:
        foot = track_foot(sensors[at_foot], recording.time_s(at_foot), method)
    shift = sensors[at_foot].first_packet - sensors[at_knee].first_packet
    return track_knee(sensors[at_knee], recording.time_s(at_knee), foot, shift, method)


def aligned_rms_m(knee: KneeMotion, rows: Floats, truth_m: Floats, lever: bool = False) -> float:
    """RMS distance from the true path (m, 3) at ``rows`` within the gait cycles: heading common to all, every cycle's
    start set equal, and where ``lever`` one constant lever arm in the sensor's axes."""
    axes, first = matrices(knee.attitude).transpose(2, 0, 1), int(rows[0])
    own, true, turning = [], [], []
    for start, end in zip(knee.cycle_start, knee.cycle_end, strict=True):
        if start >= first and end <= rows[-1]:
            own.append(knee.position_m[start : end + 1] - knee.position_m[start])
            true.append(truth_m[start - first : end + 1 - first] - truth_m[start - first])
            turning.append(axes[start : end + 1] - axes[start])
    path, there, turns = np.concatenate(own), np.concatenate(true), np.concatenate(turning)
    arm = np.zeros(3)
    for _ in range(10):
        moved = path + turns @ arm
        plane, true_plane = moved[:, 0] + 1j * moved[:, 1], there[:, 0] + 1j * there[:, 1]
        turned_truth = turn_to_left(there, float(np.angle(np.sum(plane * np.conj(true_plane)))))
        if lever:
            arm = np.linalg.lstsq(turns.reshape(-1, 3), (turned_truth - path).ravel(), rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum((path + turns @ arm - turned_truth) ** 2, axis=1))))


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 400.0])
@pytest.mark.parametrize(
    ("gait", "limit_m"), [(SLOW, 0.02), (Gait(), 0.02), (FAST, 0.025), (SHUFFLING, 0.012)]
)
def test_a_simulated_knee_goes_where_it_went(gait: Gait, limit_m: float, rate_hz: float) -> None:
    """Ten metres and back with a turn, both legs; what is left is mostly the foot's, so it is more the faster the foot."""
    walk = simulate(ten_metre_and_back(gait), TYPICAL_MTW, rate_hz=rate_hz, sampling="mean")
    for side in Side:
        knee = knee_of(walk.recording, side=side)
        assert knee.link is not None
        assert knee.link.place is LegPlace.SHANK
        off = round(float(knee.time_s[0]) * rate_hz)
        truth = walk.truth.knees[side].position_m[off : off + knee.n_samples]
        assert aligned_rms_m(knee, np.arange(len(truth)), truth) < limit_m


@pytest.mark.parametrize("gait", [SLOW, Gait(), FAST, SHUFFLING])
def test_the_knee_of_the_other_leg_is_seen(gait: Gait) -> None:
    walk = simulate(ten_metre_and_back(gait), TYPICAL_MTW, sampling="mean").recording
    crossed = dict(walk.sensors)
    crossed[Placement.LEFT_KNEE] = walk.sensors[Placement.RIGHT_KNEE]
    link = knee_of(Recording(crossed)).link
    assert link is not None
    assert link.place is LegPlace.UNKNOWN
    assert link.unexplained > 0.3


def test_how_the_sensor_sits_on_the_leg_does_not_change_the_path() -> None:
    walk = simulate(Plan((Stand(3.0), Walk(8.0), Stand(2.0))), TYPICAL_MTW, sampling="mean").recording
    other = dict(walk.sensors)
    mounting, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    other[Placement.LEFT_KNEE] = turned(walk.sensors[Placement.LEFT_KNEE], mounting * np.linalg.det(mounting))
    one, same = knee_of(walk), knee_of(Recording(other))
    path, same_path = (knee.position_m - knee.position_m[0] for knee in (one, same))
    np.testing.assert_allclose(path, same_path, atol=1e-3)


def test_a_longer_recording_does_not_loosen_the_knee() -> None:
    """Three minutes: the uncorrected path is hundreds of metres away and the link is as good as ever."""
    plan = Plan((Stand(3.0), *(Walk(20.0), Stand(1.5)) * 9, Stand(2.0)), Gait())
    walk = simulate(plan, TYPICAL_MTW, sampling="mean")
    knee = knee_of(walk.recording)
    assert np.abs(knee.raw_position_m).max() > 100.0
    assert knee.link is not None
    assert knee.link.unexplained < 0.12
    at = Placement.LEFT_FOOT
    foot = track_foot(walk.recording.sensors[at], walk.recording.time_s(at))
    assert np.abs(knee.position_m[-1] - knee.position_m[0] - foot.position_m[-1]).max() < 0.3


def test_a_knee_recorded_while_nobody_walked_keeps_its_own_path() -> None:
    walk = simulate(Plan((Stand(2.0), Walk(6.0), Stand(4.0))), None, sampling="mean").recording
    foot = track_foot(walk.sensors[Placement.LEFT_FOOT], walk.time_s(Placement.LEFT_FOOT))
    late = replace(
        foot, rests=replace(foot.rests, start=foot.rests.start + 10**6, end=foot.rests.end + 10**6)
    )
    knee = knee_of(walk, late)
    assert knee.link is None
    assert not len(knee.residual_m)


@cache
def real_walk(folder: Path, foot: str, leg: str) -> Recording:
    """The named sensors of ``mtw-leg-vicon`` as left foot and left knee."""
    paths = {
        at: folder / f"S02-Trial-Walk-1-000_{DEVICES[name]}.txt"
        for at, name in ((Placement.LEFT_FOOT, foot), (Placement.LEFT_KNEE, leg))
    }
    return read_files({at: InputFile(path.name, path.read_bytes()) for at, path in paths.items()})


@pytest.mark.parametrize("leg", ["left shank", "left ankle", "left thigh"])
def test_the_optical_knee_is_met_within_three_centimetres(data_dir: Path, leg: str) -> None:
    """Every gait cycle of the left leg, from its start to its end; the paper's correction lies beside it."""
    folder = data_dir / "mtw-leg-vicon"
    optical = np.genfromtxt(folder / "vicon-left-leg.csv", delimiter=",", names=True)
    truth = np.stack([optical[f"LFEO_{axis}"] for axis in (1, 2, 3)], axis=1)
    walk = real_walk(folder, "left foot", leg)
    own, paper = knee_of(walk), knee_of(walk, method="ikizoglu2018")
    rms = aligned_rms_m(own, optical["row"], truth, lever=True)
    paper = replace(paper, cycle_start=own.cycle_start, cycle_end=own.cycle_end)
    assert rms <= 0.03
    assert rms < 0.65 * aligned_rms_m(paper, optical["row"], truth, lever=True)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_real_leg_tells_where_on_it_the_sensor_is_and_which_foot_is_below(
    data_dir: Path, side: str
) -> None:
    folder = data_dir / "mtw-leg-vicon"
    foot = knee_foot(folder, f"{side} foot")
    places = {}
    for leg in DEVICES:
        if not leg.endswith("foot"):
            link = knee_of(real_walk(folder, f"{side} foot", leg), foot).link
            assert link is not None
            places[leg] = link.place
    expected = dict.fromkeys(places, LegPlace.UNKNOWN) | {
        f"{side} shank": LegPlace.SHANK,
        f"{side} ankle": LegPlace.SHANK,
        f"{side} thigh": LegPlace.THIGH,
    }
    assert places == expected


def knee_foot(folder: Path, foot: str) -> FootMotion:
    """A real foot, tracked once."""
    walk = real_walk(folder, foot, "pelvis")
    return track_foot(walk.sensors[Placement.LEFT_FOOT], walk.time_s(Placement.LEFT_FOOT))
