"""Signals of steps, factors from walks of known length, and errors by class of length."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gaitlab.analysis import analyze
from gaitlab.methods.length_factors import (
    Factors,
    KnownWalk,
    by_class,
    calibrate,
    distance_m,
    leave_one_out,
)
from gaitlab.methods.length_models import METHODS
from gaitlab.methods.length_sun2015 import METHOD
from gaitlab.methods.model import Lengths
from gaitlab.methods.steps_signals import Person, Sex, StepSignals, step_signals, stride_signals
from gaitlab.methods.view import foot_view
from gaitlab.motion.free import free_motion
from gaitlab.recording import Placement, Recording, Side, read_recording
from gaitlab.validation.leg_vicon_check import sensors_of
from gaitlab.validation.truth import OpticalPath
from tests.walks import analysed, out_and_back, turned

G = 9.80665
MODELS = {method.name: method for method in (*METHODS, METHOD)}
CALIBRATED = sorted(set(MODELS) - {"height", "gaitlab"})
NOBODY = Person()


def strides(recording: Recording, side: Side = Side.LEFT) -> StepSignals:
    foot = analyze(recording).gait.feet[side]
    signals = stride_signals(foot_view(recording.sensors[Placement.foot(side)], foot.motion))
    return signals.only(foot.walking & ~foot.turning)


def some_walks() -> list[KnownWalk]:
    """Five walks at different pace."""
    rng = np.random.default_rng(5)
    walks = []
    for spm in (80.0, 90.0, 100.0, 115.0, 125.0):
        f = spm + rng.normal(0.0, 2.0, 20)
        v = 0.02 + 0.0005 * (f - 70.0) + rng.normal(0.0, 0.002, 20) + rng.normal(0.0, 0.01)
        swing = 4.0 * np.sqrt(v)
        zero = np.zeros(20)
        steps = StepSignals(zero, zero, 0.6 * swing, -0.4 * swing, 0.2 * swing, v, f, 60000.0 / f)
        walks.append(KnownWalk(steps, float(np.sum(0.004 * f + 1.5 * v + 0.2))))
    return walks


def test_signals_of_a_sine_are_those_worked_by_hand() -> None:
    time_s = np.arange(200) / 100.0
    vertical = 2.0 * G * np.sin(2.0 * np.pi * time_s / 0.5)  # whole periods in each half second
    signals = step_signals(vertical, time_s, np.array([0.0, 0.5]), np.array([0.5, 1.0]))
    np.testing.assert_allclose(signals.max_g, 2.0, rtol=3e-3)
    np.testing.assert_allclose(signals.min_g, -2.0, rtol=3e-3)
    np.testing.assert_allclose(signals.mean_abs_g, 4.0 / np.pi, rtol=3e-3)
    np.testing.assert_allclose(signals.variance_g2, 2.0, rtol=1e-9)
    np.testing.assert_allclose(signals.frequency_spm, 120.0)
    np.testing.assert_allclose(signals.duration_ms, 500.0)


def test_a_stride_counts_as_two_steps() -> None:
    time_s = np.arange(200) / 100.0
    signals = step_signals(np.sin(time_s), time_s, np.array([0.0]), np.array([1.2]), steps_each=2)
    assert signals.frequency_spm[0] == pytest.approx(100.0)  # 120 / 1.2
    assert signals.duration_ms[0] == pytest.approx(600.0)


def test_steps_need_not_follow_each_other_and_may_end_with_the_rows() -> None:
    time_s = np.arange(10.0)
    vertical = G * time_s
    start, end = np.array([6.0, 1.0, 9.0, 20.0]), np.array([12.0, 3.0, 10.0, 30.0])
    signals = step_signals(vertical, time_s, start, end)
    np.testing.assert_allclose(signals.max_g, [9.0, 2.0, 9.0, np.nan])
    np.testing.assert_allclose(signals.min_g, [6.0, 1.0, 9.0, np.nan])
    np.testing.assert_allclose(signals.variance_g2, [1.25, 0.25, 0.0, np.nan], atol=1e-12)


def test_no_steps_no_samples_and_no_time_are_no_errors() -> None:
    none = np.zeros(0)
    assert len(step_signals(none, none, none, none)) == 0
    empty = step_signals(none, none, np.array([0.0]), np.array([0.0]))
    assert np.isnan(empty.max_g[0])
    assert np.isnan(empty.frequency_spm[0])


def test_a_constant_offset_of_the_acceleration_leaves_variance_and_range() -> None:
    time_s = np.arange(100) / 100.0
    wave = np.random.default_rng(1).normal(0.0, 3.0, 100)
    plain = step_signals(wave, time_s, np.array([0.1]), np.array([0.9]))
    shifted = step_signals(wave + 1000.0, time_s, np.array([0.1]), np.array([0.9]))
    np.testing.assert_allclose(shifted.variance_g2, plain.variance_g2, rtol=1e-9)
    np.testing.assert_allclose(shifted.range_g, plain.range_g, rtol=1e-9)


@pytest.mark.parametrize("name", CALIBRATED)
def test_a_calibrated_model_gives_the_known_distance_of_its_own_walks(name: str) -> None:
    walks = some_walks()
    factors = calibrate(MODELS[name], walks, NOBODY)
    found = sum(distance_m(MODELS[name].run(walk.steps, NOBODY, factors)) for walk in walks)
    assert found == pytest.approx(sum(walk.length_m for walk in walks), rel=1e-6)


def test_factors_of_a_walker_who_obeys_the_linear_model_are_recovered() -> None:
    factors = calibrate(MODELS["shin"], some_walks(), NOBODY)
    assert (factors.a, factors.b, factors.c) == pytest.approx((0.004, 1.5, 0.2), rel=1e-6)


@pytest.mark.parametrize("name", ["frequency_linear", "shin"])
def test_walks_that_tell_no_slope_give_none(name: str) -> None:
    """One walk, or five of one pace whose lengths differ by chance: the mean step is all that is known."""
    walk = some_walks()[0]
    alike = [KnownWalk(walk.steps, walk.length_m * (1.0 + 0.01 * i)) for i in range(5)]
    for walks in ([walk], alike):
        factors = calibrate(MODELS[name], walks, NOBODY)
        assert factors.a == pytest.approx(0.0, abs=1e-12)
        mean = np.mean([one.length_m for one in walks]) / len(walk.steps)
        assert MODELS[name].run(walk.steps, NOBODY, factors).length_m == pytest.approx(mean)


@pytest.mark.parametrize("name", sorted(MODELS))
def test_leaving_a_walk_out_never_uses_its_length(name: str) -> None:
    """A walk whose length was measured twice as long is off by half; the errors of the model itself stay."""
    walks, person = some_walks(), Person(1.75, Sex.FEMALE)
    doubled = [*walks[:-1], KnownWalk(walks[-1].steps, 2.0 * walks[-1].length_m)]
    plain = leave_one_out(MODELS[name], walks, person)[-1]
    told_twice = leave_one_out(MODELS[name], doubled, person)[-1]
    if name == "gaitlab":  # these walks have no path
        assert np.isnan(plain)
    else:
        assert 2.0 * (1.0 + told_twice) == pytest.approx(1.0 + plain)


def test_a_walk_without_others_or_without_steps_leaves_no_error() -> None:
    walk = some_walks()[0]
    assert np.isnan(leave_one_out(MODELS["kim"], [walk], NOBODY)).all()
    empty = KnownWalk(walk.steps.only(np.zeros(len(walk.steps), dtype=np.bool_)), 10.0)
    assert calibrate(MODELS["kim"], [empty], NOBODY) == Factors()
    assert calibrate(MODELS["shin"], [], NOBODY).k == 1.0


def test_steps_that_are_not_determinable_count_as_the_mean_of_the_others() -> None:
    lengths = Lengths(np.array([0.6, np.nan, 0.8]), ("", "why", ""), np.zeros(3, dtype=np.bool_))
    assert distance_m(lengths) == pytest.approx(2.1)
    assert np.isnan(distance_m(Lengths(np.array([np.nan]), ("why",), np.zeros(1, dtype=np.bool_))))


def test_errors_by_class_are_those_worked_by_hand() -> None:
    real = np.array([0.45, 0.50, 0.55, 0.75, 1.50, 0.65])
    estimated = np.array([0.54, 0.53, 0.51, 0.75, 1.20, np.nan])
    classes = by_class(estimated, real)
    assert [one.n for one in classes] == [1, 2, 0, 1, 0, 0, 5]
    assert classes[0].rmse_m == pytest.approx(0.09)
    assert classes[0].deviation_percent == pytest.approx(20.0)
    assert classes[1].rmse_m == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 2))
    assert classes[1].deviation_percent == pytest.approx(100.0 * (0.03 / 0.5 + 0.04 / 0.55) / 2)
    assert np.isnan(classes[2].rmse_m)
    assert classes[-1].rmse_m == pytest.approx(np.sqrt((0.09**2 + 0.03**2 + 0.04**2 + 0.3**2) / 5))


def test_the_strides_of_a_simulated_walk_are_long_by_every_model() -> None:
    """Calibrated on one foot's way of about 20 m, each model gives that foot's strides within a third."""
    walk = out_and_back()
    foot = analysed().gait.feet[Side.LEFT]
    signals = stride_signals(foot_view(walk.recording.sensors[Placement.LEFT_FOOT], foot.motion))
    straight = signals.only(foot.steady)
    assert straight.own_m == pytest.approx(foot.length_m[foot.steady], rel=0.02)
    assert straight.frequency_spm == pytest.approx(120.0 / (foot.end_s - foot.start_s)[foot.steady])
    known = KnownWalk(straight, float(foot.length_m[foot.steady].sum()))
    for name in sorted(set(MODELS) - {"height"}):
        factors = calibrate(MODELS[name], [known], NOBODY)
        lengths = MODELS[name].run(straight, NOBODY, factors)
        assert lengths.known.all(), (name, lengths.reason)
        np.testing.assert_allclose(lengths.length_m, foot.length_m[foot.steady], rtol=0.33, err_msg=name)


def test_turning_the_sensor_on_the_foot_changes_no_signal() -> None:
    recording = out_and_back().recording
    quarter = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    sensors = {p: turned(s, quarter) for p, s in recording.sensors.items() if p.is_foot}
    plain = {p: replace(s, mag=None) for p, s in recording.sensors.items() if p.is_foot}
    one, other = strides(Recording(plain)), strides(Recording(sensors))
    for name in ("max_g", "min_g", "mean_abs_g", "variance_g2", "frequency_spm"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=0.01, atol=0.01)


def test_models_on_real_walks_of_one_person(data_dir: Path) -> None:
    """Four trials of ten metres and back: distance of each by the factors of the other three, within a sixth."""
    walks = []
    folder = data_dir / "mtw-10m-walk"
    for trial in (1, 2, 3, 4):
        files = {Placement.foot(side): folder / f"1-{trial}_{side.value[0]}f.txt" for side in Side}
        recording = read_recording(placements=files)
        foot = analyze(recording).gait.feet[Side.LEFT]
        signals = stride_signals(foot_view(recording.sensors[Placement.LEFT_FOOT], foot.motion))
        walks.append(KnownWalk(signals.only(foot.walking), 20.0))
    for name in sorted(set(MODELS) - {"height"}):
        errors = leave_one_out(MODELS[name], walks, Person(1.75, Sex.FEMALE))
        assert np.abs(errors).max() < 1.0 / 6.0, (name, errors)


def test_a_sensor_on_the_pelvis_feels_every_step(data_dir: Path) -> None:
    """Nearer to what the models were made for: steps between the feet's contacts, against the pelvis under cameras."""
    folder = data_dir / "mtw-leg-vicon"
    files = sensors_of(folder)
    (pelvis_file,) = folder.glob("*00B40B91*")
    feet = {Placement.foot(side): files[f"{side}_foot"] for side in Side}
    recording = read_recording(placements={**feet, Placement.LEFT_KNEE: pelvis_file})
    pelvis = free_motion(recording.sensors[Placement.LEFT_KNEE], recording.time_s(Placement.LEFT_KNEE))
    gait = analyze(Recording({place: recording.sensors[place] for place in feet})).gait
    contacts = np.sort(np.concatenate([foot.events.initial_contact_s for foot in gait.feet.values()]))
    steps = step_signals(pelvis.acceleration_mps2[:, 2], pelvis.time_s, contacts[:-1], contacts[1:])

    table = np.genfromtxt(folder / "vicon-left-leg.csv", delimiter=",", names=True)
    place = np.stack([table[f"PELV_{axis}"] for axis in (1, 2, 3)], axis=1)
    optical = OpticalPath(recording.time_s(Placement.LEFT_FOOT)[table["row"].astype(int)], place)
    real = optical.horizontal_length(steps.start_s, steps.end_s)
    walked = np.isfinite(real) & (real > 0.4)
    steps, real = steps.only(walked), real[walked]
    assert len(real) == 10
    assert np.all(
        (steps.variance_g2 > 0.005) & (steps.variance_g2 < 0.05)
    )  # the paper's fig. 3 and 6 are of this size

    known = KnownWalk(steps, float(real.sum()))
    assert 0.6 < calibrate(METHOD, [known], NOBODY).k < 0.9
    for name in sorted(set(MODELS) - {"height", "gaitlab"}):
        lengths = MODELS[name].run(steps, NOBODY, calibrate(MODELS[name], [known], NOBODY))
        assert by_class(lengths.length_m, real)[-1].deviation_percent < 18.0, name
