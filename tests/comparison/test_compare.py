"""The catalogue as a whole on a simulated and on a real walk."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from gaitlab.analysis import analyze
from gaitlab.comparison import Comparison, cohort, compare, to_json, to_text
from gaitlab.comparison.inputs import inputs_of
from gaitlab.comparison.model import is_ours
from gaitlab.errors import InputError
from gaitlab.methods.catalogue import catalogue, method, of
from gaitlab.methods.length_factors import KnownWalk, calibrate, distance_m
from gaitlab.methods.model import Method, Need, Question
from gaitlab.methods.steps_signals import Person, Sex, stride_signals
from gaitlab.recording import Placement, Recording, Sensor, Side, read_recording
from gaitlab.recording.model import Floats
from gaitlab.report.figures.methods import comparison_figures
from tests.walks import cut, out_and_back, without

PERSON = Person(1.75, Sex.MALE)
KNEES = (Placement.LEFT_KNEE, Placement.RIGHT_KNEE)


@cache
def simulated() -> Comparison:
    """Ten metres and back, shanks worn; the true length of what each foot walked is told."""
    walk = out_and_back()
    return compare(walk.recording, None, true_length_m(), PERSON)


@cache
def true_length_m() -> float:
    truth = out_and_back().truth.feet
    return float(np.mean([foot.stride_length_m.sum() for foot in truth.values()]))


def leg(data_dir: Path) -> Recording:
    folder = data_dir / "mtw-leg-vicon"
    devices = {
        Placement.LEFT_FOOT: "00B40C55",
        Placement.RIGHT_FOOT: "00B40C48",
        Placement.LEFT_KNEE: "00B40C45",
        Placement.RIGHT_KNEE: "00B40C3C",
    }
    return read_recording(placements={p: next(folder.glob(f"*{d}.txt")) for p, d in devices.items()})


def check_whole(found: Comparison, given: set[Need]) -> None:
    """Every method of the catalogue has its line: answers, or the name of what is missing; none has failed."""
    assert sum(len(table.lines) for table in found.tables) == len(catalogue())
    for table in found.tables:
        assert is_ours(table.lines[0].method) or not any(is_ours(line.method) for line in table.lines)
        for line in table.lines:
            name = f"{table.question}: {line.method.name}"
            assert not line.failed, name
            lacking = [need for need in line.method.needs if need not in given]
            if lacking:
                assert not line.answers, name
                assert all(need in line.reason for need in lacking), name
            else:
                assert line.reason == "", name
                assert any(answer.values for answer in line.answers), name
                assert all(answer.values or answer.reason for answer in line.answers), name
                assert (line.difference is None) == (
                    is_ours(line.method) or table.question is Question.POSTURE
                ), name


def test_every_method_runs_on_a_simulated_walk_or_says_what_is_missing() -> None:
    given = {Need.ACCELEROMETER, Need.GYROSCOPE, Need.KNEE, Need.BOTH_FEET}
    given |= {Need.KNOWN_LENGTH, Need.BODY_HEIGHT, Need.SEX}
    recording = out_and_back().recording
    given |= {Need.MAGNETOMETER} if recording.sensors[Placement.LEFT_FOOT].mag is not None else set()
    check_whole(simulated(), given)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_every_method_runs_on_a_real_walk_with_thighs(data_dir: Path) -> None:
    given = set(Need) - {Need.REFERENCE, Need.PRESSURE, Need.KNOWN_LENGTH}
    check_whole(compare(leg(data_dir), None, None, PERSON), given)


def test_what_each_method_lacks_is_named() -> None:
    found = compare(without(out_and_back().recording, *KNEES, Placement.RIGHT_FOOT))
    assert found.table(Question.KNEE).line("gaitlab").reason == "Missing: sensor on shank or thigh."
    assert found.table(Question.THIGH).line("gaitlab_thigh").reason == "Missing: sensor on the thigh."
    assert found.table(Question.LENGTH).line("weinberg").reason == "Missing: a walk of known length."
    height = found.table(Question.LENGTH).line("height").reason
    assert height == "Missing: the person's height, the person's sex."
    assert found.table(Question.HEIGHT).line("feliz2009_barometric").reason == "Missing: barometer."
    assert [one.side for one in found.table(Question.REST).line("feliz2009").answers] == [Side.LEFT]


def test_ours_agrees_with_itself_and_with_the_analysis() -> None:
    found = simulated()
    for side, foot in found.analysis.gait.feet.items():
        values = {v.name: v.value for v in found.table(Question.POSITION).line("gaitlab").answer(side).values}  # type: ignore[union-attr]
        assert values["path"] == pytest.approx(foot.length_m.sum(), abs=1e-9)
        assert values["RMS to ours"] == pytest.approx(0.0, abs=1e-9)
        rests = found.table(Question.REST).line("gaitlab").answer(side)
        assert rests is not None
        assert rests.values[0].value == rests.values[1].value == len(foot.motion.rests)


def test_factors_from_the_known_length_make_the_models_sum_to_it() -> None:
    for line in simulated().table(Question.LENGTH).lines:
        if Need.KNOWN_LENGTH in line.method.needs:
            sums = [v.value for answer in line.answers for v in answer.values if v.name == "sum"]
            assert np.mean(sums) == pytest.approx(true_length_m(), rel=1e-6), line.method.name


def test_ours_lies_within_the_interval_of_a_method_that_measures_the_same() -> None:
    """On a walk without tricks zero velocity at every stance and our smoother differ by a centimetre a stride at most."""
    difference = simulated().table(Question.POSITION).line("jimenez2009_zupt").difference
    assert difference is not None
    assert difference.n > 30
    assert abs(difference.mean) < 1.0


def test_pictures_have_a_path_of_every_position_method_and_lengths_of_every_model() -> None:
    found = simulated()
    for side in Side:
        assert {one.method for one in found.paths if one.side is side} == {
            m.name for m in of(Question.POSITION)
        }
        assert {one.method for one in found.lengths if one.side is side} == {
            m.name for m in of(Question.LENGTH)
        }
    assert all(one.place_m.shape == (len(one.place_m), 2) for one in found.paths)
    assert all(len(one.length_m) == len(one.ours_m) for one in found.lengths)


def test_only_the_methods_asked_for_run_and_ours_beside_them() -> None:
    recording = without(out_and_back().recording, *KNEES)
    found = compare(recording, names=["weinberg", "jimenez2009_gyroscope"], known_length_m=20.0)
    names = {table.question: [line.method.name for line in table.lines] for table in found.tables}
    assert names == {
        Question.STEP: ["gaitlab", "jimenez2009_gyroscope"],
        Question.LENGTH: ["gaitlab", "weinberg"],
    }


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({"names": ["nothing"]}, "unknown_method"),
        ({"known_length_m": 0.0}, "known_length"),
        ({"known_length_m": float("nan")}, "known_length"),
        ({"person": Person(17.5)}, "height"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_runs(given: dict[str, object], code: str) -> None:
    with pytest.raises(InputError) as refused:
        compare(out_and_back().recording, **given)  # type: ignore[arg-type]
    assert refused.value.code == code


def test_a_method_that_breaks_is_said_and_hides_no_other(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    methods = catalogue()
    key = (Question.REST, "feliz2009")
    one: Method = replace(methods[key], run=broken)
    monkeypatch.setattr("gaitlab.comparison.comparing.catalogue", lambda: {**methods, key: one})
    found = compare(without(out_and_back().recording, *KNEES))
    line = found.table(Question.REST).line("feliz2009")
    assert line.failed
    assert "ZeroDivisionError" in line.reason
    assert found.table(Question.REST).line("jimenez2009_rest").answers
    assert "feliz2009" in caplog.text


def odd(kind: str) -> Recording:
    """The simulated walk with something wrong with it."""
    walk = out_and_back().recording
    noise = np.random.default_rng(1).normal
    change: dict[str, Callable[[Sensor], Sensor]] = {
        "standing": lambda s: cut(s, 0, 300),
        "two steps": lambda s: cut(s, 350, 650),
        "begins in the walk": lambda s: cut(s, 700, 1300),
        "clipped": lambda s: replace(s, acc_mps2=np.clip(acc(s), -12.0, 12.0)),
        "still gyroscope": lambda s: replace(s, gyr_radps=np.zeros_like(acc(s))),
        "noise": lambda s: replace(s, acc_mps2=acc(s) + noise(size=acc(s).shape) * 5.0),
        "constant field": lambda s: replace(s, mag=np.ones_like(acc(s))),
        "noisy barometer": lambda s: replace(s, pressure_pa=101325.0 + noise(size=s.n_samples)),
    }
    return Recording({p: change[kind](s) for p, s in walk.sensors.items()}, walk.findings)


def acc(sensor: Sensor) -> Floats:
    assert sensor.acc_mps2 is not None
    return sensor.acc_mps2


@pytest.mark.parametrize(
    "kind",
    [
        "standing",
        "two steps",
        "begins in the walk",
        "clipped",
        "still gyroscope",
        "noise",
        "constant field",
        "noisy barometer",
    ],
)
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_poor_recordings_break_no_method_and_no_picture(kind: str) -> None:
    found = compare(odd(kind), None, 20.0, PERSON)
    assert not [line.method.name for table in found.tables for line in table.lines if line.failed]
    assert to_text(found)
    assert json.loads(to_json(found))
    for figure in comparison_figures(found):
        assert b"nan" not in figure.svg.lower()


def test_a_file_with_an_orientation_instead_of_a_gyroscope_has_angular_rates() -> None:
    analysed = simulated().analysis
    sensors = {
        Placement.foot(side): replace(
            analysed.recording.sensors[Placement.foot(side)], gyr_radps=None, attitude=foot.motion.attitude
        )
        for side, foot in analysed.gait.feet.items()
    }
    found = compare(Recording(sensors, ()))
    assert found.table(Question.REST).line("feliz2009").answers


def test_figures_draw_every_method_and_say_which_path_leaves_the_picture() -> None:
    found = simulated()
    figures = {figure.name: figure for figure in comparison_figures(found)}
    assert list(figures) == [
        "methods_left_foot",
        "methods_right_foot",
        "methods_lengths",
        "methods_agreement",
    ]
    for name in ("methods_left_foot", "methods_right_foot"):
        assert all(m.name in figures[name].svg.decode() for m in of(Question.POSITION))
        assert "leave" not in figures[name].caption or "ikizoglu2018" in figures[name].caption
    for m in of(Question.LENGTH):
        assert m.name in figures["methods_lengths"].svg.decode()
        assert (m.name in figures["methods_agreement"].svg.decode()) == (m.name != "gaitlab")
    far = replace(found.paths[0], method="far", place_m=np.array([[0.0, 0.0], [500.0, 0.0]]))
    left = comparison_figures(replace(found, paths=(*found.paths, far)))[0]
    assert "far" in left.caption.split("stances.")[1]
    assert len(left.svg) < 100_000


def test_text_and_json_say_the_same() -> None:
    found = simulated()
    text, document = to_text(found), json.loads(to_json(found))
    for table in found.tables:
        lines = document["questions"][table.question.value]
        assert [one["method"] for one in lines] == [line.method.name for line in table.lines]
        for line in table.lines:
            assert line.method.name in text
            assert line.reason in text
    assert len(document["paths"]) == len(found.paths)


def test_a_cohort_has_mean_deviation_and_error_of_each_method() -> None:
    """Equations 4 to 6 by hand, and the step-length models by the factors of the other walk."""
    first = without(out_and_back().recording, *KNEES)
    second = without(out_and_back(seed=4).recording, *KNEES)
    known = true_length_m()

    def broken() -> Recording:
        raise InputError("no_file", "There is none.")

    found = cohort([("a", lambda: first), ("b", lambda: second), ("c", broken)], known)
    lengths = np.array([foot.length_m.sum() for r in (first, second) for foot in _feet(r)])
    row = found.row(Question.POSITION, "gaitlab")
    assert (row.n, row.of) == (4, 4)
    assert row.mean_m == pytest.approx(lengths.mean(), abs=1e-9)
    assert row.sd_m == pytest.approx(np.sqrt(np.sum((lengths - lengths.mean()) ** 2) / 3), abs=1e-9)
    assert row.error_percent == pytest.approx(100.0 * (known - lengths.mean()) / known)
    assert found.problems[0][0] == "c"
    model = method("weinberg", Question.LENGTH)
    strides = [
        [stride_signals(foot) for foot in inputs_of(analyze(r), Person(), known).feet.values()]
        for r in (first, second)
    ]
    sums = [
        distance_m(
            model.run(mine, Person(), calibrate(model, [KnownWalk(s, known) for s in others], Person()))
        )
        for walk, others in (strides, strides[::-1])
        for mine in walk
    ]
    assert found.row(Question.LENGTH, "weinberg").mean_m == pytest.approx(np.mean(sums), abs=1e-9)
    alone = cohort([("a", lambda: first)], known)
    assert np.isnan(alone.row(Question.LENGTH, "weinberg").mean_m)


def _feet(recording: Recording) -> list[object]:
    return list(analyze(recording).gait.feet.values())
