"""Equations 7 and 8 against values worked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.methods.ground_truth import ground_truth_errors


def test_distance_and_direction_between_successive_points() -> None:
    """True: 10 m along x, then 5 m along y. Estimated: 9 m along x, then 3 m back and 4 m to the side."""
    true = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]])
    estimated = np.array([[1.0, 1.0], [10.0, 1.0], [7.0, 5.0]])
    found = ground_truth_errors(true, estimated)
    np.testing.assert_allclose(found.distance_m, [1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(found.heading_rad, [0.0, np.pi / 2 - np.arctan2(4.0, -3.0)], atol=1e-12)


def test_a_direction_is_off_by_half_a_turn_at_most() -> None:
    true, estimated = np.array([[0.0, 0.0], [-1.0, -0.1]]), np.array([[0.0, 0.0], [-1.0, 0.1]])
    assert ground_truth_errors(true, estimated).heading_rad[0] == pytest.approx(2.0 * np.arctan(0.1))


def test_aligned_by_the_first_direction_a_turned_world_makes_no_error() -> None:
    rng = np.random.default_rng(6)
    true = rng.normal(size=(6, 3))
    c, s = np.cos(2.5), np.sin(2.5)
    turned = true @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(ground_truth_errors(true, turned, aligned=True).heading_rad, 0.0, atol=1e-12)
    np.testing.assert_allclose(ground_truth_errors(true, turned).distance_m, 0.0, atol=1e-12)
    assert np.abs(ground_truth_errors(true, turned).heading_rad).max() > 1.0


def test_one_point_and_points_that_coincide_are_no_error() -> None:
    assert len(ground_truth_errors(np.zeros((1, 2)), np.zeros((1, 2))).distance_m) == 0
    assert len(ground_truth_errors(np.zeros((0, 3)), np.zeros((0, 3)), aligned=True).heading_rad) == 0
    assert np.isnan(ground_truth_errors(np.zeros((2, 2)), np.ones((2, 2))).heading_rad[0])
