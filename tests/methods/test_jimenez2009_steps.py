"""The three step detectors of Jiménez et al. 2009: by hand, on simulated walks, on real ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from gaitlab.methods import jimenez2009_steps as jimenez
from gaitlab.methods.catalogue import of
from gaitlab.methods.jimenez2009_steps import AccelerationParams, spread
from gaitlab.methods.model import FootView, Method, Question
from gaitlab.recording.model import Floats, Side
from gaitlab.simulation import TYPICAL_MTW
from tests.methods.feet import built, real_feet, remounted, walk, walked

DETECTORS = of(Question.STEP)


def test_the_spread_is_the_standard_deviation_of_its_window() -> None:
    signal = np.array([0.0, 0.0, 3.0, 0.0, 0.0])
    # windows of three: (0, 0, 3) has mean 1 and variance (1 + 1 + 4) / 3
    np.testing.assert_allclose(spread(signal, 1, "window"), np.sqrt([0.0, 2.0, 2.0, 2.0, 0.0]), atol=1e-7)
    # as printed: local means 0 1 1 1 0, squared deviations 0 1 4 1 0
    np.testing.assert_allclose(spread(signal, 1, "sample"), np.sqrt([1 / 3, 5 / 3, 2.0, 5 / 3, 1 / 3]))


def burst() -> FootView:
    """Rows 100 to 199 shake by ±10 m/s² about gravity."""
    acc = np.zeros((400, 3))
    acc[:, 2] = 9.81
    acc[100:200:2, 2] += 10.0
    acc[101:200:2, 2] -= 10.0
    acc[acc[:, 2] < 0.0, 2] *= -1.0
    return built(acc)


def test_a_step_is_where_the_swing_ends() -> None:
    """With two shaken samples among 31 the deviation is about 2.5 m/s², with one 1.8: B1 falls 14 rows after the last."""
    np.testing.assert_allclose(jimenez.by_acceleration(burst()), [2.14])


def test_by_the_formula_of_step_4_there_is_no_step() -> None:
    assert not len(jimenez.by_acceleration(burst(), AccelerationParams(reading="rising")))


def test_a_step_needs_a_stance_soon_after_the_swing() -> None:
    quieter = AccelerationParams(stance_mps2=1e-9)
    np.testing.assert_allclose(jimenez.by_acceleration(burst(), quieter), [2.14])
    shaken = burst()
    acc = shaken.acc_mps2.copy()
    acc[200:, 2] += 1.4 * (-1.0) ** np.arange(200)  # between T2 and T1 for ever
    assert not len(jimenez.by_acceleration(built(acc)))


def test_the_foot_has_come_to_rest_when_most_of_the_window_is_still() -> None:
    gyr = np.zeros((400, 3))
    gyr[100:200, 1] = 2.0
    gyr[150:160] = 0.0  # through zero in mid-swing
    gyr[300:310, 0] = 2.0  # a twitch in stance
    np.testing.assert_allclose(jimenez.by_gyroscope(built(gyr_radps=gyr)), [2.0])
    rests = jimenez.rests(built(gyr_radps=gyr))
    assert rests.start.tolist() == [0, 200]
    assert rests.end.tolist() == [100, 400]
    assert rests.moment.tolist() == [49, 299]


@pytest.mark.parametrize("method", DETECTORS, ids=lambda m: m.name)
def test_every_stride_of_a_simulated_walk_ends_in_one_step(method: Method) -> None:
    """The acceleration alone may miss one that turns on the spot."""
    swings = walk().truth.feet[Side.LEFT]
    middle = 0.5 * (swings.foot_off_s + swings.initial_contact_s)
    found = np.diff(np.searchsorted(method.run(walked()), np.append(middle, np.inf)))
    assert np.all(found <= 1)
    straight = found[~swings.turning]
    assert np.all(straight == 1)
    assert np.sum(found == 0) <= (method.name == "jimenez2009_acceleration")


@pytest.mark.parametrize("method", DETECTORS, ids=lambda m: m.name)
def test_neither_the_mounting_nor_the_rate_changes_the_steps(method: Method) -> None:
    plain = method.run(walked())
    turn = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])
    np.testing.assert_allclose(method.run(remounted(TYPICAL_MTW, turn)), plain, atol=0.011)
    np.testing.assert_allclose(method.run(walked(None, 200.0)), method.run(walked(None)), atol=0.03)


def test_a_field_that_hardly_changes_shows_no_steps() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.003, (600, 3))
    assert not len(jimenez.by_magnetometer(built(mag=noise + np.array([0.2, 0.3, -0.9]))))
    assert not len(jimenez.by_magnetometer(built(mag=np.zeros((600, 3)))))


def missed(times_s: Floats, swings: Floats) -> tuple[int, int]:
    """Swings without a step between their middle and that of the next, and how many there are."""
    middle = swings.mean(axis=1)
    found = np.searchsorted(times_s, middle)
    return int(np.sum(np.diff(found) == 0)), len(middle) - 1


@pytest.mark.parametrize(
    ("detector", "most"),
    [
        (jimenez.by_acceleration, 0.02),
        (jimenez.by_gyroscope, 0.02),
        (jimenez.by_magnetometer, 0.06),
    ],
)
def test_few_steps_of_real_walks_are_missed(
    detector: Callable[[FootView], Floats], most: float, data_dir: Path
) -> None:
    counted = np.array([missed(detector(foot), swings) for foot, swings, _ in real_feet(data_dir)])
    assert counted[:, 0].sum() <= most * counted[:, 1].sum()


def test_the_letter_of_equation_2_misses_many_steps_and_that_of_step_4_nearly_all(data_dir: Path) -> None:
    def share(params: AccelerationParams) -> float:
        counted = [
            missed(jimenez.by_acceleration(foot, params), swings) for foot, swings, _ in real_feet(data_dir)
        ]
        return float(np.sum(counted, axis=0)[0] / np.sum(counted, axis=0)[1])

    assert share(AccelerationParams(mean_of="sample")) > 0.1
    assert share(AccelerationParams(reading="rising")) > 0.98


def test_a_recording_that_begins_in_a_swing_begins_with_its_first_step() -> None:
    shaken = burst()
    # B1 rises at row 86, with two shaken samples in its window; the window that ends before it is centred on row 70
    assert jimenez.stances(shaken).row.tolist() == [70, 214]
    late = built(shaken.acc_mps2[120:])
    assert jimenez.stances(late).row.tolist() == [94]
    assert jimenez.stances(built()).row.tolist() == [0]
