"""What a long gap or a walk without standing makes of the numbers: wider, marked or not given, and never quietly wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.analysis import Analysis, analyze
from gaitlab.motion.free import calibrate
from gaitlab.recording.model import Placement, Recording, Sensor, Side
from tests.walks import cut, out_and_back, without


def held(sensor: Sensor, start: int, end: int) -> Sensor:
    """The sensor with rows ``[start, end)`` lost, filled as a reader fills them: with the mean over the gap."""
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    acc, gyr, received = sensor.acc_mps2.copy(), sensor.gyr_radps.copy(), sensor.received.copy()
    acc[start : end + 1] = acc[start : end + 1].mean(axis=0)
    gyr[start : end + 1] = gyr[start : end + 1].mean(axis=0)
    received[start:end] = False
    return replace(sensor, acc_mps2=acc, gyr_radps=gyr, received=received)


def with_gap(start_s: float, end_s: float) -> Analysis:
    recording = without(out_and_back().recording, Placement.LEFT_KNEE, Placement.RIGHT_KNEE)
    left = held(recording.sensors[Placement.LEFT_FOOT], round(100 * start_s), round(100 * end_s))
    return analyze(Recording({**recording.sensors, Placement.LEFT_FOOT: left}))


def test_the_held_rows_of_a_gap_are_no_standing() -> None:
    sensor = out_and_back().recording.sensors[Placement.LEFT_FOOT]
    plain = calibrate(sensor).offsets
    gap = calibrate(held(sensor, 600, 1200)).offsets
    assert (gap.start, gap.end) == (plain.start, plain.end)


def test_a_walk_without_standing_keeps_its_lengths() -> None:
    walk = out_and_back()
    parts = {at: cut(one, 560, 1250) for at, one in walk.recording.sensors.items() if at.is_foot}
    analysis = analyze(Recording(parts))
    assert "no_standing" in [one.code for one in analysis.result.warnings]
    for side in Side:
        true = walk.truth.feet[side].stride_length_m
        length = analysis.result.parameter("stride_length", side.value)
        assert length is not None
        assert length.value is not None
        assert length.value == pytest.approx(float(np.median(true[2:6])), abs=0.03)


def test_a_gap_of_a_second_and_a_half_widens_the_distance_and_not_to_the_moon() -> None:
    distance = with_gap(9.0, 10.5).result.parameter("traversed_distance", "left")
    assert distance is not None
    assert distance.sd is not None
    assert 0.3 < distance.sd < 4.0


def test_a_gap_of_six_seconds_leaves_no_distance() -> None:
    result = with_gap(6.0, 12.0).result
    for name in ("traversed_distance", "closing_distance"):
        one = result.parameter(name, "left")
        assert one is not None
        assert one.status == "not_determinable"
        assert "lost" in one.reason


def test_a_turn_that_one_foot_did_not_see_is_the_other_foots() -> None:
    angle = with_gap(11.0, 17.0).result.parameter("turn_angle", "both")
    assert angle is not None
    if angle.value is not None:
        assert angle.value == pytest.approx(180.0, abs=8.0)
        assert angle.status == "attention"
