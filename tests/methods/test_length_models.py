"""Step-length models: each equation against a value worked by hand, and what they say where they know nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.methods.length_factors import Factors
from gaitlab.methods.length_models import METHODS
from gaitlab.methods.length_parts import NO_SAMPLES, NO_TIME, STILL
from gaitlab.methods.length_sun2015 import FAST, METHOD, NO_ROOT, SLOW
from gaitlab.methods.model import Lengths, Need
from gaitlab.methods.steps_signals import Person, Sex, StepSignals

NAMES = {
    "constant",
    "height",
    "weinberg",
    "kim",
    "scarlett",
    "xu",
    "frequency_linear",
    "frequency_nonlinear",
    "shin",
    "bylemans",
    "sun2015",
    "gaitlab",
}
MODELS = {method.name: method for method in (*METHODS, METHOD)}
SET = Factors(k=1.0, a=0.004, b=0.2, c=0.3, normal_spm=100.0)


def one_step(
    max_g: float = 0.5,
    min_g: float = -0.3,
    mean_abs_g: float = 0.2,
    variance_g2: float = 0.05,
    frequency_spm: float = 120.0,
    *,
    steps_each: int = 1,
) -> StepSignals:
    values = (max_g, min_g, mean_abs_g, variance_g2, frequency_spm, 60000.0 / frequency_spm)
    arrays = [np.array([value]) for value in values]
    return StepSignals(
        np.array([0.0]), np.array([0.5]), *arrays, steps_each=steps_each, own_m=np.array([1.4])
    )


def length(name: str, steps: StepSignals, factors: Factors = SET, person: Person | None = None) -> float:
    return float(MODELS[name].run(steps, person or Person(1.80, Sex.MALE), factors).length_m[0])


def test_the_ten_models_of_others_the_papers_own_and_ours_are_there() -> None:
    assert set(MODELS) == NAMES


@pytest.mark.parametrize(
    ("name", "by_hand"),
    [
        ("constant", 0.70),
        ("height", 0.747),  # 0.415 · 1.80
        ("weinberg", 0.945742),  # 0.8^(1/4)
        ("kim", 0.584804),  # 0.2^(1/3)
        ("scarlett", 0.625),  # (0.2 + 0.3) / 0.8
        ("xu", 1.745742),  # 0.8 + 0.8^(1/4)
        ("frequency_linear", 0.68),  # 0.004 · 120 + 0.2
        ("frequency_nonlinear", 0.70 * 1.2898),  # 1.5 · 1.44 − 1.8475 · 1.2 + 1.3468
        ("shin", 0.79),  # 0.004 · 120 + 0.2 · 0.05 + 0.3
        ("bylemans", 0.1 * 0.550963 * 0.236435),  # 0.2^(1/2.7) · √(1/(√500 · 0.8))
    ],
)
def test_each_equation_gives_the_value_worked_by_hand(name: str, by_hand: float) -> None:
    assert length(name, one_step()) == pytest.approx(by_hand, rel=2e-6)


def test_a_woman_is_counted_by_her_own_share_of_height() -> None:
    assert length("height", one_step(), person=Person(1.70, Sex.FEMALE)) == pytest.approx(0.413 * 1.70)


def test_the_papers_own_model_below_its_branch_by_hand() -> None:
    # f = 100: a = 0.545 − 0.501 + 0.15495 = 0.19895, b = −0.461 + 0.404 − 0.130 = −0.187,
    # c = 0.102 − 0.0913 + 0.0336 = 0.0443
    # v = 0.02: b² − 4a(c − v) = 0.034969 − 0.7958 · 0.0243 = 0.01563106; s = (0.187 + 0.1250242)/0.3979
    steps = one_step(variance_g2=0.02, frequency_spm=100.0)
    assert length("sun2015", steps) == pytest.approx(0.784178, abs=2e-6)


def test_the_papers_own_model_above_its_branch_by_hand() -> None:
    # f = 150: a = 4.005 − 9.195 + 5.381 = 0.191, b = −3.9825 + 9.105 − 5.272 = −0.1495, c = 0.95175 − 2.175 + 1.248 = 0.02475
    # v = 0.03: b² − 4a(c − v) = 0.02235025 + 0.764 · 0.00525 = 0.02636125; s = (0.1495 + 0.1623615)/0.382
    steps = one_step(variance_g2=0.03, frequency_spm=150.0)
    assert length("sun2015", steps) == pytest.approx(0.816391, abs=2e-6)


def test_the_two_branches_do_not_meet() -> None:
    assert length("sun2015", one_step(variance_g2=0.01, frequency_spm=139.0)) == pytest.approx(
        0.58, abs=0.005
    )
    assert length("sun2015", one_step(variance_g2=0.01, frequency_spm=140.0)) == pytest.approx(
        0.65, abs=0.005
    )


def test_the_root_solves_the_papers_quadratic_relation() -> None:
    for spm in (60.0, 85.0, 110.0, 139.0, 140.0, 165.0, 180.0):
        for variance in (0.02, 0.1, 0.4):
            s = length("sun2015", one_step(variance_g2=variance, frequency_spm=spm))
            a, b, c = (FAST if spm >= 140.0 else SLOW).at(np.array([spm]))
            assert float(a[0] * s**2 + b[0] * s + c[0]) == pytest.approx(variance, rel=1e-9)
            assert float(a[0]) > 0.0


def test_table_one_does_not_lead_to_the_printed_coefficients() -> None:
    """Eq. 11 on the relations of table I, at 110 steps/min: a is negative, where eq. 12 has 0.263."""
    table = np.array(
        [
            [1.61e-8, 0.0000203, -0.000768],
            [1.52e-8, 0.0000344, -0.00141],
            [0.00000221, 0.000293, -0.0113],
            [0.00000650, -0.000951, 0.0386],
            [0.00000826, -0.000888, 0.0287],
            [0.0000128, -0.00131, 0.0407],
        ]
    )
    a = np.polyfit(np.arange(0.4, 0.95, 0.1), np.polyval(table.T, 110.0), 2)[0]
    assert a == pytest.approx(-0.0162, abs=1e-4)


def test_a_variance_below_the_parabola_has_no_length_and_says_so() -> None:
    lengths = MODELS["sun2015"].run(one_step(variance_g2=0.0001, frequency_spm=70.0), Person(), SET)
    assert np.isnan(lengths.length_m[0])
    assert lengths.reason == (NO_ROOT,)
    assert not lengths.known[0]


@pytest.mark.parametrize(
    ("variance", "spm", "outside"),
    [(0.02, 100.0, False), (0.02, 55.0, True), (0.02, 185.0, True), (0.4, 100.0, True)],
)
def test_what_the_model_was_not_fitted_on_is_marked(variance: float, spm: float, outside: bool) -> None:
    lengths = MODELS["sun2015"].run(one_step(variance_g2=variance, frequency_spm=spm), Person(), SET)
    assert bool(lengths.outside[0]) is outside


@pytest.mark.parametrize(
    "name", sorted(NAMES - {"height", "frequency_linear", "shin", "gaitlab", "bylemans"})
)
def test_the_factor_k_scales_the_length(name: str) -> None:
    assert length(name, one_step(), Factors(k=0.5, normal_spm=100.0)) == pytest.approx(
        0.5 * length(name, one_step())
    )


def test_bylemans_k_stands_under_a_root() -> None:
    assert length("bylemans", one_step(), Factors(k=4.0)) == pytest.approx(
        2.0 * length("bylemans", one_step())
    )


@pytest.mark.parametrize("name", sorted(NAMES - {"gaitlab"}))
def test_a_stride_is_as_long_as_two_of_its_steps(name: str) -> None:
    assert length(name, one_step(steps_each=2)) == pytest.approx(2.0 * length(name, one_step()))


def test_the_inertial_path_is_taken_as_it_is() -> None:
    assert length("gaitlab", one_step(steps_each=2)) == pytest.approx(1.4)


FEEL = sorted(name for name in NAMES - {"gaitlab"} if Need.ACCELEROMETER in MODELS[name].needs)


@pytest.mark.parametrize("name", FEEL)
def test_a_step_without_any_movement_has_no_length(name: str) -> None:
    lengths: Lengths = MODELS[name].run(one_step(0.0, 0.0, 0.0, 0.0), Person(), SET)
    assert np.isnan(lengths.length_m[0])
    assert lengths.reason == (STILL,)


@pytest.mark.parametrize("name", FEEL)
def test_a_step_without_samples_has_no_length(name: str) -> None:
    nothing = float("nan")
    lengths: Lengths = MODELS[name].run(one_step(nothing, nothing, nothing, nothing), Person(), SET)
    assert lengths.reason == (NO_SAMPLES,)


@pytest.mark.parametrize("name", ["frequency_linear", "frequency_nonlinear", "shin", "bylemans", "sun2015"])
def test_a_step_that_takes_no_time_has_no_length(name: str) -> None:
    lengths: Lengths = MODELS[name].run(one_step(frequency_spm=float("nan")), Person(), SET)
    assert lengths.reason == (NO_TIME,)


@pytest.mark.parametrize("name", ["frequency_linear", "shin"])
def test_linear_models_want_a_test_walk(name: str) -> None:
    lengths: Lengths = MODELS[name].run(one_step(), Person(), Factors())
    assert "known length" in lengths.reason[0]


def test_height_and_sex_are_asked_for_by_name() -> None:
    assert "height" in MODELS["height"].run(one_step(), Person(None, Sex.MALE), SET).reason[0]
    assert "height" in MODELS["height"].run(one_step(), Person(float("nan"), Sex.MALE), SET).reason[0]
    assert "sex" in MODELS["height"].run(one_step(), Person(1.7), SET).reason[0]


@pytest.mark.parametrize("name", sorted(NAMES))
def test_no_steps_give_no_lengths(name: str) -> None:
    none = np.zeros(0)
    lengths = MODELS[name].run(
        StepSignals(none, none, none, none, none, none, none, none, own_m=none), Person(1.8, Sex.MALE), SET
    )
    assert len(lengths.length_m) == len(lengths.reason) == len(lengths.outside) == 0


def test_frequency_models_mark_uncommon_gaits() -> None:
    for name in ("frequency_linear", "frequency_nonlinear"):
        assert MODELS[name].run(one_step(frequency_spm=130.0), Person(), SET).outside[0]
        assert not MODELS[name].run(one_step(frequency_spm=100.0), Person(), SET).outside[0]


@pytest.mark.parametrize("name", sorted(NAMES))
@pytest.mark.parametrize(
    "lost", ["max_g", "min_g", "mean_abs_g", "variance_g2", "frequency_spm", "duration_ms", "own_m"]
)
def test_a_length_is_a_number_or_has_a_reason(name: str, lost: str) -> None:
    steps = replace(one_step(), **{lost: np.array([np.nan])})
    lengths: Lengths = MODELS[name].run(steps, Person(1.8, Sex.MALE), SET)
    assert np.isfinite(lengths.length_m[0]) == (lengths.reason[0] == "")
