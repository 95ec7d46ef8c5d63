"""Calibration against a reference: known systems are recovered; where nothing is known nothing is claimed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from gaitlab.analysis import analyze
from gaitlab.methods import calibration_linear as linear
from gaitlab.methods import calibration_nonlinear as nonlinear
from gaitlab.methods.calibration_model import (
    NO_MOVEMENT,
    NOT_GIVEN,
    TOO_SHORT,
    Calibration,
    calibration,
    goodness_of_fit,
)
from gaitlab.methods.calibration_signals import calibration_pairs
from gaitlab.recording import Placement, Side, read_recording
from gaitlab.recording.model import Floats
from gaitlab.validation.leg_vicon_check import read_optical, sensors_of
from tests.walks import analysed

METHODS = {method.name: method for method in (*linear.METHODS, *nonlinear.METHODS)}
N, TRAIN = 1600, 800
A, B, C = [1.0, -1.5, 0.7], [0.0, 1.0, 0.5], [1.0, -1.0, 0.2]


def noise(seed: int) -> Floats:
    """White, after ten rows of rest."""
    white = np.random.default_rng(seed).normal(size=N)
    white[:10] = 0.0
    return white


def armax_system(noise_size: float = 0.1) -> tuple[Floats, Floats]:
    """A(q)y = B(q)u + C(q)e."""
    u = noise(1)
    return u, lfilter(B, A, u) + noise_size * lfilter(C, A, noise(2))


def as_given(u: Floats, y: Floats) -> float:
    """By what a gain identified on scaled signals has to be multiplied."""
    return float(y[:TRAIN].std() / u[:TRAIN].std())


def test_goodness_of_fit_by_hand() -> None:
    y = np.array([0.0, 1.0, 2.0, 3.0])  # ‖y − 1.5‖ = √5
    assert goodness_of_fit(y, y) == 100.0
    assert goodness_of_fit(y, np.full(4, 1.5)) == pytest.approx(0.0)
    assert goodness_of_fit(y, y + 0.5) == pytest.approx(100.0 * (1.0 - 1.0 / np.sqrt(5.0)))
    assert np.isnan(goodness_of_fit(np.ones(4), y))
    assert np.isnan(goodness_of_fit(y[:1], y[:1]))


def test_armax_recovers_the_polynomials_of_a_system_with_coloured_noise() -> None:
    u, y = armax_system()
    found = linear.armax(u, y, TRAIN)
    a, b, c = found.parameters[:2], found.parameters[2:4] * as_given(u, y), found.parameters[4:6]
    np.testing.assert_allclose(a, A[1:], atol=0.01)
    np.testing.assert_allclose(b, B[1:], atol=0.03)
    np.testing.assert_allclose(c, C[1:], atol=0.1)
    assert found.fit_test_percent > 95.0


def test_least_squares_alone_would_be_biased_by_that_noise() -> None:
    """What makes C worth its trouble: without it the poles are off by more than the tolerance above."""
    u, y = armax_system(noise_size=1.0)
    x = np.stack(
        [-linear.shifted(y, 1), -linear.shifted(y, 2), linear.shifted(u, 1), linear.shifted(u, 2)], 1
    )
    plain = np.linalg.lstsq(x[:TRAIN], y[:TRAIN], rcond=None)[0][:2]
    with_noise = linear.armax(u, y, TRAIN).parameters[:2]
    assert np.abs(with_noise - A[1:]).max() < 0.5 * np.abs(plain - A[1:]).max()


@pytest.mark.parametrize(
    "name", ["armax", "box_jenkins", "state_space", "armax_free_run", "box_jenkins_free_run"]
)
def test_every_polynomial_model_that_holds_the_system_finds_its_frequency_response(name: str) -> None:
    u, y = armax_system()
    orders = {
        "armax": linear.ARMAX,
        "box_jenkins": linear.BOX_JENKINS,
        "state_space": linear.STATE_SPACE,
        "armax_free_run": linear.FREE_RUN_OF_TWO,
        "box_jenkins_free_run": linear.FREE_RUN_OF_FOUR,
    }[name]
    found = METHODS[name].run(u, y, TRAIN)
    model = linear.polynomials(found.parameters, orders)
    q = np.exp(-1j * np.linspace(0.1, 3.0, 30))
    below = np.polyval(model.a[::-1], q) * np.polyval(model.f[::-1], q)
    response = as_given(u, y) * np.polyval(model.b[::-1], q) / below
    truth = np.polyval(B[::-1], q) / np.polyval(A[::-1], q)
    assert np.abs(response - truth).max() < 0.05 * np.abs(truth).max()
    assert found.fit_test_percent > 95.0


def test_the_two_sided_response_is_that_of_the_system_and_nothing_before_it() -> None:
    u = noise(3)
    y = 0.8 * linear.shifted(u, 3) - 0.4 * linear.shifted(u, -2) + 0.01 * noise(4)
    found = linear.correlation_two_sided(u, y, TRAIN)
    response = found.parameters[:-1] * as_given(u, y)
    expected = np.zeros(31)  # lags −10 … 20
    expected[13], expected[8] = 0.8, -0.4
    np.testing.assert_allclose(response, expected, atol=0.005)


def test_the_printed_correlation_model_finds_a_system_of_its_own_kind() -> None:
    u, y = armax_system(noise_size=0.01)
    assert linear.correlation(u, y, TRAIN).fit_test_percent > 97.0


def test_hammerstein_wiener_bends_where_linear_models_cannot() -> None:
    u = lfilter([1.0], [1.0, -0.9], noise(5))
    bent = np.where(u > 0.0, u, 0.3 * u)
    y = lfilter([0.0, 0.5, 0.2], [1.0, -0.4, 0.1, 0.0], bent)
    straight = linear.armax_free_run(u, y, TRAIN)
    found = nonlinear.hammerstein_wiener(u, y, TRAIN)
    assert found.fit_train_percent > 97.0
    assert 100.0 - found.fit_train_percent < 0.5 * (100.0 - straight.fit_train_percent)


def test_nonlinear_arx_follows_a_saturating_system() -> None:
    u = noise(6)
    y = np.zeros(N)
    for t in range(2, N):
        y[t] = 0.5 * y[t - 1] - 0.2 * y[t - 2] + np.tanh(1.5 * u[t - 1])
    assert nonlinear.narx(u, y, TRAIN).fit_test_percent > 90.0
    assert nonlinear.narx_free_run(u, y, TRAIN).fit_test_percent > 90.0
    assert linear.armax(u, y, TRAIN).fit_test_percent < 85.0


def test_the_network_learns_a_function_of_three_samples() -> None:
    u = noise(7)
    y = np.tanh(u) + 0.5 * linear.shifted(u, 1) * linear.shifted(u, 2)
    assert nonlinear.network(u, y, TRAIN).fit_test_percent > 75.0
    assert linear.correlation_two_sided(u, y, TRAIN).fit_test_percent < 60.0


def test_the_networks_derivatives_are_those_of_its_output() -> None:
    rng = np.random.default_rng(8)
    sizes = (3, 8, 4, 1)
    x, v = rng.normal(size=(5, 3)), rng.normal(size=4 * 8 + 9 * 4 + 5)
    by_hand = nonlinear.gradient(v, x, sizes)
    for k in range(0, len(v), 7):
        step = np.zeros(len(v))
        step[k] = 1e-6
        slope = (nonlinear.forward(v + step, x, sizes) - nonlinear.forward(v - step, x, sizes)) / 2e-6
        np.testing.assert_allclose(by_hand[:, k], slope, atol=1e-7)


def test_a_reflected_polynomial_is_stable_and_of_the_same_shape() -> None:
    outside = np.poly([1.25, 0.5])
    reflected = linear.inside(outside)
    np.testing.assert_allclose(np.sort(np.roots(reflected)), [0.5, 0.8])
    q = np.exp(-1j * np.linspace(0.1, 3.0, 9))
    ratio = np.abs(np.polyval(outside, q)) / np.abs(np.polyval(reflected, q))
    np.testing.assert_allclose(ratio, ratio[0])
    assert linear.inside(reflected) is reflected


@pytest.mark.parametrize("name", sorted(METHODS))
def test_the_test_parts_reference_changes_nothing(name: str) -> None:
    """Whatever the reference does after the training part, parameters and prediction stay."""
    u, y = armax_system()
    spoilt = y.copy()
    spoilt[TRAIN:] = 1e3
    one, other = METHODS[name].run(u, y, TRAIN), METHODS[name].run(u, spoilt, TRAIN)
    np.testing.assert_allclose(one.prediction, other.prediction, atol=1e-3)


@pytest.mark.parametrize("name", sorted(METHODS))
def test_unit_and_start_of_the_signals_do_not_matter(name: str) -> None:
    u, y = armax_system()
    one = METHODS[name].run(u, y, TRAIN)
    other = METHODS[name].run(4.0 * u + 64.0, 0.5 * y - 16.0, TRAIN)
    assert other.fit_train_percent == pytest.approx(one.fit_train_percent, abs=0.5)


@pytest.mark.parametrize("name", sorted(METHODS))
def test_poor_data_say_why(name: str) -> None:
    run: Callable[[Floats, Floats, int], Calibration] = METHODS[name].run
    u, y = armax_system()
    broken = u.copy()
    broken[5] = np.nan
    for given, reason in (
        ((np.zeros(0), np.zeros(0), 0), TOO_SHORT),
        ((u[:9], y[:9], 5), TOO_SHORT),
        ((u[:-1], y, TRAIN), NOT_GIVEN),
        ((broken, y, TRAIN), NOT_GIVEN),
        ((np.zeros(N), y, TRAIN), NO_MOVEMENT),
        ((u, np.ones(N), TRAIN), NO_MOVEMENT),
    ):
        found = run(*given)
        assert found.reason == reason
        assert np.isnan(found.prediction).all()
        assert np.isnan(found.fit_train_percent)


def test_without_a_test_part_its_fit_is_not_determinable() -> None:
    u, y = armax_system()
    found = linear.armax(u[:TRAIN], y[:TRAIN], TRAIN)
    assert found.fit_train_percent > 90.0
    assert np.isnan(found.fit_test_percent)


def test_a_run_that_runs_away_gives_nothing() -> None:
    u, y = armax_system()
    found = calibration(u, y, TRAIN, 1, lambda u, y, train: (np.zeros(1), np.full(len(u), 1e9)))
    assert "runs away" in found.reason
    assert np.isnan(found.prediction).all()


def test_pairs_of_a_simulated_foot_against_its_own_path_agree() -> None:
    motion = analysed().gait.feet[Side.LEFT].motion
    path = motion.position_m.copy()
    path[: motion.rests.end[0]] = np.nan
    path[len(path) // 2 - 100 :] = np.nan  # the way out
    pairs = {pair.name: pair for pair in calibration_pairs(motion, path)}
    assert set(pairs) == {"position", "stride", "acceleration"}
    stride = pairs["stride"]
    assert goodness_of_fit(stride.reference, stride.measured) > 90.0
    assert stride.reference[0] == 0.0
    assert 0.5 < np.ptp(stride.reference) < 2.5


def test_pairs_need_a_stretch_in_sight() -> None:
    motion = analysed().gait.feet[Side.LEFT].motion
    assert calibration_pairs(motion, np.full((motion.n_samples, 3), np.nan)) == ()
    assert calibration_pairs(motion, np.zeros((motion.n_samples, 3))) == ()


def test_a_real_foot_beside_cameras_is_calibrated_on_the_first_half_of_its_walk(data_dir: Path) -> None:
    """The drift of two plain integrations: at least half of what is left without a model is gone in the second half."""
    folder = data_dir / "mtw-leg-vicon"
    recording = read_recording(placements={Placement.LEFT_FOOT: sensors_of(folder)["left_foot"]})
    motion = analyze(recording).gait.feet[Side.LEFT].motion
    optical = read_optical(folder / "vicon-left-leg.csv", recording, Side.LEFT)["MIDFOOT"]
    pairs = {pair.name: pair for pair in calibration_pairs(motion, optical.at(motion.time_s))}
    position, acceleration = pairs["position"], pairs["acceleration"]
    half = len(position.reference) // 2
    plain = goodness_of_fit(position.reference[half:], position.measured[half:])
    for run in (linear.armax_free_run, linear.box_jenkins_free_run, nonlinear.hammerstein_wiener):
        found = run(position.measured, position.reference, half)
        assert found.fit_train_percent > 97.0
        assert 100.0 - found.fit_test_percent < 0.6 * (100.0 - plain)
    found = linear.correlation_two_sided(acceleration.measured, acceleration.reference, half)
    assert found.fit_train_percent > 85.0
    assert found.fit_test_percent > 80.0
