"""The path of a foot from its rests: velocity, place and what is uncertain of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion import strapdown
from gaitlab.motion.displacement import foot_motion
from gaitlab.motion.free import Calibrated, Oriented
from gaitlab.motion.integration import position_of, reset_at_rests, velocity_of
from gaitlab.motion.model import FootMotion, Indices, Motion, Rests
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.passages import Passages, integrate, leaving
from gaitlab.motion.quaternions import cross, multiply
from gaitlab.motion.smoother import Fix, Known, Smoothed, smooth
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True)
class PathParams:
    """How far single samples are doubted.

    Attributes
    ----------
    white_mps2 : float
        Standard deviation of a sample at 100 Hz. MTw noise: 0.03; the rest is the sensor's play on the foot.
    averaged_share, sampled_share : float
        Error of a sample as a share of its difference from its neighbours, for a device that sends means over its intervals
        and for one that sends instants: 0.0025 explains the velocities left at the 1,500 passages of ``mtw-10m-walk``, taken
        twice; 0.1 those of ``foot-mocap``, where heel strikes fall between the samples.
    saturated_mps2 : float
        What a sample at the end of the range may hide.
    gap_share : float
        Error of the place in a gap as a share of acceleration times its duration squared: 1/12 for a linear change.
    blind_gap_s, blind_sd_m, blind_mps : float
        Over a longer gap the movement is not known and its displacement is uncertain by a stride, its velocity by a
        swing's.
    """

    white_mps2: float = 0.05
    averaged_share: float = 0.005
    sampled_share: float = 0.1
    saturated_mps2: float = 60.0
    gap_share: float = 1.0 / 12.0
    blind_gap_s: float = 0.3
    blind_sd_m: float = 0.7
    blind_mps: float = 2.0


@dataclass(frozen=True)
class Anchor:
    """What is known of the course and may be used for the path, where somebody says so; never by itself.

    Attributes
    ----------
    closed : bool
        Each foot's last rest is where its first was.
    way_m : float or None
        Horizontal distance from the first rest to the farthest.
    closed_sd_m, way_sd_m : float
        How exactly: after a turn the feet have changed sides; a foot rests within a step of a mark.
    """

    closed: bool = False
    way_m: float | None = None
    closed_sd_m: float = 0.2
    way_sd_m: float = 0.1

    def fixes(self, places_m: Floats) -> tuple[Fix, ...]:
        """Statements for the smoother, from the places of rest as they are without, shape (k, 3)."""
        fixes = []
        if self.closed:
            last = len(places_m) - 1
            fixes += [Fix(last, axis, 0.0, self.closed_sd_m) for axis in ((1.0, 0.0), (0.0, 1.0))]
        distance = np.linalg.norm(places_m[:, :2] - places_m[0, :2], axis=1)
        far = int(np.argmax(distance))
        if self.way_m is not None and distance[far] > 0.0:
            x, y = (places_m[far, :2] - places_m[0, :2]) / distance[far]
            fixes.append(Fix(far, (float(x), float(y)), self.way_m, self.way_sd_m))
        return tuple(fixes)


def follow(
    sensor: Sensor,
    calibrated: Calibrated,
    seen: Oriented,
    free: Motion,
    rests: Rests,
    tilt_change_rad: Floats,
    anchor: Anchor | None = None,
    params: PathParams | None = None,
) -> FootMotion:
    """Path of a foot that rests at least twice.

    Parameters
    ----------
    seen : Oriented
        By the orientation to begin with, level at the rests.
    free : Motion
        What it gives without resets.
    tilt_change_rad : ndarray (k − 1, 2)
        See ``Known``.
    anchor : Anchor or None
        What is known of the course; None: nothing.
    """
    p = params or PathParams()
    rate_hz = free.rate_hz
    force, rotation = seen.force_mps2, seen.rotation
    variance = _variance(force, sensor, p)
    passages = _passages(seen, variance, sensor, rests, p)
    smoothed = _smoothed(passages, calibrated, rests, rate_hz, tilt_change_rad, anchor)
    turn = _corrections(smoothed, rests, free.n_samples)
    acceleration = _corrected(force, rotation, turn, smoothed, rests)
    velocity, _ = reset_at_rests(velocity_of(acceleration, rate_hz), rests, np.cumsum(variance))
    position = position_of(velocity, rate_hz)
    position, velocity = _through(smoothed.place_m, position, velocity, rests.start, leaving(rests), rate_hz)
    attitude = multiply(strapdown.small_rotation(turn), free.attitude)
    residual = np.concatenate([np.zeros((1, 3)), passages.velocity_mps])
    moved = {
        "attitude": attitude,
        "rate_radps": free.rate_radps + cross(turn, free.rate_radps),
        "acceleration_mps2": acceleration,
        "velocity_mps": velocity,
        "position_m": position,
    }
    return foot_motion(
        moved,
        free,
        replace(rests, residual_mps=residual),
        smoothed.step_covariance,
        smoothed.covariance[:, :3, :3],
        passages.velocity_var,
        smoothed.level,
    )


def _passages(seen: Oriented, variance: Floats, sensor: Sensor, rests: Rests, p: PathParams) -> Passages:
    """The integrals from rest to rest, with what gaps hide."""
    passages = integrate(
        seen.force_mps2, seen.rotation, variance, rests, sensor.rate_hz, STANDARD_GRAVITY_MPS2
    )
    gaps, faster = _gap_variance(seen.force_mps2, sensor, rests, p)
    return replace(
        passages,
        displacement_var=passages.displacement_var + gaps,
        velocity_var=passages.velocity_var + faster,
    )


def _smoothed(
    passages: Passages,
    calibrated: Calibrated,
    rests: Rests,
    rate_hz: float,
    tilt_change_rad: Floats,
    anchor: Anchor | None,
) -> Smoothed:
    """The estimates at the rests; a second time with what is known of the course, where something is."""
    offsets, rest_s = calibrated.offsets, (rests.end - rests.start) / rate_hz
    known = Known(calibrated.up, offsets.standing, tilt_change_rad, offsets.drift_sd_radps, rest_s)
    smoothed = smooth(passages, known, STANDARD_GRAVITY_MPS2)
    if anchor is not None and (fixes := anchor.fixes(smoothed.place_m)):
        return smooth(passages, replace(known, fixes=fixes), STANDARD_GRAVITY_MPS2)
    return smoothed


def _variance(force: Floats, sensor: Sensor, p: PathParams) -> Floats:
    """Variance of each acceleration sample, per axis, shape (n,)."""
    change = np.diff(force, axis=0)
    square = np.zeros(len(force) + 1)
    square[1:-1] = np.einsum("ij,ij->i", change, change)
    share = p.averaged_share if sensor.averaged else p.sampled_share
    variance: Floats = share**2 * np.maximum(square[:-1], square[1:])
    variance += p.white_mps2**2 * sensor.rate_hz / 100.0
    variance[sensor.saturated] += p.saturated_mps2**2
    return variance


def _gap_variance(force: Floats, sensor: Sensor, rests: Rests, p: PathParams) -> tuple[Floats, Floats]:
    """What gaps add to the variances of each passage's displacement and velocity, per axis, shape (k − 1,) each.

    A device that sends the mean over a gap has lost the velocity of none but a blind one.
    """
    added, faster = np.zeros(len(rests) - 1), np.zeros(len(rests) - 1)
    if sensor.received.all():
        return added, faster
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~sensor.received, [False]]).astype(np.int8)))
    start, end = edges[::2], edges[1::2]
    duration_s = (end - start + 1) / sensor.rate_hz
    size = np.linalg.norm(force[start] - np.array([0.0, 0.0, STANDARD_GRAVITY_MPS2]), axis=1)
    variance = (p.gap_share * size * duration_s**2) ** 2
    blind = duration_s > p.blind_gap_s
    variance[blind] += p.blind_sd_m**2
    passage = np.searchsorted(rests.start[1:], start, "right")
    inside = (passage < len(added)) & (end > leaving(rests)[np.minimum(passage, len(added))])
    np.add.at(added, passage[inside], variance[inside])
    np.add.at(
        faster,
        passage[inside & blind],
        (p.gap_share * size * duration_s)[inside & blind] ** 2 + p.blind_mps**2,
    )
    return added, faster


def _corrections(smoothed: Smoothed, rests: Rests, n_rows: int) -> Floats:
    """Small turns of the orientation about the world's axes, linear between the rests, shape (n, 3)."""
    rows = np.arange(n_rows)
    at_rests = np.column_stack([smoothed.tilt_rad, smoothed.heading_rad])
    return np.stack([np.interp(rows, rests.moment, column) for column in at_rests.T], axis=1)


def _corrected(force: Floats, rotation: Floats, turn: Floats, smoothed: Smoothed, rests: Rests) -> Floats:
    """Free acceleration with the smoother's tilt and accelerometer offset, shape (n, 3)."""
    row_passage = np.clip(
        np.searchsorted(rests.moment, np.arange(len(force)), "right") - 1, 0, len(rests) - 1
    )
    offset = smoothed.offset_mps2[row_passage]
    acceleration: Floats = force + cross(turn, force) - strapdown.apply(rotation, offset)
    acceleration[:, 2] -= STANDARD_GRAVITY_MPS2
    return acceleration


def _through(
    place_m: Floats, position: Floats, velocity: Floats, reach: Indices, last: Indices, rate_hz: float
) -> tuple[Floats, Floats]:
    """Bend the path so that it passes through the places of rest, shape (k, 3).

    What is missing of each passage is added along 3u² − 2u³, the likeliest way of a white acceleration error between two
    standstills.
    """
    missing = np.diff(place_m, axis=0) - (position[reach[1:]] - position[last[:-1]])
    total = np.concatenate([np.zeros((1, 3)), np.cumsum(missing, axis=0)])
    knots = np.stack([last[:-1], reach[1:]], axis=1).ravel()
    phases = np.stack([np.arange(len(missing)), np.arange(1, len(missing) + 1)], axis=1).ravel()
    phase = np.interp(
        np.arange(len(position)), knots, phases
    )  # the passage's number, and how far it is along
    passage = np.minimum(phase.astype(np.intp), len(missing) - 1)
    u = phase - passage
    bent, faster = np.empty_like(position), np.empty_like(velocity)
    bend, slope = (
        u * u * (3.0 - 2.0 * u),
        6.0 * u * (1.0 - u) * (rate_hz / (reach[1:] - last[:-1]))[passage],
    )
    for axis in range(3):
        lacking = missing[passage, axis]
        bent[:, axis] = position[:, axis] + total[passage, axis] + lacking * bend
        faster[:, axis] = velocity[:, axis] + lacking * slope
    return bent, faster
