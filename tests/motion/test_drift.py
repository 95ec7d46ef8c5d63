"""The curve of the drift: a least-squares spline against closed forms and against a dense solution."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.motion.drift import DriftCurve


def curve_over(n_rows: int = 300, first: int = 20, last: int = 260, density: float = 1e-2) -> DriftCurve:
    return DriftCurve.over(first, last, n_rows, 100.0, 0.1, density)


def test_a_straight_line_is_no_drift_that_costs() -> None:
    curve = curve_over()
    line = 3.0 - 0.7 * curve.rows / 100.0
    coefficients, gram = curve.fit(np.full((len(line), 1, 1), 100.0), 100.0 * line[:, None, None])
    np.testing.assert_allclose(curve.observed(coefficients[..., 0])[:, 0], line, atol=1e-5)
    assert gram[0, 0] == pytest.approx(0.0, abs=1e-5)
    position, velocity = curve.position_and_velocity(coefficients[..., 0])
    np.testing.assert_allclose(position[:, 0], 3.0 - 0.7 * np.arange(300) / 100.0, atol=1e-4)
    np.testing.assert_allclose(velocity, -0.7, atol=1e-4)


def test_the_velocity_is_the_slope_of_the_position_and_constant_beyond_the_ends() -> None:
    curve = curve_over()
    rng = np.random.default_rng(0)
    position, velocity = curve.position_and_velocity(rng.normal(size=(curve.n_pieces + 3, 3)))
    slope = (position[2:] - position[:-2]) * 50.0
    np.testing.assert_allclose(velocity[1:-1][25:230], slope[25:230], atol=0.02)
    assert np.ptp(velocity[:21], axis=0).max() == pytest.approx(0.0, abs=1e-12)
    assert np.ptp(velocity[260:], axis=0).max() == pytest.approx(0.0, abs=1e-12)


def test_the_gram_of_several_columns_is_what_a_dense_solution_leaves() -> None:
    """Two statements on two axes that depend on each other, against the same problem written out in full."""
    curve = curve_over()
    rng = np.random.default_rng(1)
    k = len(curve.rows)
    normals, columns = 30.0 * rng.normal(size=(k, 2, 2)), 30.0 * rng.normal(size=(k, 2, 3))
    coefficients, gram = curve.fit(normals, columns)

    size = (curve.n_pieces + 3) * 2
    design = np.zeros((k, 2, size))
    for number in range(size):
        unit = np.zeros(size)
        unit[number] = 1.0
        design[:, :, number] = np.einsum("kmd,kd->km", normals, curve.observed(unit.reshape(-1, 2)))
    left = columns - np.einsum("kms,sc->kmc", design, coefficients.reshape(size, 3))
    u = (np.arange(4000) + 0.5) / 4000  # roughness by brute force
    bend = np.stack([1.0 - u, 3.0 * u - 2.0, 1.0 - 3.0 * u, u], axis=1) / curve.piece_s**2
    rough = np.zeros((3, 3))
    for piece in range(curve.n_pieces):
        for axis in range(2):
            second = bend @ coefficients[piece : piece + 4, axis]
            rough += second.T @ second * curve.piece_s / 4000 / curve.accel_density
    whole = np.einsum("kmc,kme->ce", left, left) + rough
    np.testing.assert_allclose(gram, whole, rtol=1e-5, atol=1e-5 * np.abs(whole).max())


def test_a_smoother_drift_is_asked_for_by_a_smaller_density() -> None:
    rng = np.random.default_rng(2)
    rough, smooth = curve_over(density=1.0), curve_over(density=1e-6)
    noise = rng.normal(size=(len(rough.rows), 1, 1))
    weight = np.ones((len(noise), 1, 1))
    bends = [
        np.abs(np.diff(one.position_and_velocity(one.fit(weight, noise)[0][..., 0])[1], axis=0)).max()
        for one in (rough, smooth)
    ]
    assert bends[1] < 0.1 * bends[0]
