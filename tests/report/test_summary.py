"""The verdict and the sentences of the first page."""

from __future__ import annotations

import pytest

from gaitlab.report.parameters import key_table
from gaitlab.report.summary import summary_sentences, verdict
from gaitlab.result import Parameter, Result, ResultWarning, SensorQuality
from tests.report import walk
from tests.report.walk import parameter


def made(*chosen: Parameter, lost: int = 0, warnings: tuple[str, ...] = ()) -> Result:
    """A result with these parameters, one sensor's loss out of 1000 and warnings of these codes."""
    said = tuple(ResultWarning(code=code, message="Something.", placement=None) for code in warnings)
    sensor = SensorQuality(samples=1000, lost=lost, saturated=0, device=None)
    base = walk.result(knees=False, chosen=chosen, warnings=said)
    return base.model_copy(update={"sensors": {"left_foot": sensor}})


STRIDE = parameter("stride_length", "both", 1.276, 0.018, decimals=3)
CADENCE = parameter("cadence", "both", 108.4, 1.1, unit="steps/min", decimals=1)
DOUBTFUL = CADENCE.model_copy(update={"status": "attention", "reason": "Few steps."})
TIME = parameter(
    "walk_time", "both", None, reason="No length of a course was given.", label="Time over the course"
)
ASSUMED = parameter(
    "step_length", "left", 0.64, 0.07, status="attention", reason="The feet stood side by side."
)


@pytest.mark.parametrize(
    ("result", "status"),
    [
        (made(STRIDE, CADENCE), "ok"),
        (made(STRIDE, CADENCE, ASSUMED), "ok"),
        (made(STRIDE, CADENCE, lost=30, warnings=("lost_samples",)), "ok"),
        (made(STRIDE, CADENCE, lost=90), "attention"),
        (made(STRIDE, CADENCE, warnings=("large_residual",)), "attention"),
        (made(STRIDE, DOUBTFUL), "attention"),
        (made(STRIDE, TIME), "attention"),
        (made(TIME), "not_determinable"),
        (made(), "not_determinable"),
    ],
)
def test_the_verdict_follows_key_values_loss_and_warnings(result: Result, status: str) -> None:
    assert verdict(result).status == status


def test_the_verdict_says_what_it_rests_on() -> None:
    text = verdict(made(STRIDE, DOUBTFUL, TIME, lost=90, warnings=("many_lost",))).text
    assert text == (
        "2 of 3 key values determined; 1 with attention (cadence); 1 missing (time over the course). "
        "Lost samples: left foot 9.0\u00a0%. See 1 warning."
    )


def test_sentences_carry_the_digits_of_the_table() -> None:
    unsure = parameter("stride_length", "left", 1.2, 0.3, decimals=3)
    sentences = summary_sentences(made(STRIDE, unsure, CADENCE))
    assert (
        sentences[0].replace("\u00a0", " ") == "Stride length 1.28 ± 0.02 m; cadence 108.4 ± 1.1 steps/min."
    )


def test_a_time_that_cannot_be_known_is_said_with_its_reason() -> None:
    assert summary_sentences(made(TIME))[0] == (
        "The time over the course is not determinable: no length of a course was given."
    )


def test_a_free_walk_is_not_blamed_for_having_no_course() -> None:
    timed = made(STRIDE, TIME)
    free = timed.model_copy(
        update={"provenance": timed.provenance.model_copy(update={"settings": {"course_m": None}})}
    )
    assert verdict(free).status == "ok"
    assert "course" not in " ".join(summary_sentences(free))
    assert [row.label for row in key_table(free).rows] == ["Stride length"]


def test_nothing_to_say_is_said() -> None:
    bare = walk.result([], chosen=())
    assert summary_sentences(bare) == ("No gait parameter could be determined from this recording.",)
