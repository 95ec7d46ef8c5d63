"""Height by barometer, floors, and the inertial height beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.methods.catalogue import of
from gaitlab.methods.height import FloorParams, barometric_height, by_barometer, floor_of
from gaitlab.methods.model import Method, Question
from tests.methods.feet import built, walked


def test_the_standard_atmosphere() -> None:
    """Table values of the ICAO atmosphere: 95 461 Pa at 500 m, 89 875 Pa at 1000 m."""
    np.testing.assert_allclose(
        barometric_height(np.array([101325.0, 95461.0, 89874.6]), 101325.0), [0.0, 500.0, 1000.0], atol=0.1
    )


def test_the_first_rest_is_the_floor() -> None:
    foot = walked()
    assert foot.pressure_pa is not None
    height = by_barometer(foot)
    rests = foot.motion.rests
    assert abs(height[rests.start[0] : rests.end[0]].mean()) < 1e-3
    weather = replace(foot, pressure_pa=foot.pressure_pa * 0.95)
    np.testing.assert_allclose(by_barometer(weather), height, atol=1e-9)


def test_the_noise_of_the_barometer_does_not_grow_and_is_not_smoothed() -> None:
    """3 Pa are 0.25 m (simulated: no public recording here holds a pressure)."""
    foot = walked()
    height = by_barometer(foot)
    for part in (height[:500], height[-500:]):
        assert part.std() == pytest.approx(0.25, rel=0.25)
        assert abs(part.mean()) < 0.1


@pytest.mark.parametrize("method", of(Question.HEIGHT), ids=lambda m: m.name)
def test_a_walk_on_the_flat_does_not_climb(method: Method) -> None:
    foot = walked()
    height = method.run(foot)
    assert height.shape == foot.time_s.shape
    assert np.abs(np.median(height[-300:])) < (0.9 if method.name == "feliz2009_inertial" else 0.1)


def test_floors_by_hand() -> None:
    height = np.array([0.0, 1.0, 1.4, 1.6, 2.5, 1.6, 1.4, 0.7, 0.5, -2.5, 6.2])
    # of 3 m: within 0.2 of a storey, 0.6 m, a height is certain; 0.7 to 1.6 m are not
    assert floor_of(height, 3.0).tolist() == [0, 0, 0, 0, 1, 1, 1, 1, 0, -1, 2]


def test_noise_between_two_floors_changes_nothing() -> None:
    noisy = 1.5 + np.random.default_rng(3).uniform(-0.4, 0.4, 500)
    assert set(floor_of(np.concatenate([[0.0], noisy]), 3.0)) == {0}
    assert set(floor_of(np.concatenate([[3.0], noisy]), 3.0)) == {1}
    assert len(set(floor_of(np.concatenate([[3.0], noisy]), 3.0, FloorParams(margin=0.0)))) == 2


def test_heights_that_are_not_known_change_no_floor() -> None:
    assert floor_of(np.array([np.nan, 3.0, np.nan, np.inf, 6.0]), 3.0).tolist() == [0, 1, 1, 1, 2]
    assert floor_of(np.zeros(0), 3.0).shape == (0,)


def test_a_climb_of_two_storeys_by_barometer() -> None:
    foot = walked()
    assert foot.pressure_pa is not None
    climb = np.clip((foot.time_s - 6.0) * 0.4, 0.0, 6.0)
    pressure = foot.pressure_pa - 12.01 * climb  # near the ground, ρ·g
    floors = floor_of(by_barometer(replace(foot, pressure_pa=pressure)), 3.0)
    assert floors[0] == 0
    assert floors[-1] == 2
    assert np.sum(np.diff(floors) != 0) == 2


def test_no_pressure_no_height() -> None:
    assert np.isnan(by_barometer(built(pressure_pa=np.zeros(50)))).all()
