"""What a report says about how far its numbers may be trusted: trial, strides, course, and all trials together."""

from __future__ import annotations

from typing import Literal

import pytest

from gaitlab.report import TrialReport, report_html
from gaitlab.report.strides import MOST_STRIDES, pooled_table, stride_rows
from gaitlab.report.summary import verdict
from gaitlab.result import Result, StrideSpread, TrialQuality
from tests.report import walk
from tests.report.conftest import report_of, squeezed
from tests.report.test_pdf import read, text_of, texts_with_numbers
from tests.report.walk import parameter

Sides = Literal["left", "right"]


def judged(
    *qualities: str, status: str = "attention", reasons: tuple[str, ...] = ("Many were lost.",)
) -> Result:
    """The closed-form walk; the left foot's first strides are of these qualities, the trial of this status."""
    result = walk.result(knees=False)
    left = result.feet["left"]
    strides = list(left.strides)
    for k, quality in enumerate(qualities):
        reason = "" if quality == "valid" else f"Reason {k}."
        strides[k] = strides[k].model_copy(update={"quality": quality, "reason": reason})
    feet = {**result.feet, "left": left.model_copy(update={"strides": tuple(strides)})}
    quality = TrialQuality.model_validate({"status": status, "reasons": reasons})
    return result.model_copy(update={"feet": feet, "quality": quality})


def spread(side: Sides, n: int, sd: float) -> StrideSpread:
    return StrideSpread(
        name="stride_time_cv", side=side, n=n, freedom=n - 1, mean=1.0, observed_sd=sd, measurement_sd=0.002
    )


def with_spreads(*spreads: StrideSpread) -> Result:
    return walk.result(knees=False).model_copy(update={"spreads": spreads})


@pytest.mark.parametrize(
    ("status", "drawn", "label"),
    [
        ("valid", "ok", "Valid"),
        ("attention", "attention", "Attention"),
        ("invalid", "not_determinable", "Invalid"),
    ],
)
def test_the_verdict_is_the_analysiss_own(status: str, drawn: str, label: str) -> None:
    said = verdict(judged(status=status, reasons=("One.", "Two.", "Three.", "Four.", "Five.", "Six.")))
    assert (said.status, said.label) == (drawn, label)
    assert said.reasons == ("One.", "Two.", "Three.", "Four.", "And 2 more reasons: see the warnings.")


def test_strides_that_are_not_valid_are_listed_in_order_with_their_reasons() -> None:
    rows = stride_rows(judged("valid", "attention", "invalid"))
    assert [(row.foot, row.label, row.status, row.reason) for row in rows] == [
        ("left", "attention", "attention", "Reason 1."),
        ("left", "invalid", "not_determinable", "Reason 2."),
    ]
    assert rows[0].length == "1.300 ± 0.030 m".replace(" ", "\u00a0").replace("0\u00a0±", "0 ±")
    many = judged(*(["attention"] * len(walk.result().feet["left"].strides)))
    assert len(stride_rows(many)) <= MOST_STRIDES


def test_verdict_strides_and_pool_stand_on_the_page_and_on_paper() -> None:
    first = judged("valid", "attention", "invalid").model_copy(
        update={"spreads": (spread("left", 12, 0.021), spread("right", 12, 0.023))}
    )
    second = with_spreads(spread("left", 11, 0.019), spread("right", 12, 0.02))
    report = report_of(TrialReport(1, first, walk.series()), TrialReport(2, second, walk.series()))
    page, printed = report_html(report), text_of(read(report))
    assert [text for text in texts_with_numbers(page) if text not in printed] == []
    for words in ("Many were lost.", "Reason 2.", "All trials together", "pooled over the 2 trials"):
        assert words in page
        assert squeezed(words) in printed


def test_the_pool_has_the_strides_of_all_trials_and_their_value() -> None:
    results = [
        with_spreads(spread("left", 12, 0.021), spread("right", 12, 0.021)),
        with_spreads(spread("left", 11, 0.021), spread("right", 12, 0.021)),
    ]
    table = pooled_table(results)
    assert table is not None
    row = next(row for row in table.rows if row.label == "Stride time variability")
    assert row.left is not None
    assert (row.left.value, row.left.n) == ("2.1", "23")
    assert row.both is not None
    assert row.both.status == "ok"


def test_one_trial_or_old_results_have_no_pool() -> None:
    assert pooled_table([with_spreads(spread("left", 30, 0.02))]) is None
    assert pooled_table([walk.result(), walk.result()]) is None


def test_the_walk_against_the_course_is_shown_and_never_used() -> None:
    check = parameter("course_check", "both", 1.24, 0.83, unit="%", decimals=1)
    result = walk.result(knees=False, chosen=(*walk.parameters(), check))
    report = report_of(TrialReport(1, result, walk.series()))
    fact = next(fact for fact in report.trials[0].walk if fact.label == "Walk against the course")
    assert fact.value == "+1.2 ±\u00a00.8\u00a0%. A check of the scale; no value is corrected by it."
    plain = report_of(TrialReport(1, walk.result(knees=False), walk.series()))
    assert report.trials[0].key == plain.trials[0].key
