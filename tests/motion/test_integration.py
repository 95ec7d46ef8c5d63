"""Integration and velocity reset in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.motion import ikizoglu2018
from gaitlab.motion.integration import position_of, reset_at_rests, velocity_of
from gaitlab.motion.model import Rests

RATE = 100.0
N = 300


def _rests(*spans: tuple[int, int]) -> Rests:
    start, end = np.array([s[0] for s in spans]), np.array([s[1] for s in spans])
    return Rests(start, end, (start + end) // 2, np.zeros((len(spans), 3)))


def _swings() -> tuple[np.ndarray, np.ndarray]:
    """Mean acceleration of each interval, and true velocity, of two swings of 0.5 m forward between three rests."""
    t = np.arange(N) / RATE
    velocity = np.zeros((N, 3))
    for begin in (0.5, 1.75):
        phase = np.clip((t - begin) / 0.75, 0.0, 1.0)
        velocity[:, 0] += np.where(
            (phase > 0) & (phase < 1), (0.5 / 0.75) * (1 - np.cos(2 * np.pi * phase)), 0.0
        )
    acceleration = np.zeros((N, 3))
    acceleration[1:] = np.diff(velocity, axis=0) * RATE
    return acceleration, velocity


RESTS = _rests((0, 50), (126, 175), (251, 300))


def test_mean_accelerations_add_up_to_the_true_velocity() -> None:
    acceleration, velocity = _swings()
    np.testing.assert_allclose(velocity_of(acceleration, RATE), velocity, atol=1e-12)


def test_position_of_a_uniform_velocity_grows_linearly() -> None:
    velocity = np.tile([1.5, 0.0, -0.5], (N, 1))
    np.testing.assert_allclose(position_of(velocity, RATE)[-1], [1.5 * 2.99, 0.0, -0.5 * 2.99])


@pytest.mark.parametrize("offset", [0.05, -0.3, 1.0])
def test_a_constant_acceleration_offset_is_removed_whole(offset: float) -> None:
    acceleration, velocity = _swings()
    corrected, rests = reset_at_rests(
        velocity_of(acceleration + np.array([offset, -offset, offset]), RATE), RESTS
    )
    np.testing.assert_allclose(corrected, velocity, atol=1e-9)
    length = np.diff(position_of(corrected, RATE)[RESTS.moment], axis=0)[:, 0]
    np.testing.assert_allclose(length, 0.5, atol=1e-4)
    np.testing.assert_allclose(rests.residual_mps[1:, 0], offset * 0.77, atol=1e-9)


def test_the_velocity_is_zero_in_every_rest() -> None:
    rng = np.random.default_rng(1)
    corrected, _ = reset_at_rests(rng.normal(size=(N, 3)), RESTS)
    assert not corrected[RESTS.mask(N)].any()


def test_without_a_rest_nothing_is_corrected() -> None:
    raw = np.random.default_rng(2).normal(size=(N, 3))
    corrected, rests = reset_at_rests(raw, _rests())
    np.testing.assert_array_equal(corrected, raw)
    assert len(rests) == 0


def test_the_papers_position_error_of_an_offset_is_half_a_t_squared_each_step() -> None:
    """İkizoğlu et al. 2018, §3.2: Δp = a·t²/2 with a reset at every rest, 0.00625 m for 0.05 m/s² and 0.5 s."""
    rests = _rests((0, 50), (99, 150), (199, 250))
    acceleration = np.tile([0.05, 0.0, 0.0], (N, 1))
    velocity, _ = ikizoglu2018.reset_at_rests(acceleration, rests, RATE)
    error = np.diff(position_of(velocity, RATE)[rests.moment], axis=0)[:, 0]
    np.testing.assert_allclose(error, 0.05 * 0.5**2 / 2, rtol=0.06)


def test_the_papers_rest_needs_five_successive_samples_below_its_threshold() -> None:
    acceleration = np.full((100, 3), 1.0)
    acceleration[10:14] = 0.0  # four: too short
    acceleration[40:45] = 0.08  # five, resultant 0.139
    acceleration[70:80] = 0.09  # resultant 0.156: too large
    rests = ikizoglu2018.find_rests(acceleration, RATE)
    assert [(int(a), int(b)) for a, b in zip(rests.start, rests.end, strict=True)] == [(40, 45)]
