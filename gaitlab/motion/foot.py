"""How a foot moved: orientation, free acceleration, offset, rests, velocity reset, path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.motion import ikizoglu2018
from gaitlab.motion.integration import (
    PathUncertainty,
    displacement_sd,
    position_of,
    reset_at_rests,
    velocity_of,
)
from gaitlab.motion.model import FootMotion, Motion, Offsets, Rests
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2, find_offsets
from gaitlab.motion.orientation import OrientationSource, estimate
from gaitlab.motion.quaternions import conjugate, midway, multiply, rotate, twist_about_vertical
from gaitlab.motion.rest import find_rests
from gaitlab.motion.signals import signals_of
from gaitlab.recording.model import Bools, Floats, Sensor


@dataclass(frozen=True)
class StrideEvidence:
    """What tells a movement of the foot from a fidget.

    Two rests between which the foot went less than ``min_length_m`` and turned less than ``min_turn_rad`` are one
    rest: half a sensor's length, and what a standing person's sway turns a foot.
    """

    min_length_m: float = 0.04
    min_turn_rad: float = 0.15


def free_motion(sensor: Sensor, time_s: Floats, source: OrientationSource | None = None) -> Motion:
    """Movement of any sensor up to its uncorrected integrals: orientation, offsets, free acceleration.

    ``source`` None takes VQF where the file has a gyroscope, else the device's orientation.
    """
    signals = signals_of(sensor)
    offsets = find_offsets(sensor, signals.acc_mps2, signals.gyr_radps)
    acc = signals.acc_mps2 - np.array(offsets.acc_mps2)
    gyr = signals.gyr_radps - np.array(offsets.gyr_radps)
    own = sensor.attitude if chosen_source(sensor, source) is OrientationSource.DEVICE else None
    attitude = own if own is not None else estimate(acc, gyr, sensor.rate_hz)
    acceleration = remove_gravity(rotate(midway(attitude, gyr, sensor.rate_hz), acc), offsets)
    velocity = velocity_of(acceleration, sensor.rate_hz)
    position = position_of(velocity, sensor.rate_hz)
    return Motion(
        sensor.placement,
        sensor.rate_hz,
        time_s,
        sensor.received,
        sensor.saturated,
        attitude,
        rotate(attitude, gyr),
        acceleration,
        velocity,
        position,
        velocity,
        position,
        offsets,
    )


def method_motion(sensor: Sensor, time_s: Floats, method: str, source: OrientationSource | None) -> Motion:
    """``free_motion``, or for ``ikizoglu2018`` the free acceleration as the paper takes it: the device's."""
    if method != "ikizoglu2018":
        return free_motion(sensor, time_s, source)
    if source is None and sensor.attitude is not None:
        source = OrientationSource.DEVICE
    return ikizoglu2018.free_motion(sensor, free_motion(sensor, time_s, source))


def chosen_source(sensor: Sensor, source: OrientationSource | None) -> OrientationSource:
    """Where a sensor's orientation comes from: what was asked for, else VQF where there is a gyroscope.

    Raises
    ------
    InputError
        If the device's orientation is asked for and the file has none.
    """
    if source is OrientationSource.DEVICE and sensor.attitude is None:
        raise InputError(
            "no_device_orientation",
            f"The {sensor.placement.label} has no orientation of the device's own.",
            "Export a quaternion or rotation matrix, or let the orientation be estimated.",
            file=sensor.source.name,
        )
    if source is None:
        return OrientationSource.VQF if sensor.gyr_radps is not None else OrientationSource.DEVICE
    return source


def remove_gravity(force: Floats, offsets: Offsets) -> Floats:
    """Free acceleration from specific force in world axes, shape (n, 3): without gravity and without its static
    offset.

    What is left while standing is a tilt of the orientation by a fraction of a degree; its mean is subtracted
    (İkizoğlu et al. 2018, §3.2).
    """
    acceleration: Floats = force - np.array([0.0, 0.0, STANDARD_GRAVITY_MPS2])
    if offsets.standing:
        acceleration -= acceleration[offsets.start : offsets.end].mean(axis=0)
    return acceleration


def track_foot(
    sensor: Sensor, time_s: Floats, method: str = "gaitlab", source: OrientationSource | None = None
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
    """
    free = method_motion(sensor, time_s, method, source)
    if method == "ikizoglu2018":
        uncertainty = ikizoglu2018.UNCERTAINTY
        rests = ikizoglu2018.find_rests(free.acceleration_mps2, free.rate_hz)
        velocity, rests = ikizoglu2018.reset_at_rests(free.acceleration_mps2, rests, free.rate_hz)
    else:
        uncertainty = PathUncertainty()
        found = find_rests(free.acceleration_mps2, free.rate_radps, free.rate_hz)
        velocity, rests = reset_at_rests(free.raw_velocity_mps, found)
        keep = _moved_before(free, rests, position_of(velocity, free.rate_hz))
        if not keep.all():
            velocity, rests = reset_at_rests(free.raw_velocity_mps, _joined(found, keep))
    position = position_of(velocity, free.rate_hz)
    return _foot_motion(free, velocity, position, rests, uncertainty)


def heading_change(motion: Motion, rests: Rests) -> Floats:
    """Turn of a foot about the vertical from each rest to the next, radians, positive to the left, shape (k − 1,).

    Taken from the two orientations; the integrated angular rate decides between a turn and its complement to 360°.
    """
    stance = motion.attitude[rests.moment]
    turn = twist_about_vertical(multiply(stance[1:], conjugate(stance[:-1])))
    swept = np.concatenate([[0.0], np.cumsum(motion.rate_radps[:, 2])]) / motion.rate_hz
    swept = np.diff(swept[rests.moment])
    change: Floats = turn + 2.0 * np.pi * np.round((swept - turn) / (2.0 * np.pi))
    return change


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


def _foot_motion(
    free: Motion, velocity: Floats, position: Floats, rests: Rests, uncertainty: PathUncertainty
) -> FootMotion:
    gravity_error = abs(free.offsets.gravity_mps2 / STANDARD_GRAVITY_MPS2 - 1.0)
    length = np.linalg.norm(np.diff(position[rests.moment], axis=0)[:, :2], axis=1)
    share, longest_gap_s = _doubts(free, rests)
    sd = displacement_sd(rests, free.rate_hz, gravity_error, length, share, uncertainty)
    blind = longest_gap_s > uncertainty.blind_gap_s
    sd[blind] = np.hypot(sd[blind], uncertainty.blind_sd_m)
    kept = vars(free) | {"velocity_mps": velocity, "position_m": position}
    return FootMotion(**kept, rests=rests, displacement_sd_m=sd, doubtful_share=share)


def _doubts(free: Motion, rests: Rests) -> tuple[Floats, Floats]:
    """Share of lost or saturated rows in each movement from rest to rest, and its longest gap in seconds."""
    leave, reach = np.maximum(rests.end - 1, rests.start)[:-1], rests.start[1:]
    bad = np.concatenate([[0], np.cumsum(~free.received | free.saturated)])
    share = (bad[reach] - bad[leave]) / np.maximum(reach - leave, 1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~free.received, [False]]).astype(np.int8)))
    gap_start, gap_end = edges[::2], edges[1::2]
    longest = np.zeros(len(leave))
    for k in range(len(leave)):
        low, high = np.searchsorted(gap_end, leave[k], "right"), np.searchsorted(gap_start, reach[k], "left")
        if high > low:
            longest[k] = (gap_end[low:high] - gap_start[low:high]).max() / free.rate_hz
    return share, longest
