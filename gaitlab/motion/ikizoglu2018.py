"""The source paper's method to the letter, selectable as ``--method ikizoglu2018``.

İkizoğlu, Şahin, Ataş, Kara, Çakar, "IMU Acceleration Drift Compensation for Position Tracking in Ambulatory Gait
Analysis", 2018.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion.displacement import foot_motion
from gaitlab.motion.integration import position_of, velocity_of
from gaitlab.motion.model import FootMotion, Motion, Rests
from gaitlab.motion.passages import leaving
from gaitlab.motion.rest import restlessness, unrest
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True)
class PaperParams:
    """The paper's constants.

    Attributes
    ----------
    rest_acceleration_mps2 : float
        Resultant of the free acceleration below which the foot is motionless; §3.3.
    rest_duration_s : float
        5 successive samples at the paper's 100 Hz; §3.3.
    offset_start_s, offset_end_s : float
        Span of standing over which the offset is averaged; §3.2.
    """

    rest_acceleration_mps2: float = 0.15
    rest_duration_s: float = 0.05
    offset_start_s: float = 2.0
    offset_end_s: float = 3.0


def free_motion(sensor: Sensor, estimated: Motion, params: PaperParams | None = None) -> Motion:
    """Free acceleration as the paper takes it: the device's own, its mean from 2 s to 3 s removed per axis.

    Deviations: where the file has no free acceleration, it is computed from the device's orientation, or from an
    estimated one where there is none, with the sensor's static offsets removed; where the foot does not stand from
    2 s to 3 s, the mean is taken over the standing that was found.
    """
    p = params or PaperParams()
    acceleration = sensor.free_acc_mps2 if sensor.free_acc_mps2 is not None else estimated.acceleration_mps2
    rate_hz = estimated.rate_hz
    start, end = round(p.offset_start_s * rate_hz), round(p.offset_end_s * rate_hz)
    if not estimated.offsets.as_in_paper:
        start, end = estimated.offsets.start, estimated.offsets.end
    acceleration = acceleration - acceleration[start:end].mean(axis=0)
    velocity = velocity_of(acceleration, rate_hz)
    return replace(
        estimated,
        acceleration_mps2=acceleration,
        raw_velocity_mps=velocity,
        raw_position_m=position_of(velocity, rate_hz),
    )


def find_rests(acceleration_mps2: Floats, rate_hz: float, params: PaperParams | None = None) -> Rests:
    """Rests: the resultant of the free acceleration stays below 0.15 m/s² for at least 5 successive samples (§3.3).

    The moment of each rest is its middle row. On ``mtw-10m-walk`` this finds 5 % of the stances: it depends on how
    well gravity was removed, instant by instant.
    """
    p = params or PaperParams()
    still = np.linalg.norm(acceleration_mps2, axis=1) < p.rest_acceleration_mps2
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(np.int8)))
    start, end = edges[::2], edges[1::2]
    long = end - start >= max(1, round(p.rest_duration_s * rate_hz))
    start, end = start[long], end[long]
    return Rests(start, end, (start + end) // 2, np.zeros((len(start), 3)))


def reset_at_rests(acceleration_mps2: Floats, rests: Rests, rate_hz: float) -> tuple[Floats, Rests]:
    """Velocity that starts from zero at the end of every rest and is zero within (§3.2, fig. 2).

    Nothing is removed between two rests: what the drift has grown to shows as a jump at the next one.
    """
    raw = velocity_of(acceleration_mps2, rate_hz)
    if not len(rests):
        return raw, rests
    last = np.maximum(rests.end - 1, rests.start)
    since = np.searchsorted(last, np.arange(len(raw)), side="right") - 1
    held = np.where(since[:, None] >= 0, raw[last[np.maximum(since, 0)]], 0.0)
    velocity = raw - held
    residual = velocity[rests.start].copy()
    velocity[rests.mask(len(raw))] = 0.0
    return velocity, replace(rests, residual_mps=residual)


def track_foot(free: Motion) -> FootMotion:
    """Path of a foot as the paper takes it, from its free acceleration.

    Uncertainty: nothing is removed between rests, so that an acceleration error that is white over a swing of duration T
    and leaves the velocity Δv makes a position error of Δv·T/√3; Δv is the RMS of the stride's own and the recording's.
    """
    rests = find_rests(free.acceleration_mps2, free.rate_hz)
    velocity, rests = reset_at_rests(free.acceleration_mps2, rests, free.rate_hz)
    moved = {"velocity_mps": velocity, "position_m": position_of(velocity, free.rate_hz)}
    k = max(len(rests) - 1, 0)
    swing_s = (rests.start[1:] - leaving(rests)[:-1]) / free.rate_hz
    own = np.einsum("ij,ij->i", rests.residual_mps[1:, :2], rests.residual_mps[1:, :2]) / 2.0
    variance = 0.5 * (own + (own.mean() if k else 0.0)) * swing_s**2 / 3.0
    steps = variance[:, None, None] * np.eye(3)
    places = np.concatenate([np.zeros((min(len(rests), 1), 3, 3)), np.cumsum(steps, axis=0)])
    foot = foot_motion(moved, free, rests, steps, places, own, np.zeros(k, dtype=np.bool_))
    found = unrest(free.acceleration_mps2, free.rate_radps, free.rate_hz)
    return replace(foot, restlessness=restlessness(found))


def correct_knee(
    raw_velocity_mps: Floats, cycles: list[tuple[int, int]], foot_displacement_m: Floats, rate_hz: float
) -> Floats:
    """Knee velocity whose displacement over each cycle is the foot's step, on x and on y (§3.3, fig. 4, 5).

    In each cycle a constant velocity offset is removed; rows outside all cycles take the offset of the nearest. The
    height is treated alike: a walk on the flat does not climb.

    Parameters
    ----------
    cycles : list of (start, end)
        From the foot's leaving one rest to its leaving the next.
    foot_displacement_m : ndarray (m, 3)
    """
    velocity = raw_velocity_mps.copy()
    position = position_of(raw_velocity_mps, rate_hz)
    for k, (start, end) in enumerate(cycles):
        offset = (position[end] - position[start] - foot_displacement_m[k]) / ((end - start) / rate_hz)
        low = 0 if k == 0 else start
        high = len(velocity) if k == len(cycles) - 1 else end
        velocity[low:high] -= offset
    return velocity
