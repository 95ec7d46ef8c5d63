"""Digits, intervals and signs as people read them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gaitlab.report.wording import (
    common_decimals,
    decimals_for,
    interval,
    listed,
    number,
    percent,
    uncertainty,
)
from tests.report.walk import parameter


@pytest.mark.parametrize(
    ("sd", "most", "decimals"),
    [
        (0.0127, 3, 3),
        (0.0127, 2, 2),
        (0.46, 3, 2),
        (4.6, 3, 1),
        (46.0, 3, 0),
        (460.0, 3, 0),
        (None, 2, 2),
        (0.0, 2, 2),
    ],
)
def test_two_digits_of_the_uncertainty_bound_the_decimals(sd: float | None, most: int, decimals: int) -> None:
    assert decimals_for(sd, most) == decimals


def test_negative_numbers_have_a_real_minus_and_zero_has_none() -> None:
    assert number(-1.25, 1) == "−1.2"
    assert number(-0.004, 2) == "0.00"


def test_an_uncertainty_is_never_shown_as_zero_unless_it_is() -> None:
    assert uncertainty(0.0004, 2) == "±\u00a00.01"
    assert uncertainty(0.0, 2) == "±\u00a00.00"
    assert uncertainty(None, 2) == ""


@given(
    st.floats(-1e4, 1e4),
    st.floats(1e-4, 1e3),
    st.integers(0, 4),
)
def test_the_printed_interval_holds_the_computed_one(value: float, half: float, decimals: int) -> None:
    low, high = value - half, value + half
    printed = [float(part.replace("−", "-")) for part in interval((low, high), decimals).split(" to ")]
    assert printed[0] <= low + 1e-5
    assert printed[1] >= high - 1e-5
    assert printed[0] > low - 1.01 * 10.0**-decimals
    assert printed[1] < high + 1.01 * 10.0**-decimals


def test_all_sides_of_a_parameter_get_the_digits_of_the_least_certain() -> None:
    sure, unsure = (
        parameter("x", "left", 1.2345, 0.0012, decimals=3),
        parameter("x", "right", 1.2, 0.3, decimals=3),
    )
    missing = parameter("x", "both", None)
    assert common_decimals([sure, unsure, missing]) == 2
    assert common_decimals([missing]) == 0


def test_a_share_says_none_only_where_there_is_none() -> None:
    assert percent(0, 1000) == "0\u00a0%"
    assert percent(1, 100000) == "under 0.1\u00a0%"
    assert percent(29, 1000) == "2.9\u00a0%"


def test_lists_read_as_sentences() -> None:
    assert listed(["left"]) == "left"
    assert listed(["left", "right", "both"]) == "left, right and both"
