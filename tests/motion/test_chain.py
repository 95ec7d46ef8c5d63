"""The chain solver gives what the whole matrix gives."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from gaitlab.motion.chain import solve_chain


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8, 17, 64])
@pytest.mark.parametrize("d", [1, 4])
def test_states_and_covariances_are_those_of_the_whole_system(n: int, d: int) -> None:
    rng = np.random.default_rng(n * 10 + d)
    information, right = np.zeros((n * d, n * d)), rng.normal(size=n * d)
    for k in range(n):
        reach = slice(k * d, min(k + 2, n) * d)
        rows = rng.normal(size=(3 * d, reach.stop - reach.start))
        information[reach, reach] += rows.T @ rows
    at = [slice(k * d, (k + 1) * d) for k in range(n)]
    diagonal = np.stack([information[s, s] for s in at])
    upper = np.array([information[a, b] for a, b in itertools.pairwise(at)]).reshape(n - 1, d, d)
    solution = solve_chain(diagonal, upper, right.reshape(n, d))
    covariance = np.linalg.inv(information)
    np.testing.assert_allclose(solution.state.ravel(), covariance @ right, atol=1e-9)
    for k in range(n):
        np.testing.assert_allclose(solution.covariance[k], covariance[at[k], at[k]], atol=1e-9)
    for k in range(n - 1):
        np.testing.assert_allclose(solution.cross[k], covariance[at[k], at[k + 1]], atol=1e-9)
