"""How a foot moved: orientation, free acceleration, offset, rests, velocity reset, path."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion import ikizoglu2018, strapdown
from gaitlab.motion.displacement import foot_motion
from gaitlab.motion.free import Calibrated, Oriented, calibrate, method_motion, moved, orientation, oriented
from gaitlab.motion.heading import heading_change
from gaitlab.motion.integration import position_of, reset_at_rests
from gaitlab.motion.magnetometer import with_field
from gaitlab.motion.model import FootMotion, Motion, Rests
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.orientation import OrientationSource
from gaitlab.motion.passages import leaving
from gaitlab.motion.path import Anchor, follow
from gaitlab.motion.quaternions import multiply, rotate
from gaitlab.motion.rest import restlessness, rests_in, unrest
from gaitlab.recording.model import Bools, Floats, Sensor


@dataclass(frozen=True)
class StrideEvidence:
    """What tells a movement of the foot from a fidget.

    Two rests between which the foot went less than ``min_length_m`` and turned less than ``min_turn_rad`` are one
    rest: half a sensor's length, and what a standing person's sway turns a foot.
    """

    min_length_m: float = 0.04
    min_turn_rad: float = 0.15


HEADING_FROM = {
    OrientationSource.STRAPDOWN: "gyroscope",
    OrientationSource.VQF: "gyroscope, by VQF",
    OrientationSource.DEVICE: "device's own orientation",
}
"""What a foot's heading rests on, for people."""


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
    calibrated, rate_hz = calibrate(sensor), sensor.rate_hz
    source = source or _best_source(sensor, calibrated)
    by_gyroscope = source is OrientationSource.STRAPDOWN
    if by_gyroscope:
        seen = oriented(calibrated, strapdown.integrate_rate(calibrated.gyr_radps, rate_hz), rate_hz)
        up = strapdown.mean_force(seen.force_mps2, rate_hz)
    else:
        seen = oriented(calibrated, orientation(sensor, calibrated, source), rate_hz)
        up = np.array([[0.0, 0.0, 1.0]])
    size = np.sqrt(np.einsum("ij,ij->i", up, up))
    gravity = up * (STANDARD_GRAVITY_MPS2 / np.maximum(size, 1e-9))[:, None]
    moving = unrest(seen.force_mps2 - gravity, calibrated.gyr_radps, rate_hz)
    found = rests_in(moving)
    tilt = np.zeros((len(found), 2))
    if by_gyroscope:
        attitude, tilt = _level(seen, up, found)
        seen = oriented(calibrated, attitude, rate_hz)
    free = moved(sensor, time_s, calibrated, seen)
    kept = _kept(free, found)
    rests = found if kept.all() else _joined(found, kept)
    if len(rests) < 2:
        foot = _unmoved(free, rests)
    else:
        foot = follow(sensor, calibrated, seen, free, rests, np.diff(tilt[kept], axis=0), anchor)
    foot = replace(foot, restlessness=restlessness(moving), heading_from=HEADING_FROM[source])
    return foot if source is OrientationSource.DEVICE else with_field(foot, sensor.mag)


def _best_source(sensor: Sensor, calibrated: Calibrated) -> OrientationSource:
    """The gyroscope alone where its offset is known from standing; VQF, which estimates it, where it is not."""
    if sensor.gyr_radps is None:
        return OrientationSource.DEVICE
    return OrientationSource.STRAPDOWN if calibrated.offsets.standing else OrientationSource.VQF


def _kept(free: Motion, rests: Rests, evidence: StrideEvidence | None = None) -> Bools:
    """True for each rest before which the foot moved away from the rest before it (the first counts as moved).

    By a path with the drift taken out in proportion to time: a velocity that should be zero at both ends of a passage has
    carried the place astray by its mean times the duration.
    """
    limits = evidence or StrideEvidence()
    if not len(rests):
        return np.zeros(0, dtype=np.bool_)
    last, first = leaving(rests)[:-1], rests.start[1:]
    velocity, position = free.raw_velocity_mps, free.raw_position_m
    astray = 0.5 * (velocity[last] + velocity[first]) * ((first - last) / free.rate_hz)[:, None]
    length = np.linalg.norm(position[first] - position[last] - astray, axis=1)
    turn = np.abs(heading_change(free, rests))
    return np.concatenate([[True], (length >= limits.min_length_m) | (turn >= limits.min_turn_rad)])


def _level(seen: Oriented, up: Floats, rests: Rests) -> tuple[Floats, Floats]:
    """The gyroscope's orientation made level at every rest, the correction linear between two; and the correction at
    each, about the horizontal axes, shape (k, 2). Without rests it is made level by the mean force.

    Within a passage the orientation is the gyroscope's own: its error there is a slow drift, which the smoother knows, and
    no answer to the accelerations of the swing.
    """
    if not len(rests):
        return strapdown.level_throughout(seen.attitude, up), np.zeros((0, 2))
    end = np.maximum(rests.end, rests.start + 1)
    running = np.concatenate([np.zeros((1, 3)), np.cumsum(seen.force_mps2, axis=0)])
    first = strapdown.upright(running[end[:1]] - running[rests.start[:1]])
    mean = rotate(first, running[end] - running[rests.start])
    tilt = 2.0 * strapdown.upright(mean)[:, 1:3]
    rows = np.arange(len(seen.attitude))
    correction = np.zeros((len(rows), 3))
    for k in range(2):
        correction[:, k] = np.interp(rows, rests.moment, tilt[:, k])
    return multiply(strapdown.small_rotation(correction), multiply(first, seen.attitude)), tilt


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
        moved, free, rests, np.zeros((0, 3, 3)), np.zeros((k, 3, 3)), np.zeros(0), np.zeros(0, dtype=np.bool_)
    )
