"""A measurement carries its interval, and says when it cannot be known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import FEW_STRIDES, mean_of, of_both
from gaitlab.gait.definitions import DEFINITIONS, GROUPS
from gaitlab.gait.measurement import MeasuredSide, Status, measured, not_determinable
from gaitlab.recording.model import Side


def test_the_interval_is_the_value_plus_minus_1_96_standard_uncertainties() -> None:
    one = measured(d.STRIDE_LENGTH, MeasuredSide.LEFT, 1.2, 0.1, 10)
    assert one.ci95 == pytest.approx((1.2 - 0.1959964, 1.2 + 0.1959964))


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_value_that_is_no_number_is_not_determinable(value: float) -> None:
    one = measured(d.STRIDE_LENGTH, MeasuredSide.LEFT, value, 0.1, 10)
    assert one.status is Status.NOT_DETERMINABLE
    assert one.value is None
    assert one.reason


def test_what_is_not_determinable_stays_so() -> None:
    one = not_determinable(d.CADENCE, MeasuredSide.BOTH, "No step.")
    assert one.with_attention("Few strides.") == one


def test_the_mean_has_independent_errors_divided_by_n_and_common_ones_whole() -> None:
    values = np.array([1.0, 1.2, 1.1, 1.3, 1.4, 1.2, 1.3, 1.1])
    one = mean_of(d.STRIDE_LENGTH, Side.LEFT, values, 0.04, 0.01, "none")
    assert one.value == pytest.approx(1.2)
    assert one.sd == pytest.approx(math.hypot(0.04 / math.sqrt(8), 0.01))
    assert one.status is Status.OK


def test_few_strides_want_attention_and_none_are_not_determinable() -> None:
    few = mean_of(d.STRIDE_LENGTH, Side.LEFT, np.ones(FEW_STRIDES - 1), 0.0, 0.0, "none")
    assert few.status is Status.ATTENTION
    none = mean_of(d.STRIDE_LENGTH, Side.LEFT, np.array([]), 0.0, 0.0, "There is none.")
    assert none.status is Status.NOT_DETERMINABLE
    assert none.reason == "There is none."


def test_both_sides_count_alike_and_a_missing_side_is_named() -> None:
    left = mean_of(d.STRIDE_LENGTH, Side.LEFT, np.full(20, 1.0), 0.0, 0.03, "none")
    right = mean_of(d.STRIDE_LENGTH, Side.RIGHT, np.full(10, 1.2), 0.0, 0.04, "none")
    both = of_both(left, right)
    assert both.value == pytest.approx(1.1)
    assert both.sd == pytest.approx(0.035)
    assert both.n == 30
    missing = of_both(left, not_determinable(d.STRIDE_LENGTH, MeasuredSide.RIGHT, "No foot."))
    assert missing.status is Status.NOT_DETERMINABLE
    assert "right" in missing.reason


def test_an_event_that_is_read_late_on_one_side_says_nothing_of_the_other() -> None:
    left = mean_of(d.STANCE, Side.LEFT, np.full(20, 61.0), 0.0, 0.3, "none")
    right = mean_of(d.STANCE, Side.RIGHT, np.full(20, 62.0), 0.0, 0.4, "none")
    assert of_both(left, right).sd == pytest.approx(0.25)


def test_independent_errors_of_the_sides_are_halved_in_squares() -> None:
    left = mean_of(d.STRIDE_LENGTH, Side.LEFT, np.full(4, 1.0), 0.06, 0.0, "none")
    right = mean_of(d.STRIDE_LENGTH, Side.RIGHT, np.full(4, 1.2), 0.08, 0.0, "none")
    assert of_both(left, right).sd == pytest.approx(0.025)


def test_an_interval_of_its_own_goes_before_the_symmetrical_one() -> None:
    one = replace(measured(d.WALK_TIME, MeasuredSide.BOTH, 6.0, 0.1, 1), interval=(5.9, 6.4))
    assert one.ci95 == (5.9, 6.4)


def test_every_definition_is_whole_and_has_a_name_of_its_own() -> None:
    assert len({one.name for one in DEFINITIONS}) == len(DEFINITIONS) >= 20
    for one in DEFINITIONS:
        assert one.group in GROUPS, one.name
        assert one.text.endswith("."), one.name
        assert one.reference, one.name


def test_only_what_can_be_negative_has_an_interval_below_zero() -> None:
    stop = measured(d.STOP_DURATION, MeasuredSide.BOTH, 0.0, 0.03, 0)
    assert stop.ci95 == (0.0, pytest.approx(0.0588, abs=1e-3))
    check = measured(d.COURSE_CHECK, MeasuredSide.BOTH, -1.0, 2.0, 1)
    assert check.ci95 is not None
    assert check.ci95[0] == pytest.approx(-4.92, abs=0.01)
