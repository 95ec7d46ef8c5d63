"""Foot off and initial contact: against the truth of simulated walks, and against the hand-checked events."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.gait.events import FootEvents, find_events
from gaitlab.motion.course import CourseParams, Swings
from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement, Sensor, Side
from gaitlab.simulation import TYPICAL_MTW, Simulation, simulate
from gaitlab.simulation import presets as gaits
from gaitlab.simulation.walk import Gait
from tests.walks import out_and_back, turned

LEFT = Placement.LEFT_FOOT


def _tracked(sensor: Sensor) -> FootMotion:
    return track_foot(sensor, np.arange(sensor.n_samples) / sensor.rate_hz)


def _errors_ms(walk: Simulation, side: Side) -> tuple[np.ndarray, np.ndarray]:
    placement = Placement.foot(side)
    events = find_events(track_foot(walk.recording.sensors[placement], walk.recording.time_s(placement)))
    truth = walk.truth.feet[side]
    return 1000.0 * (events.foot_off_s - truth.foot_off_s), 1000.0 * (
        events.initial_contact_s - truth.initial_contact_s
    )


@pytest.mark.parametrize(
    "gait",
    [gaits.COMFORTABLE, gaits.FAST, gaits.SLOW, gaits.SHUFFLING, gaits.LIMPING, gaits.ATAXIC],
    ids=["comfortable", "fast", "slow", "shuffling", "limping", "ataxic"],
)
def test_events_are_those_of_any_simulated_gait_turn_and_ends_included(gait: Gait) -> None:
    """The delays were set on labels of real healthy walks; the simulation knows nothing of those."""
    walk = simulate(gaits.ten_metre_and_back(gait), TYPICAL_MTW, knees=False, sampling="mean")
    for side in Side:
        for error in _errors_ms(walk, side):
            assert abs(np.median(error)) <= 12.0
            assert np.abs(error).max() <= 25.0


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0, 400.0])
def test_events_do_not_depend_on_the_rate(rate_hz: float) -> None:
    for side in Side:
        for error, expected in zip(_errors_ms(out_and_back(rate_hz=rate_hz), side), (4.0, -4.0), strict=True):
            assert np.median(error) == pytest.approx(expected, abs=2.0)


def test_times_lie_between_samples() -> None:
    """Stride times of a perfect sensor at 50 Hz are right to a twentieth of a sample."""
    for side in Side:
        _, contact = _errors_ms(out_and_back(None, 50.0), side)
        assert np.median(np.abs(np.diff(contact))) <= 1.0


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=10)
def test_turning_the_sensor_on_the_foot_moves_no_event(seed: int) -> None:
    sensor = out_and_back().recording.sensors[LEFT]
    matrix = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    plain, other = find_events(_tracked(sensor)), find_events(_tracked(turned(sensor, matrix)))
    np.testing.assert_allclose(other.foot_off_s, plain.foot_off_s, atol=0.003)
    np.testing.assert_allclose(other.initial_contact_s, plain.initial_contact_s, atol=0.005)


def test_turning_the_world_moves_no_event() -> None:
    foot = _tracked(out_and_back().recording.sensors[LEFT])
    plain, other = find_events(foot), find_events(foot.turned(2.0))
    np.testing.assert_allclose(other.foot_off_s, plain.foot_off_s, atol=1e-9)
    np.testing.assert_allclose(other.initial_contact_s, plain.initial_contact_s, atol=1e-9)


def test_a_foot_without_two_rests_has_no_events() -> None:
    sensor = out_and_back().recording.sensors[LEFT]
    still = Sensor(
        **{
            **vars(sensor),
            "acc_mps2": np.tile([0.0, 0.0, 9.81], (sensor.n_samples, 1)),
            "gyr_radps": np.zeros((sensor.n_samples, 3)),
            "attitude": None,
        }
    )
    assert len(find_events(_tracked(still)).foot_off_s) == 0


def _in_trial(events: FootEvents, foot: FootMotion, trial: tuple[float, float]) -> np.ndarray:
    """Foot offs and contacts, shape (m, 2), of the strides that overlap the trial."""
    times = np.stack([events.foot_off_s, events.initial_contact_s], axis=1)
    chosen = Swings.of(foot, CourseParams()).walking & ~events.on_the_spot
    return times[chosen & (times[:, 0] < trial[1]) & (times[:, 1] > trial[0])]


def test_hand_checked_events_are_found(data_dir: Path) -> None:
    """1,615 swings of 8 people, within 50 ms: the turn, the last step and what came after the trial included.

    What is missing lies in the turn and at the end, and is in part the labels': for 21 contacts and 29 foot offs none
    of the witnesses that were tried (11 and 6) comes within 50 ms.
    """
    labelled, strides = 0, []
    found, ours, wrong = np.zeros(2), np.zeros(2), np.zeros(2)
    for path in sorted((data_dir / "mtw-10m-walk").glob("*.json")):
        labels = json.loads(path.read_text())
        for side, key, suffix in ((Side.LEFT, "LeftFootEvents", "lf"), (Side.RIGHT, "RightFootEvents", "rf")):
            placement = Placement.foot(side)
            file = path.with_name(f"{path.stem}_{suffix}.txt")
            sensor = read_recording(placements={placement: file}).sensors[placement]
            foot = _tracked(sensor)
            events = find_events(foot)
            truth = (np.array(labels[key]) - sensor.first_packet) / sensor.rate_hz
            trial = tuple((t - sensor.first_packet) / sensor.rate_hz for t in labels["TrialBoundaries"])
            labelled += len(truth)
            everything = np.stack([events.foot_off_s, events.initial_contact_s], axis=1)
            within = _in_trial(events, foot, trial)
            for kind in (0, 1):
                distance = np.abs(truth[:, kind, None] - everything[:, kind])
                hit = distance.min(axis=1) <= 0.0501
                found[kind] += hit.sum()
                ours[kind] += len(within)
                wrong[kind] += np.sum(np.abs(within[:, kind, None] - truth[:, kind]).min(axis=1) > 0.0501)
                if kind:
                    error = np.where(hit, everything[distance.argmin(axis=1), 1] - truth[:, 1], np.nan)
                    strides.append(np.diff(error))
    error = np.concatenate(strides)
    assert labelled == 1615
    assert (found >= np.array([0.965, 0.955]) * labelled).all()
    assert (1.0 - wrong / ours >= [0.965, 0.955]).all()
    assert np.nanmean(np.abs(error)) <= 0.0087
