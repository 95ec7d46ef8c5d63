"""A stride is valid, wants attention or is invalid, and says why; invalid ones are in no mean."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gaitlab.analysis import Analysis, analyze
from gaitlab.gait.verdicts import Quality
from gaitlab.recording.model import Placement, Recording, Sensor, Side
from tests.walks import analysed, out_and_back

LEFT = Placement.LEFT_FOOT
FOURTH = 3


def _changed(change: Callable[[Sensor, slice], Sensor]) -> Analysis:
    """The walk with the left foot's fourth stride changed."""
    sensors = {p: s for p, s in out_and_back().recording.sensors.items() if p.is_foot}
    rests = analysed().gait.feet[Side.LEFT].motion.rests
    rows = slice(int(rests.end[FOURTH]), int(rests.start[FOURTH + 1]))
    return analyze(Recording({**sensors, LEFT: change(sensors[LEFT], rows)}))


def _marked(name: str, rows: slice, value: bool) -> Callable[[Sensor, slice], Sensor]:
    def change(sensor: Sensor, swing: slice) -> Sensor:
        marks = getattr(sensor, name).copy()
        marks[swing][rows] = value
        return replace(sensor, **{name: marks})

    return change


def _jolted(sensor: Sensor, swing: slice) -> Sensor:
    """An acceleration error of 3 m/s² over the swing."""
    assert sensor.acc_mps2 is not None
    acc = sensor.acc_mps2.copy()
    acc[swing] += 3.0
    return replace(sensor, acc_mps2=acc)


@pytest.mark.parametrize(
    ("change", "quality", "words"),
    [
        (_marked("received", slice(2, 40), False), Quality.INVALID, "of it were lost at a stretch"),
        (_marked("received", slice(0, None, 3), False), Quality.ATTENTION, "% of its samples were lost"),
        (
            _marked("saturated", slice(3, 5), True),
            Quality.ATTENTION,
            "the sensor reached the end of its range",
        ),
        (_marked("saturated", slice(3, 25), True), Quality.INVALID, "the end of the sensor's range"),
        (_jolted, Quality.INVALID, "times as much as in this foot's other strides"),
    ],
    ids=["gap", "losses", "touched", "saturated", "jolted"],
)
def test_a_stride_is_judged_by_what_was_recorded_of_it(
    change: Callable[[Sensor, slice], Sensor], quality: Quality, words: str
) -> None:
    analysis = _changed(change)
    stride = analysis.result.feet["left"].strides[FOURTH]
    assert stride.quality == quality.value
    assert words.lower() in stride.reason.lower()
    others = [one for k, one in enumerate(analysis.result.feet["left"].strides) if abs(k - FOURTH) > 1]
    assert {one.quality for one in others} == {"valid"}


def test_an_invalid_stride_is_in_no_mean_and_one_with_attention_is() -> None:
    plain = analyze(
        Recording({p: s for p, s in out_and_back().recording.sensors.items() if p.is_foot})
    ).result
    invalid = _changed(_marked("received", slice(2, 40), False)).result
    attention = _changed(_marked("saturated", slice(3, 5), True)).result
    for name, fewer in (
        ("stride_length", 1),
        ("stride_time", 2),
    ):  # its contact ends one stride and begins another
        n = [result.parameter(name, "left") for result in (plain, attention, invalid)]
        assert n[0] is not None
        assert n[1] is not None
        assert n[2] is not None
        assert n[1].n == n[0].n
        assert n[2].n == n[0].n - fewer


def test_a_sound_walk_has_no_reason_to_doubt_a_stride() -> None:
    for foot in analysed(None).gait.feet.values():
        assert not foot.verdicts.invalid.any()
        assert not foot.verdicts.attention.any()
        assert foot.verdicts.of(0) == (Quality.VALID, "")


def test_rests_carry_their_evidence() -> None:
    rests = analysed().result.feet["left"].rests
    assert rests[0].implied_acc_error_mps2 is None
    for rest in rests[1:]:
        assert rest.gyr_sd_radps is not None
        assert rest.acc_sd_mps2 is not None
        assert rest.implied_acc_error_mps2 is not None
    implied = np.array([rest.implied_acc_error_mps2 for rest in rests[1:]])
    assert 0.0 < np.median(implied) < 1.0
