"""The standing second is found, and offsets are what the sensor reads beside gravity and rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2, find_offsets, find_standing
from gaitlab.recording.model import Floats, Placement, Sensor, Source


def _signals(still: tuple[float, float], duration_s: float = 10.0) -> tuple[Floats, Floats]:
    """A sensor that shakes except from ``still[0]`` to ``still[1]`` seconds; 100 Hz."""
    t = np.arange(round(duration_s * 100)) / 100.0
    shaking = ((t < still[0]) | (t >= still[1]))[:, None]
    gyr = np.array([0.01, -0.02, 0.005]) + shaking * np.sin(9.0 * t)[:, None] * [2.0, 1.0, 0.5]
    acc = np.array([0.0, 0.3, 10.0]) + shaking * np.cos(9.0 * t)[:, None] * [3.0, 2.0, 1.0]
    return acc, gyr


def _sensor(acc: Floats, gyr: Floats) -> Sensor:
    n = len(acc)
    source = Source("test", "", 0)
    return Sensor(Placement.LEFT_FOOT, source, 100.0, 0, np.ones(n, bool), np.zeros(n, bool), acc, gyr)


def test_the_papers_second_is_taken_where_the_person_stands_then() -> None:
    acc, gyr = _signals((0.5, 6.0))
    start, end, standing = find_standing(acc, gyr, 100.0)
    assert standing
    assert start <= 200 < 300 <= end
    assert find_offsets(_sensor(acc, gyr), acc, gyr).as_in_paper


@pytest.mark.parametrize("still", [(4.5, 6.0), (8.2, 9.9), (0.0, 1.5)])
def test_a_standing_second_elsewhere_is_found(still: tuple[float, float]) -> None:
    acc, gyr = _signals(still)
    start, end, standing = find_standing(acc, gyr, 100.0)
    assert standing
    assert still[0] * 100 <= start + 1
    assert end - 1 <= still[1] * 100


def test_nobody_standing_is_said_and_leaves_the_gyroscope_alone() -> None:
    acc, gyr = _signals((20.0, 21.0))
    offsets = find_offsets(_sensor(acc, gyr), acc, gyr)
    assert not offsets.standing
    assert offsets.gyr_radps == (0.0, 0.0, 0.0)


def test_offsets_are_the_mean_rate_and_what_gravity_is_too_long() -> None:
    acc, gyr = _signals((0.0, 10.0))
    offsets = find_offsets(_sensor(acc, gyr), acc, gyr)
    assert offsets.gyr_radps == pytest.approx((0.01, -0.02, 0.005))
    size = float(np.hypot(0.3, 10.0))
    assert offsets.gravity_mps2 == pytest.approx(size)
    assert np.linalg.norm(acc[0] - np.array(offsets.acc_mps2)) == pytest.approx(STANDARD_GRAVITY_MPS2)


def test_offsets_turn_with_the_sensor() -> None:
    acc, gyr = _signals((0.5, 6.0))
    turn = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    sensor = _sensor(acc, gyr)
    plain = find_offsets(sensor, acc, gyr)
    other = replace(sensor, acc_mps2=acc @ turn.T, gyr_radps=gyr @ turn.T)
    moved = find_offsets(other, acc @ turn.T, gyr @ turn.T)
    np.testing.assert_allclose(turn @ plain.acc_mps2, moved.acc_mps2)
    np.testing.assert_allclose(turn @ plain.gyr_radps, moved.gyr_radps)


def test_every_real_foot_stands_somewhere(data_dir) -> None:
    from gaitlab.recording import read_recording

    folder = data_dir / "mtw-10m-walk"
    for path in sorted(folder.glob("*_lf.txt")):
        sensor = read_recording(placements={Placement.LEFT_FOOT: path}).sensors[Placement.LEFT_FOOT]
        assert sensor.acc_mps2 is not None
        assert sensor.gyr_radps is not None
        assert find_offsets(sensor, sensor.acc_mps2, sensor.gyr_radps).standing, path.name
