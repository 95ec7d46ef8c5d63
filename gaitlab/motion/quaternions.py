"""The little quaternion algebra that motion needs: scalar first, sensor to world, vectorised over rows."""

from __future__ import annotations

import numpy as np

from gaitlab.recording.model import Floats


def multiply(p: Floats, q: Floats) -> Floats:
    """Hamilton product p ⊗ q, shapes (n, 4) or (4,): the rotation q first, then p."""
    pw, px, py, pz = np.ascontiguousarray(p.T)  # whole columns: numpy is several times slower on strided ones
    qw, qx, qy, qz = np.ascontiguousarray(q.T)
    w = pw * qw - px * qx - py * qy - pz * qz
    product = np.empty((*w.shape, 4))
    product[..., 0] = w
    product[..., 1] = pw * qx + px * qw + py * qz - pz * qy
    product[..., 2] = pw * qy - px * qz + py * qw + pz * qx
    product[..., 3] = pw * qz + px * qy - py * qx + pz * qw
    return product


def conjugate(q: Floats) -> Floats:
    """The inverse rotation of unit quaternions, shape (..., 4)."""
    inverse: Floats = q * np.array([1.0, -1.0, -1.0, -1.0])
    return inverse


def rotate(q: Floats, v: Floats) -> Floats:
    """Turn vectors v, shape (n, 3), by unit quaternions q, shape (n, 4) or (4,)."""
    w, u = q[..., :1], q[..., 1:]
    t = 2.0 * cross(u, v)
    turned: Floats = v + w * t + cross(u, t)
    return turned


def cross(a: Floats, b: Floats) -> Floats:
    """Vector product, shapes (..., 3)."""
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        product[..., k] = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return product


def matrices(q: Floats) -> Floats:
    """Rotation matrices of unit quaternions (n, 4), world from sensor; components first, shape (3, 3, n), since whole
    columns are many times faster than small matrices."""
    w, x, y, z = np.ascontiguousarray(q.T)
    x2, y2, z2 = 2.0 * x, 2.0 * y, 2.0 * z
    xx, yy, zz, xy, xz, yz = x * x2, y * y2, z * z2, x * y2, x * z2, y * z2
    wx, wy, wz = w * x2, w * y2, w * z2
    matrix = np.empty((3, 3, len(q)))
    matrix[0, 0], matrix[0, 1], matrix[0, 2] = 1.0 - yy - zz, xy - wz, xz + wy
    matrix[1, 0], matrix[1, 1], matrix[1, 2] = xy + wz, 1.0 - xx - zz, yz - wx
    matrix[2, 0], matrix[2, 1], matrix[2, 2] = xz - wy, yz + wx, 1.0 - xx - yy
    return matrix


def turn_to_left(v: Floats, yaw_rad: float) -> Floats:
    """Turn vectors, shape (n, 3), about the vertical by ``yaw_rad``, positive to the left seen from above."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    turned = v.copy()
    turned[:, 0] = c * v[:, 0] - s * v[:, 1]
    turned[:, 1] = s * v[:, 0] + c * v[:, 1]
    return turned


def twist_about_vertical(q: Floats) -> Floats:
    """Heading part of each rotation in radians, shape (n,): the turn about the vertical in the swing-twist
    decomposition.

    Unlike a yaw angle it has no singularity at ±90° of pitch, as a sensor on the back of a foot stands.
    """
    return 2.0 * np.arctan2(q[..., 3], q[..., 0])


def angular_rate(q: Floats, rate_hz: float) -> Floats:
    """Angular rate in the sensor frame, rad/s, shape (n, 3), from successive orientations; row i is the mean over
    (i − 1, i]."""
    step = multiply(conjugate(q[:-1]), q[1:])
    step = step * np.where(step[:, :1] < 0, -1.0, 1.0)
    length = np.linalg.norm(step[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(length, step[:, 0])
    scale = np.divide(angle, length, out=np.full_like(angle, 2.0), where=length > 1e-12)
    rates = step[:, 1:] * scale[:, None] * rate_hz
    return np.vstack([rates[:1], rates]) if len(rates) else np.zeros((len(q), 3))


def midway(q: Floats, gyr_radps: Floats, rate_hz: float) -> Floats:
    """Orientation in the middle of each sample's interval, shape (n, 4).

    A sample is the mean over the interval that ends with it, and so is its angular rate: the orientation half an
    interval earlier is q ⊗ exp(−ω/(2·rate)/2). With a foot that turns at 8 rad/s, half an interval of 10 ms is 2°.
    """
    w, x, y, z = np.ascontiguousarray(q.T)
    a, b, c = np.ascontiguousarray(gyr_radps.T) * (-0.25 / rate_hz)
    product = np.stack(
        [
            w - x * a - y * b - z * c,
            w * a + x + y * c - z * b,
            w * b - x * c + y + z * a,
            w * c + x * b - y * a + z,
        ]
    )
    square = product * product
    product /= np.sqrt(square[0] + square[1] + square[2] + square[3])
    return np.ascontiguousarray(product.T)
