"""Least squares along a chain: states of which each is tied to the next only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Floats


@dataclass(frozen=True, eq=False)
class ChainSolution:
    """Estimates of n states of size d: ``state`` (n, d), ``covariance`` (n, d, d), ``cross`` (n − 1, d, d).

    ``cross[k]`` is the covariance of state k with state k + 1.
    """

    state: Floats
    covariance: Floats
    cross: Floats


def solve_chain(diagonal: Floats, upper: Floats, right: Floats) -> ChainSolution:
    """Solve the normal equations of a chain and give the covariances of each state and of each pair of neighbours.

    Every second state is expressed by its two neighbours and taken out, for all of them at once; what remains is a chain
    of half the length. So n states cost about log₂ n steps of batched algebra instead of n small ones.

    Parameters
    ----------
    diagonal : ndarray (n, d, d)
        Information of each state.
    upper : ndarray (n − 1, d, d)
        Information block of state k (rows) and k + 1 (columns).
    right : ndarray (n, d)

    Source: cyclic (odd-even) reduction, Golub and Van Loan, Matrix Computations, 4th ed., §4.5.4; the covariances follow
    by going back through the same steps (a Rauch–Tung–Striebel smoother in another order).
    """
    n = len(diagonal)
    if n == 1:
        covariance = _inverse(diagonal)
        return ChainSolution(_times(covariance, right), covariance, upper)
    n_odd, n_inner = n // 2, (n - 1) // 2  # odd states, and those of them with a neighbour to the right
    inverse = _inverse(diagonal[1::2])
    from_left = inverse @ _t(upper[0::2])
    from_right = inverse[:n_inner] @ upper[1::2]
    alone = _times(inverse, right[1::2])
    kept, kept_right = diagonal[0::2].copy(), right[0::2].copy()
    kept[:n_odd] -= upper[0::2] @ from_left
    kept_right[:n_odd] -= _times(upper[0::2], alone)
    kept[1 : n_inner + 1] -= _t(upper[1::2]) @ from_right
    kept_right[1 : n_inner + 1] -= _times(_t(upper[1::2]), alone[:n_inner])
    even = solve_chain(kept, -upper[0:-1:2][:n_inner] @ from_right, kept_right)

    state, covariance, cross = np.empty_like(right), np.empty_like(diagonal), np.empty_like(upper)
    state[0::2], covariance[0::2] = even.state, even.covariance
    state[1::2] = alone - _times(from_left, even.state[:n_odd])
    state[1::2][:n_inner] -= _times(from_right, even.state[1 : n_inner + 1])
    left = even.covariance[:n_odd] @ _t(from_left)
    left[:n_inner] += even.cross @ _t(from_right)
    inner = from_left[:n_inner] @ even.cross + from_right @ even.covariance[1 : n_inner + 1]
    covariance[1::2] = inverse + from_left @ left
    covariance[1::2][:n_inner] += from_right @ _t(inner)
    cross[0::2] = -left
    cross[1::2] = -inner
    return ChainSolution(state, covariance, cross)


def _t(matrices: Floats) -> Floats:
    return np.swapaxes(matrices, -1, -2)


def _inverse(matrices: Floats) -> Floats:
    return np.asarray(np.linalg.inv(matrices), dtype=np.float64)


def _times(matrices: Floats, vectors: Floats) -> Floats:
    product: Floats = (matrices @ vectors[..., None])[..., 0]
    return product
