"""Moving mean and maximum against their definition and against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from gaitlab.motion.moving import moving_maximum, moving_mean


@pytest.mark.parametrize("width", [1, 2, 3, 8, 17, 100, 250])
@pytest.mark.parametrize("n", [1, 5, 120, 2800])
def test_the_moving_mean_is_scipys_to_the_last_bit(n: int, width: int) -> None:
    values = np.random.default_rng(n).normal(size=(3, n))
    expected = uniform_filter1d(values, width, axis=1, mode="nearest")
    np.testing.assert_array_equal(moving_mean(values, width), expected)
    np.testing.assert_array_equal(moving_mean(values[0], width), expected[0])


@pytest.mark.parametrize("width", [1, 3, 7, 131, 301])
@pytest.mark.parametrize("n", [1, 5, 120, 2800])
def test_the_moving_maximum_is_that_of_the_window_around_each_sample(n: int, width: int) -> None:
    values = np.random.default_rng(n).normal(size=n)
    np.testing.assert_array_equal(
        moving_maximum(values, width), maximum_filter1d(values, width, mode="nearest")
    )


def test_a_ramp_keeps_its_means_away_from_the_ends() -> None:
    ramp = np.arange(50.0)
    np.testing.assert_allclose(moving_mean(ramp, 5)[2:-2], ramp[2:-2])
    np.testing.assert_allclose(moving_mean(ramp, 4)[2:-1], ramp[2:-1] - 0.5)
    np.testing.assert_array_equal(moving_maximum(ramp, 5), np.minimum(ramp + 2.0, 49.0))
