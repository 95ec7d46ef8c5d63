"""What the catalogue says of the methods for feet and knees, and that no recording breaks them."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.methods.catalogue import catalogue, method, named, of
from gaitlab.methods.ikizoglu2018_foot import leg_knee, paper_knee
from gaitlab.methods.model import FootView, Method, Question, Track
from gaitlab.methods.view import foot_view
from gaitlab.motion.foot import track_foot
from gaitlab.motion.free import calibrate
from gaitlab.motion.knee import track_knee
from gaitlab.motion.model import Rests
from gaitlab.recording.model import Placement
from tests.methods.feet import LEFT, built, walk, walked
from tests.walks import cut

FEET = [
    one
    for q in (Question.REST, Question.STEP, Question.HEADING, Question.HEIGHT, Question.POSITION)
    for one in of(q)
]
NAMES = {
    Question.REST: {"ikizoglu2018", "jimenez2009_rest", "feliz2009", "gaitlab"},
    Question.STEP: {
        "jimenez2009_acceleration",
        "jimenez2009_gyroscope",
        "jimenez2009_magnetometer",
        "gaitlab",
    },
    Question.HEADING: {"feliz2009_compass", "feliz2009_gyroscope", "feliz2009_combined", "gaitlab"},
    Question.HEIGHT: {"feliz2009_inertial", "feliz2009_barometric", "gaitlab"},
    Question.POSITION: {
        "ikizoglu2018",
        "jimenez2009_zupt",
        "jimenez2009_sl_weinberg",
        "jimenez2009_sl_zupt",
        "feliz2009",
        "gaitlab",
    },
    Question.KNEE: {"ikizoglu2018", "gaitlab"},
}


@pytest.mark.parametrize("question", NAMES, ids=lambda q: q.value)
def test_the_names_are_there(question: Question) -> None:
    assert {one.name for one in of(question)} >= NAMES[question]


@pytest.mark.parametrize("one", catalogue().values(), ids=lambda m: f"{m.question.name}-{m.name}")
def test_every_method_says_where_it_comes_from(one: Method) -> None:
    assert one.title
    assert one.reference
    for constant in one.constants:
        assert np.isfinite(constant.value)
        assert constant.source
    for deviation in one.deviations:
        assert deviation.endswith(".")


def test_a_name_that_answers_several_questions_needs_one() -> None:
    assert len(named("ikizoglu2018")) >= 3
    with pytest.raises(InputError, match="several questions"):
        method("ikizoglu2018")
    assert method("ikizoglu2018", Question.KNEE).run is paper_knee
    assert method("jimenez2009_zupt").question is Question.POSITION


def test_a_name_that_is_not_there_is_told_what_is() -> None:
    with pytest.raises(InputError, match="no method 'zupt'"):
        method("zupt")
    with pytest.raises(InputError, match="No method 'feliz2009' answers knee"):
        method("feliz2009", Question.KNEE)


def test_the_view_holds_the_signals_without_their_offsets() -> None:
    foot = walked()
    sensor = walk().recording.sensors[LEFT]
    offsets = calibrate(sensor).offsets
    np.testing.assert_array_equal(foot.gyr_radps, sensor.gyr_radps - np.array(offsets.gyr_radps))
    np.testing.assert_array_equal(foot.acc_mps2, sensor.acc_mps2 - np.array(offsets.acc_mps2))
    np.testing.assert_array_equal(foot.mag, sensor.mag)
    np.testing.assert_array_equal(foot.pressure_pa, sensor.pressure_pa)


def poor() -> dict[str, FootView]:
    """Recordings that hold no walk."""
    rng = np.random.default_rng(5)
    zero = np.zeros((300, 3))
    noise, level = rng.normal(size=(300, 3)), np.full(300, 101325.0)
    sensor, time_s = walk().recording.sensors[LEFT], walk().recording.time_s(LEFT)
    short = {
        f"the first {n}": foot_view(cut(sensor, 0, n), track_foot(cut(sensor, 0, n), time_s[:n]))
        for n in (1, 2, 5, 20, 300)
    }
    return {
        "zeros": built(zero, zero, free_mps2=zero, mag=zero, pressure_pa=np.zeros(300)),
        "one row": built(zero[:1], zero[:1], free_mps2=zero[:1], mag=zero[:1], pressure_pa=level[:1]),
        "saturated": built(
            np.full((300, 3), 160.0),
            np.full((300, 3), 20.0),
            free_mps2=zero,
            mag=zero + 1.0,
            pressure_pa=level,
        ),
        "noise": built(50.0 * noise, 10.0 * noise, free_mps2=50.0 * noise, mag=noise, pressure_pa=level),
        "slow": built(zero, zero, rate_hz=5.0, free_mps2=zero, mag=zero + 1.0, pressure_pa=level),
        **short,
    }


@pytest.mark.parametrize("one", FEET, ids=lambda m: f"{m.question.name}-{m.name}")
def test_no_recording_breaks_a_method(one: Method) -> None:
    for name, foot in poor().items():
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = one.run(foot)
        if isinstance(found, Rests):
            assert np.all(found.end > found.start), name
        elif isinstance(found, Track):
            assert found.place_m.shape == (len(found.time_s), 3), name
        elif one.question is Question.STEP:
            assert found.ndim == 1, name
        else:
            assert found.shape == foot.time_s.shape, name


@pytest.mark.parametrize("one", FEET, ids=lambda m: f"{m.question.name}-{m.name}")
def test_who_stands_makes_no_step(one: Method) -> None:
    still = built(mag=np.tile([0.2, 0.3, -0.9], (400, 1)), pressure_pa=np.full(400, 101325.0))
    found = one.run(still)
    if isinstance(found, Rests):
        assert len(found) <= 1
    elif isinstance(found, Track):
        np.testing.assert_allclose(found.place_m, 0.0, atol=1e-9)
    else:
        np.testing.assert_allclose(found, 0.0, atol=1e-9)


def test_the_knees_are_those_of_the_motion_room() -> None:
    recording = walk().recording
    foot, knee = recording.sensors[LEFT], recording.sensors[Placement.LEFT_KNEE]
    motion = track_foot(foot, recording.time_s(LEFT))
    shift = foot.first_packet - knee.first_packet
    time_s = recording.time_s(Placement.LEFT_KNEE)
    for run, name in ((paper_knee, "ikizoglu2018"), (leg_knee, "gaitlab")):
        found = run(knee, time_s, motion, shift)
        np.testing.assert_array_equal(
            found.position_m, track_knee(knee, time_s, motion, shift, name).position_m
        )
    assert method("gaitlab", Question.KNEE).run is leg_knee


@pytest.mark.parametrize(
    "one", [one for one in FEET if one.name != "gaitlab"], ids=lambda m: f"{m.question.name}-{m.name}"
)
def test_no_published_method_profits_from_our_smoother(one: Method) -> None:
    """But for the orientation, and the first rest that headings and heights count from."""
    foot = walked()
    zero = np.zeros_like(foot.motion.position_m)
    other = replace(foot.motion, acceleration_mps2=zero, velocity_mps=zero, position_m=zero)
    plain, blind = one.run(foot), one.run(replace(foot, motion=other))
    if isinstance(plain, Rests):
        np.testing.assert_array_equal(blind.moment, plain.moment)
    elif isinstance(plain, Track):
        np.testing.assert_array_equal(blind.place_m, plain.place_m)
    else:
        np.testing.assert_array_equal(blind, plain)
