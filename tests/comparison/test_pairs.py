"""Differences with their intervals, and instants that belong together."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.comparison.pairs import Compared, Pairs, difference_of, nearest_pairs

CM = Compared("length", "strides", "cm", 100.0, 2)


def test_the_interval_is_students_t_over_the_pairs_and_what_ours_share() -> None:
    pairs = Pairs(np.array([0.01, 0.02, 0.03]), 0.0)
    found = difference_of(CM, [pairs])
    assert found.mean == pytest.approx(2.0)
    assert found.half_width == pytest.approx(
        4.302653 * 1.0 / np.sqrt(3)
    )  # t of 2 degrees of freedom, SD 1 cm
    assert not found.differs
    shared = difference_of(CM, [Pairs(pairs.difference, 0.02)])
    assert shared.half_width == pytest.approx(np.hypot(found.half_width, 1.959964 * 2.0))


def test_both_feet_count_by_their_pairs_and_what_is_not_known_does_not() -> None:
    left, right = Pairs(np.array([0.01, 0.01, np.nan]), 0.03), Pairs(np.array([0.04]), 0.0)
    found = difference_of(CM, [left, right])
    assert found.n == 3
    assert found.mean == pytest.approx(2.0)
    spread = 4.302653 * np.std([1, 1, 4], ddof=1) / np.sqrt(3)
    assert found.half_width == pytest.approx(np.hypot(spread, 1.959964 * 2.0))


def test_one_pair_has_a_difference_without_an_interval_and_none_has_neither() -> None:
    one, none = difference_of(CM, [Pairs(np.array([0.5]), 0.0)]), difference_of(CM, [Pairs(np.zeros(0), 0.0)])
    assert (one.mean, one.n) == (50.0, 1)
    assert np.isnan(one.half_width)
    assert np.isnan(none.mean)
    assert not one.differs
    assert not none.differs


def test_instants_are_paired_where_each_is_the_others_nearest() -> None:
    found, ours = nearest_pairs(np.array([0.1, 0.9, 1.2, 5.0]), np.array([0.0, 1.0, 2.0]), 0.5)
    assert found.tolist() == [0, 1]
    assert ours.tolist() == [0, 1]
    assert len(nearest_pairs(np.zeros(0), np.array([1.0]), 0.5)[0]) == 0
