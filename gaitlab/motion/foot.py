"""How a foot moved: orientation, free acceleration, offset, rests, velocity reset, path."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion import ikizoglu2018, strapdown
from gaitlab.motion.displacement import foot_motion
from gaitlab.motion.free import Calibrated, calibrate, method_motion, moved, orientation
from gaitlab.motion.heading import heading_change
from gaitlab.motion.integration import position_of, reset_at_rests
from gaitlab.motion.magnetometer import with_field
from gaitlab.motion.model import FootMotion, Motion, Rests
from gaitlab.motion.orientation import OrientationSource
from gaitlab.motion.path import Anchor, follow
from gaitlab.motion.quaternions import matrices, midway, multiply, rotate
from gaitlab.motion.rest import find_rests
from gaitlab.recording.model import Bools, Floats, Sensor


@dataclass(frozen=True)
class StrideEvidence:
    """What tells a movement of the foot from a fidget.

    Two rests between which the foot went less than ``min_length_m`` and turned less than ``min_turn_rad`` are one
    rest: half a sensor's length, and what a standing person's sway turns a foot.
    """

    min_length_m: float = 0.04
    min_turn_rad: float = 0.15


def track_foot(
    sensor: Sensor,
    time_s: Floats,
    method: str = "gaitlab",
    source: OrientationSource | None = None,
    anchor: Anchor | None = None,
) -> FootMotion:
    """Reconstruct how a foot moved.

    Parameters
    ----------
    sensor : Sensor
        Of a foot.
    time_s : ndarray (n,)
        Times of its rows.
    method : str
        ``gaitlab``, or ``ikizoglu2018`` for the paper to the letter.
    source : OrientationSource or None
        Where the orientation comes from; None lets the data decide.
    anchor : Anchor or None
        What is known of the course and is to be used; the paper's method uses nothing of the kind.
    """
    if method == "ikizoglu2018":
        return ikizoglu2018.track_foot(method_motion(sensor, time_s, method, source))
    calibrated = calibrate(sensor)
    source = source or _best_source(sensor, calibrated)
    turned = None
    if source is OrientationSource.STRAPDOWN:
        turned = strapdown.integrate_rate(calibrated.gyr_radps, sensor.rate_hz)
    free = moved(sensor, time_s, calibrated, orientation(sensor, calibrated, source, turned))
    rests = _rests(free)
    if len(rests) < 2:
        return _unmoved(free, rests)
    tilt_change = np.zeros((len(rests) - 1, 2))
    if turned is not None:
        attitude, tilt_change = _level_at_rests(turned, calibrated, rests, sensor.rate_hz)
        free = replace(free, attitude=attitude)
    return with_field(follow(sensor, calibrated, free, rests, tilt_change, anchor), sensor.mag)


def _best_source(sensor: Sensor, calibrated: Calibrated) -> OrientationSource:
    """The gyroscope alone where its offset is known from standing; VQF, which estimates it, where it is not."""
    if sensor.gyr_radps is None:
        return OrientationSource.DEVICE
    return OrientationSource.STRAPDOWN if calibrated.offsets.standing else OrientationSource.VQF


def _rests(free: Motion) -> Rests:
    """Rests between which the foot moved, by a path with the drift taken out in proportion to time."""
    found = find_rests(free.acceleration_mps2, free.rate_radps, free.rate_hz)
    velocity, rests = reset_at_rests(free.raw_velocity_mps, found)
    keep = _moved_before(free, rests, position_of(velocity, free.rate_hz))
    return rests if keep.all() else _joined(rests, keep)


def _level_at_rests(
    turned: Floats, calibrated: Calibrated, rests: Rests, rate_hz: float
) -> tuple[Floats, Floats]:
    """The gyroscope's orientation made level at every rest, the correction linear between two; and how much it
    changes from rest to rest about the horizontal axes, shape (k − 1, 2).

    Within a passage the orientation is the gyroscope's own: its error there is a slow drift, which the smoother knows, and
    no answer to the accelerations of the swing.
    """
    force = strapdown.apply(matrices(midway(turned, calibrated.gyr_radps, rate_hz)), calibrated.acc_mps2)
    end = np.maximum(rests.end, rests.start + 1)
    running = np.concatenate([np.zeros((1, 3)), np.cumsum(force, axis=0)])
    first = strapdown.upright(running[end[:1]] - running[rests.start[:1]])
    mean = rotate(first, running[end] - running[rests.start])
    tilt = 2.0 * strapdown.upright(mean)[:, 1:3]
    rows = np.arange(len(turned))
    correction = np.zeros((len(turned), 3))
    for k in range(2):
        correction[:, k] = np.interp(rows, rests.moment, tilt[:, k])
    attitude = multiply(strapdown.small_rotation(correction), multiply(first, turned))
    return attitude, np.diff(tilt, axis=0)


def _moved_before(
    free: Motion, rests: Rests, position: Floats, evidence: StrideEvidence | None = None
) -> Bools:
    """True for each rest before which the foot moved away from the rest before it (the first counts as moved)."""
    limits = evidence or StrideEvidence()
    if not len(rests):
        return np.zeros(0, dtype=np.bool_)
    length = np.linalg.norm(np.diff(position[rests.moment], axis=0), axis=1)
    turn = np.abs(heading_change(free, rests))
    return np.concatenate([[True], (length >= limits.min_length_m) | (turn >= limits.min_turn_rad)])


def _joined(rests: Rests, moved: Bools) -> Rests:
    """Join each rest that is not a new one to the rest before it."""
    first = np.flatnonzero(moved)
    last = np.append(first[1:], len(rests)) - 1
    return Rests(rests.start[first], rests.end[last], rests.moment[first], rests.residual_mps[first])


def _unmoved(free: Motion, rests: Rests) -> FootMotion:
    """A foot that rests once or never: nothing between rests is known."""
    velocity, rests = reset_at_rests(free.raw_velocity_mps, rests)
    moved = {"velocity_mps": velocity, "position_m": position_of(velocity, free.rate_hz)}
    k = len(rests)
    return foot_motion(
        moved, free, rests, np.zeros((0, 3, 3)), np.zeros((k, 3, 3)), np.zeros(0, dtype=np.bool_)
    )
