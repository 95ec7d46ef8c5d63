"""What the sensors say of a foot's passage from one rest to the next: running integrals, once for all that follows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import Indices, Rests
from gaitlab.recording.model import Floats

STATES = 7
"""What an integral depends on: tilt (2) at the rest before, tilt (2) at the rest after, accelerometer offset (3)."""


@dataclass(frozen=True, eq=False)
class Passages:
    """Passages of a foot from each of its k rests to the next, arrays of k − 1.

    Attributes
    ----------
    duration_s : ndarray
        From the last row of the rest before to the first of the rest after.
    apart_s : ndarray
        From the quietest moment of the one to that of the other.
    velocity_mps, displacement_m : ndarray (k − 1, 3)
        Integrals of the free acceleration; the displacement as if the velocity at the end were taken out where the
        acceleration is doubtful (``late_s`` before the end on average).
    velocity_by, displacement_by : ndarray (k − 1, 3, 7)
        Their derivatives by tilt before, tilt after and accelerometer offset.
    velocity_var, displacement_var : ndarray
        What the doubt about single samples makes of them, per axis; independent of each other.
    late_s : ndarray
    rotation : ndarray (k, 3, 3)
        Mean rotation, sensor to world, in each rest.
    force_mps2 : ndarray (k, 3)
        Mean specific force in each rest, world.
    """

    duration_s: Floats
    apart_s: Floats
    velocity_mps: Floats
    displacement_m: Floats
    velocity_by: Floats
    displacement_by: Floats
    velocity_var: Floats
    displacement_var: Floats
    late_s: Floats
    rotation: Floats
    force_mps2: Floats


def leaving(rests: Rests) -> Indices:
    """Last row of each rest."""
    return np.maximum(rests.end - 1, rests.start)


def integrate(
    force_mps2: Floats, rotation: Floats, variance: Floats, rests: Rests, rate_hz: float, gravity_mps2: float
) -> Passages:
    """Integrate from rest to rest.

    Parameters
    ----------
    force_mps2 : ndarray (n, 3)
        Specific force, world, sensor's known offset removed.
    rotation : ndarray (3, 3, n)
        Sensor to world in the middle of each sample's interval.
    variance : ndarray (n,)
        Of each acceleration sample, per axis, (m/s²)².
    """
    dt = 1.0 / rate_hz
    last, first = leaving(rests)[:-1], rests.start[1:]
    low, high = int(last[0]) + 1, int(first[-1]) + 1
    rows = np.arange(low, high)
    passage = np.repeat(np.arange(len(first)), np.diff(first + 1, prepend=low))
    left_s = (first[passage] - rows + 0.5) * dt
    moment = rests.moment
    share = (rows - moment[passage]) / (moment[passage + 1] - moment[passage])
    columns = np.empty((33, high - low))
    columns[:3] = force_mps2[low:high].T
    columns[3:12] = rotation.reshape(9, -1)[:, low:high]
    np.multiply(columns[:3], share, out=columns[12:15])
    np.multiply(variance[low:high], dt, out=columns[15])
    np.multiply(columns[:16], left_s, out=columns[16:32])
    np.multiply(columns[31], left_s, out=columns[32])
    sums = _sums(columns, last + 1 - low, first + 1 - low).T * dt
    end = np.maximum(rests.end, rests.start + 1)
    resting = [_sums(one, rests.start, end) for one in (force_mps2.T, rotation.reshape(9, -1))]
    force, turn = ((total / (end - rests.start)).T for total in resting)
    apart_s, duration_s = np.diff(moment) * dt, np.asarray(first - last, dtype=np.float64) * dt
    return _assemble(sums, apart_s, duration_s, gravity_mps2, (turn.reshape(-1, 3, 3), force))


def _sums(columns: Floats, start: Indices, end: Indices) -> Floats:
    """Sums of each row of ``columns`` (m, n) over the spans ``[start, end)``, in order and apart; shape (m, k)."""
    borders = np.stack([start, end], axis=1).ravel()
    if borders[-1] == columns.shape[1]:
        borders = borders[:-1]
    return np.asarray(np.add.reduceat(columns, borders, axis=1)[:, ::2])


def _assemble(
    sums: Floats,
    apart_s: Floats,
    duration_s: Floats,
    gravity_mps2: float,
    at_rest: tuple[Floats, Floats],
) -> Passages:
    """Put the sums (k − 1, 33) in their places: 16 plain ones, the same weighted by the time left, one by its square."""
    velocity, velocity_by, total = _one(sums[:, :16])
    displacement, displacement_by, first_moment = _one(sums[:, 16:32])
    velocity[:, 2] -= gravity_mps2 * duration_s
    displacement[:, 2] -= 0.5 * gravity_mps2 * duration_s**2
    late = first_moment / total
    return Passages(
        duration_s,
        apart_s,
        velocity,
        displacement - late[:, None] * velocity,
        velocity_by,
        displacement_by - late[:, None, None] * velocity_by,
        total,
        np.maximum(sums[:, 32] - late * first_moment, 0.0),
        late,
        *at_rest,
    )


def _one(sums: Floats) -> tuple[Floats, Floats, Floats]:
    """Integral of the force, its derivatives, and the moment of the doubt."""
    force, rotation, after = sums[:, :3], sums[:, 3:12].reshape(-1, 3, 3), sums[:, 12:15]
    by = np.empty((len(sums), 3, STATES))
    by[:, :, :2] = tilting(force - after)
    by[:, :, 2:4] = tilting(after)
    by[:, :, 4:] = -rotation
    return force.copy(), by, sums[:, 15]


def tilting(force: Floats) -> Floats:
    """Derivative of a force (k, 3) by a small tilt about the two horizontal axes, (k, 3, 2): φ × s."""
    by = np.zeros((len(force), 3, 2))
    by[:, 1, 0], by[:, 2, 0] = -force[:, 2], force[:, 1]
    by[:, 0, 1], by[:, 2, 1] = force[:, 2], -force[:, 0]
    return by
