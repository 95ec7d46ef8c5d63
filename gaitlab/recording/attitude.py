"""Orientations as files write them, turned into quaternions that run without a jump of sign."""

from __future__ import annotations

import numpy as np

from gaitlab.recording.model import Floats

# A turn by half a revolution about the line between east and north takes north-east-down to east-north-up.
_NED_TO_ENU = np.array([0.0, 0.5**0.5, 0.5**0.5, 0.0])


def from_euler(roll_deg: Floats, pitch_deg: Floats, yaw_deg: Floats) -> Floats:
    """Quaternion of Xsens' Euler angles: R = Rz(yaw) Ry(pitch) Rx(roll), sensor to world.

    Xsens MTi Family Reference Manual, "Orientation output": ZYX, aerospace sequence. Angles have shape (n,).
    """
    half = np.deg2rad(np.stack([roll_deg, pitch_deg, yaw_deg])) / 2
    (cr, cp, cy), (sr, sp, sy) = np.cos(half), np.sin(half)
    return np.stack(
        [
            cy * cp * cr + sy * sp * sr,
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
        ],
        axis=1,
    )


def from_matrix(matrix: Floats) -> Floats:
    """Quaternion of rotation matrices (n, 3, 3), sensor to world, by the largest of its four components.

    Shepperd 1978, J. Guidance and Control 1(3), 223: the other three follow without loss of digits.
    """
    m = matrix
    diagonal = np.stack([m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]], axis=1)
    trace = diagonal.sum(axis=1)
    wx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 1, 0] + m[:, 0, 1]
    wy, xz = m[:, 0, 2] - m[:, 2, 0], m[:, 0, 2] + m[:, 2, 0]
    wz, yz = m[:, 1, 0] - m[:, 0, 1], m[:, 2, 1] + m[:, 1, 2]
    ww = 1 + trace
    xx, yy, zz = (1 + 2 * diagonal - trace[:, None]).T
    candidates = np.stack(
        [
            np.stack([ww, wx, wy, wz], axis=1),
            np.stack([wx, xx, xy, xz], axis=1),
            np.stack([wy, xy, yy, yz], axis=1),
            np.stack([wz, xz, yz, zz], axis=1),
        ]
    )
    largest = np.argmax(np.stack([ww, xx, yy, zz]), axis=0)
    return unit(candidates[largest, np.arange(len(m))])


def unit(quaternion: Floats) -> Floats:
    """The same rotations with norm 1; shape (n, 4)."""
    norm = np.sqrt(np.einsum("ij,ij->i", quaternion, quaternion))
    return np.asarray(quaternion / norm[:, None])


def continuous(quaternion: Floats) -> Floats:
    """The same rotations, each with the sign that is nearer to the one before it."""
    turned = np.einsum("ij,ij->i", quaternion[1:], quaternion[:-1]) < 0
    sign = np.where(np.cumsum(turned) % 2, -1.0, 1.0)
    return np.concatenate([quaternion[:1], quaternion[1:] * sign[:, None]])


def ned_to_enu(quaternion: Floats) -> Floats:
    """The same orientations, told in a world whose z axis points up."""
    return multiply(_NED_TO_ENU[None, :], quaternion)


def multiply(p: Floats, q: Floats) -> Floats:
    """Hamilton product p q, shape (n, 4) each or broadcast."""
    pw, px, py, pz = np.moveaxis(p, -1, 0)
    qw, qx, qy, qz = np.moveaxis(q, -1, 0)
    return np.stack(
        [
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ],
        axis=-1,
    )


def up_component(quaternion: Floats, vector: Floats) -> Floats:
    """World z component of vectors given in the sensor's frame; shapes (n, 4) and (n, 3) give (n,)."""
    w, x, y, z = quaternion.T
    third_row = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)
    return np.asarray(np.einsum("ij,ij->i", third_row, vector))


def rotation_angle_rad(quaternion: Floats) -> Floats:
    """Angle between successive orientations, shape (n − 1,)."""
    dot = np.abs(np.einsum("ij,ij->i", quaternion[1:], quaternion[:-1]))
    return np.asarray(2 * np.arccos(np.minimum(dot, 1.0)))


def slerp(before: Floats, after: Floats, share: Floats) -> Floats:
    """Orientation at ``share`` (n,) of the way from ``before`` to ``after`` (n, 4) at constant angular rate.

    Shoemake 1985, SIGGRAPH Computer Graphics 19(3), 245.
    """
    dot = np.einsum("ij,ij->i", before, after)
    after = after * np.where(dot < 0, -1.0, 1.0)[:, None]
    angle = np.arccos(np.minimum(np.abs(dot), 1.0))
    sine = np.sin(angle)
    near = sine < 1e-6
    safe = np.where(near, 1.0, sine)
    first = np.where(near, 1 - share, np.sin((1 - share) * angle) / safe)
    second = np.where(near, share, np.sin(share * angle) / safe)
    return unit(first[:, None] * before + second[:, None] * after)
