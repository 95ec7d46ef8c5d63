"""Orientation from the gyroscope alone, made level by gravity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaitlab.motion.moving import moving_mean
from gaitlab.motion.quaternions import multiply, rotate
from gaitlab.recording.model import Floats

_BLOCK = 16
_Halves = tuple[NDArray[np.complex128], NDArray[np.complex128]]


def integrate_rate(gyr_radps: Floats, rate_hz: float) -> Floats:
    """Orientation of each row against row 0, shape (n, 4), from angular rates in the sensor's frame, shape (n, 3).

    Each rate is the mean over the interval that ends with its row, as the device sends it, so that its rotation is
    exact: the gyroscope of ``mtw-leg-vicon`` agrees with the device's own orientation increments to 0.005 rad/s. The
    n successive rotations are multiplied within blocks of rows and then over the blocks, each for all rows at once;
    a quaternion is held as two complex halves.
    """
    n = len(gyr_radps)
    half = np.zeros((-(-n // _BLOCK) * _BLOCK, 3))
    half[1:n] = gyr_radps[1:] * (0.5 / rate_hz)
    angle = np.sqrt(np.einsum("ij,ij->i", half, half))
    part = half * np.sinc(angle / np.pi)[:, None]
    z = (np.cos(angle) + 1j * part[:, 0]).reshape(-1, _BLOCK)
    w = (part[:, 1] + 1j * part[:, 2]).reshape(-1, _BLOCK)
    for k in range(1, _BLOCK):
        z[:, k], w[:, k] = _product((z[:, k - 1], w[:, k - 1]), (z[:, k], w[:, k]))
    before = z[:, -1].copy(), w[:, -1].copy()
    step = 1
    while step < len(z):
        before[0][step:], before[1][step:] = _product(
            (before[0][:-step], before[1][:-step]), (before[0][step:], before[1][step:])
        )
        step *= 2
    z[1:], w[1:] = _product((before[0][:-1, None], before[1][:-1, None]), (z[1:], w[1:]))
    z, w = z.ravel()[:n], w.ravel()[:n]
    q: Floats = np.stack([z.real, z.imag, w.real, w.imag], axis=1)
    return q


def _product(a: _Halves, b: _Halves) -> _Halves:
    """Hamilton product of quaternions z + w·j, each given as its complex halves (z, w)."""
    return a[0] * b[0] - a[1] * b[1].conj(), a[0] * b[1] + a[1] * b[0].conj()


def upright(up: Floats) -> Floats:
    """The smallest rotations that turn vectors, shape (n, 3), to the vertical; shape (n, 4)."""
    unit = up / np.maximum(np.sqrt(np.einsum("ij,ij->i", up, up)), 1e-9)[:, None]
    q = np.stack([1.0 + unit[:, 2], unit[:, 1], -unit[:, 0], np.zeros(len(unit))], axis=1)
    q[q[:, 0] < 1e-6] = [0.0, 1.0, 0.0, 0.0]  # upside down: any horizontal axis will do
    turned: Floats = q / np.sqrt(np.einsum("ij,ij->i", q, q))[:, None]
    return turned


LEVEL_WINDOW_S = 2.0
"""Where there are no rests yet, gravity is the mean force over about this time: two gait cycles."""


def mean_force(force_mps2: Floats, rate_hz: float, window_s: float = LEVEL_WINDOW_S) -> Floats:
    """Specific force averaged twice over ``window_s``, shape (n, 3): a first guess of gravity, off by a degree or two
    where real accelerations do not cancel."""
    width = min(len(force_mps2), max(3, round(window_s * rate_hz)))
    columns = np.ascontiguousarray(force_mps2.T)
    for _ in range(2):
        columns = moving_mean(columns, width)
    return np.ascontiguousarray(columns.T)


def level_throughout(attitude: Floats, up: Floats) -> Floats:
    """Orientation turned so that ``up``, shape (n, 3), becomes the vertical in every row, shape (n, 4)."""
    first = upright(
        up.mean(axis=0, keepdims=True)
    )  # what is left to do is small, whatever way the sensor sits
    return multiply(upright(rotate(first, up)), multiply(first, attitude))


def small_rotation(vector_rad: Floats) -> Floats:
    """Unit quaternions (n, 4) of rotation vectors (n, 3) of less than half a turn."""
    half = 0.5 * vector_rad
    angle = np.sqrt(np.einsum("ij,ij->i", half, half))
    q = np.empty((len(half), 4))
    q[:, 0] = np.cos(angle)
    q[:, 1:] = half * np.sinc(angle / np.pi)[:, None]
    return q


def apply(rotation: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3) turned by rotations (3, 3, n); shape (n, 3)."""
    turned: Floats = np.einsum("ijn,nj->ni", rotation, vectors)
    return turned
