"""The slow error of an integrated path as a smooth curve, found by linear least squares in time linear in n."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitlab.motion.model import Indices
from gaitlab.recording.model import Bools, Floats

OBSERVED = 4
"""Rows of each piece of the curve at which something is observed."""
FARTHEST_M = 1e4
"""No drift goes beyond this: a statement that decides only where there is no other."""


def _value(u: Floats) -> Floats:
    """The four cubic B-splines that reach into a piece, at 0 ≤ u < 1 of it, shape (len(u), 4)."""
    v = 1.0 - u
    middle = [3.0 * u**3 - 6.0 * u**2 + 4.0, 3.0 * v**3 - 6.0 * v**2 + 4.0]
    return np.stack([v**3, middle[0], middle[1], u**3], axis=1) / 6.0


def _slope(u: Floats) -> Floats:
    """Their derivatives by u."""
    v = 1.0 - u
    return np.stack([-(v**2), 3.0 * u**2 - 4.0 * u, 4.0 * v - 3.0 * v**2, u**2], axis=1) / 2.0


def _roughness() -> Floats:
    """∫ b″b″ᵀ du over a piece, shape (4, 4); exact by two points of Gauss, since b″ is linear."""
    u = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
    bend = np.stack([1.0 - u, 3.0 * u - 2.0, 1.0 - 3.0 * u, u], axis=1)
    rough: Floats = 0.5 * bend.T @ bend
    return rough


_AT_OBSERVED = _value(np.arange(OBSERVED) / OBSERVED)
_ROUGHNESS = _roughness()


@dataclass(frozen=True, eq=False)
class DriftCurve:
    """A cubic spline with equal pieces over the rows from ``first`` on: position error of an integrated path.

    Its second derivative, the acceleration error, is white with the density ``accel_density`` (m²/s³): that is what
    makes it smooth. So fitting it is a Kalman smoother whose steps are the pieces.

    Attributes
    ----------
    first : int
        Row where the first piece begins.
    spacing : int
        Rows between two observed rows; a piece has ``OBSERVED`` of them.
    n_pieces : int
    n_rows : int
        Rows of the recording.
    """

    first: int
    spacing: int
    n_pieces: int
    n_rows: int
    last: int
    rate_hz: float
    accel_density: float

    @classmethod
    def over(
        cls, first: int, last: int, n_rows: int, rate_hz: float, spacing_s: float, accel_density: float
    ) -> DriftCurve:
        """A curve over the rows ``first`` to ``last``, observed every ``spacing_s`` or so."""
        spacing = max(1, round(spacing_s * rate_hz))
        n_pieces = max(1, -(-(last - first) // (spacing * OBSERVED)))
        return cls(first, spacing, n_pieces, n_rows, last, rate_hz, accel_density)

    @property
    def piece_s(self) -> float:
        """Duration of a piece."""
        return self.spacing * OBSERVED / self.rate_hz

    @property
    def rows(self) -> Indices:
        """Observed rows, shape (n_pieces · OBSERVED,); those behind the last row stand on it."""
        every = self.first + self.spacing * np.arange(self.n_pieces * OBSERVED)
        return np.minimum(every, self.last)

    @property
    def counted(self) -> Bools:
        """True for each observed row that does not stand for one behind the last."""
        return self.first + self.spacing * np.arange(self.n_pieces * OBSERVED) <= self.last

    def fit(self, normals: Floats, columns: Floats) -> tuple[Floats, Floats]:
        """Fit a curve to each of several columns of observations at once.

        Parameters
        ----------
        normals : ndarray (k, m, d)
            At each observed row, m statements on the d axes of the curve, each divided by its standard deviation.
        columns : ndarray (k, m, c)
            What the statements say, c of them, divided likewise.

        Returns
        -------
        coefficients : ndarray (n_pieces + 3, d, c)
        gram : ndarray (c, c)
            Sum of squares of what the curves leave, roughness included: for any mixture x of the columns it is
            xᵀ·gram·x.
        """
        _, m, d = normals.shape
        c = columns.shape[-1]
        design = normals.reshape(-1, OBSERVED, m, 1, d) * _AT_OBSERVED[:, None, :, None]
        design = design.reshape(self.n_pieces, OBSERVED * m, 4 * d)
        flat = columns.reshape(self.n_pieces, OBSERVED * m, c)
        local = design.transpose(0, 2, 1) @ design
        for axis in range(d):
            local[:, axis::d, axis::d] += _ROUGHNESS / (self.accel_density * self.piece_s**3)
        load = design.transpose(0, 2, 1) @ flat
        size, width = (self.n_pieces + 3) * d, 4 * d
        band, right = np.zeros((width, size)), np.zeros((size, c))
        end = self.n_pieces * d
        for row in range(width):
            right[row : row + end : d] += load[:, row]
            for column in range(row, width):
                band[width - 1 + row - column, column : column + end : d] += local[:, row, column]
        band[-1] += FARTHEST_M**-2
        from scipy.linalg import solveh_banded  # heavy; only a knee needs it

        coefficients = solveh_banded(band, right, check_finite=False)
        every = columns.reshape(-1, c)
        gram: Floats = every.T @ every - right.T @ coefficients
        return coefficients.reshape(-1, d, c), gram

    def observed(self, coefficients: Floats) -> Floats:
        """The curve at its observed rows, shape (k, d), from coefficients (n_pieces + 3, d)."""
        return self._mixed(_AT_OBSERVED, coefficients)

    def position_and_velocity(self, coefficients: Floats) -> tuple[Floats, Floats]:
        """The curve and its slope in every row of the recording, shape (n_rows, d); straight beyond its ends."""
        n = self.spacing * OBSERVED
        u = np.arange(n) / n
        position = self._mixed(_value(u), coefficients)
        velocity = self._mixed(_slope(u) / self.piece_s, coefficients)
        rows = np.arange(self.n_rows)
        inside = np.clip(rows, self.first, min(self.last, self.first + len(position) - 1))
        beyond = (rows - inside) / self.rate_hz
        velocity = velocity[inside - self.first]
        return position[inside - self.first] + beyond[:, None] * velocity, velocity

    def _mixed(self, basis: NDArray[np.float64], coefficients: Floats) -> Floats:
        """Each piece's four coefficients mixed by the rows of ``basis`` (m, 4): shape (n_pieces · m, d)."""
        four = np.stack([coefficients[j : j + self.n_pieces] for j in range(4)], axis=1)
        mixed: Floats = (basis @ four).reshape(-1, coefficients.shape[-1])
        return mixed
