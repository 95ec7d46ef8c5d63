"""Matching, optical paths and the lever arm: closed forms and properties."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gaitlab.validation.truth import OpticalPath, fit_lever, match_instants

TIMES = st.lists(st.integers(0, 400), max_size=15, unique=True)


def test_the_nearest_pairs_match_and_each_instant_but_once() -> None:
    found, truth = match_instants(np.array([1.00, 1.04, 3.0]), np.array([1.03, 2.0, 3.05]), 0.05)
    assert found.tolist() == [1, 2]
    assert truth.tolist() == [0, 2]


def test_the_tolerance_itself_is_within_it() -> None:
    assert len(match_instants(np.array([1.05]), np.array([1.0]), 0.05)[0]) == 1
    assert len(match_instants(np.array([1.0502]), np.array([1.0]), 0.05)[0]) == 0


def test_nothing_matches_nothing() -> None:
    found, truth = match_instants(np.array([]), np.array([1.0]), 0.05)
    assert len(found) == len(truth) == 0


@given(TIMES, TIMES)
def test_matched_pairs_are_one_to_one_within_the_tolerance_and_none_is_left_that_could_be(
    a: list[int], b: list[int]
) -> None:
    ours, theirs = np.array(a) / 100.0, np.array(b) / 100.0
    found, truth = match_instants(ours, theirs, 0.05)
    assert len(set(found.tolist())) == len(set(truth.tolist())) == len(found)
    assert np.all(np.abs(ours[found] - theirs[truth]) <= 0.0501)
    free = np.delete(ours, found)[:, None] - np.delete(theirs, truth)[None, :]
    assert np.all(np.abs(free) > 0.05)
    again, other = match_instants(theirs, ours, 0.05)
    assert len(again) == len(found)
    np.testing.assert_allclose(
        np.sort(np.abs(theirs[again] - ours[other])), np.sort(np.abs(ours[found] - theirs[truth]))
    )


def test_an_optical_length_is_horizontal_and_unknown_where_the_point_was_not_seen() -> None:
    time = np.arange(11) / 10.0
    point = np.stack([3.0 * time, 4.0 * time, 7.0 * time**2], axis=1)
    point[8] = np.nan
    path = OpticalPath(time, point)
    length = path.horizontal_length(
        np.array([0.1, 0.15, -0.1, 0.2, 0.3]), np.array([0.3, 0.25, 0.2, 1.2, 0.8])
    )
    np.testing.assert_allclose(length[:2], [1.0, 0.5])
    assert np.isnan(length[2:]).all()


def _knee(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Sensor path, its rotations, the joint's lever arm and the cycles of a walk with a swinging shank."""
    rng = np.random.default_rng(seed)
    t = np.arange(400) / 100.0
    path = np.stack([1.2 * t, 0.1 * np.sin(3.0 * t), 0.05 * np.cos(6.0 * t)], axis=1)
    angles = np.stack([0.2 * np.sin(5 * t), 0.6 * np.sin(6 * t), 0.4 * np.sin(2 * t)], axis=1)
    rotation = (Rotation.from_euler("xyz", angles) * Rotation.random(rng=rng)).as_matrix()
    return path, rotation, rng.normal(0.0, 0.2, 3), np.repeat(np.arange(4), 100)


@pytest.mark.parametrize("start_is_mean", [False, True])
@given(st.integers(0, 1000), st.floats(-3.1, 3.1))
@settings(max_examples=25)
def test_heading_and_lever_arm_are_found_exactly_whatever_each_cycle_starts_from(
    start_is_mean: bool, seed: int, heading: float
) -> None:
    path, rotation, lever, cycle = _knee(seed)
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = np.random.default_rng(seed + 1).normal(0.0, 3.0, (4, 3))
    optical = (path + rotation @ lever) @ turn.T + shift[cycle]
    fit = fit_lever(path, rotation, optical, cycle, start_is_mean=start_is_mean)
    np.testing.assert_allclose(fit.lever_m, lever, atol=1e-4)
    assert abs(np.angle(np.exp(1j * (fit.heading_rad - heading)))) < 1e-4
    np.testing.assert_allclose(fit.error_m, 0.0, atol=2e-4)


def test_an_error_that_grows_in_each_cycle_is_left_whole_by_the_fit() -> None:
    """A scale error is neither a heading nor a lever arm: it is left over, measured from the start of each cycle."""
    path, rotation, lever, cycle = _knee(5)
    optical = path + rotation @ lever
    error = 0.05 * (np.arange(400) % 100)[:, None] / 100.0 * np.array([0.0, 0.0, 1.0])
    fit = fit_lever(path + error, rotation, optical, cycle)
    assert np.sqrt(np.mean(np.sum(fit.error_m**2, axis=1))) > 0.015
    np.testing.assert_allclose(fit.error_m[::100], 0.0, atol=1e-12)


def test_about_the_mean_no_error_is_larger_than_from_the_first_row() -> None:
    path, rotation, lever, cycle = _knee(7)
    noise = np.random.default_rng(1).normal(0.0, 0.02, path.shape)
    optical = path + rotation @ lever + noise
    errors = [
        np.sum(fit_lever(path, rotation, optical, cycle, start_is_mean=mean).error_m ** 2)
        for mean in (True, False)
    ]
    assert errors[0] < errors[1]
