"""A thigh that swings like a pendulum over a foot that rests while the hip passes it, with readings of known truth."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from gaitlab.methods.thigh_model import ThighView
from gaitlab.motion.model import FootMotion, KneeMotion, Rests
from gaitlab.recording.model import Side
from tests import walks

GRAVITY = 9.80665
STAND_S, CYCLE_S, STRIDES = 3.0, 1.0, 8


@dataclass(frozen=True, eq=False)
class Thigh:
    """What the methods are given, and the thigh's true orientation, pitch, rests and forward rows."""

    view: ThighView
    truth: Rotation
    forward: np.ndarray


def swinging_thigh(
    *,
    rate_hz: float = 100.0,
    swing_deg: float = 40.0,
    roll_deg: float = 0.0,
    heading_deg: float = 0.0,
    turn_deg: float = 0.0,
    mount: Rotation | None = None,
    stride_m: float = 1.2,
) -> Thigh:
    """Stand, ``STRIDES`` strides (the first of half a swing), stand; in the middle the walk turns by ``turn_deg``."""
    n = round((2.0 * STAND_S + STRIDES * CYCLE_S) * rate_hz)
    time = np.arange(n + 1) / rate_hz
    phase = 2.0 * np.pi * np.clip((time - STAND_S) / CYCLE_S, 0.0, STRIDES)
    walking = (phase > 0.0) & (phase < 2.0 * np.pi * STRIDES)
    pitch = -0.5 * np.radians(swing_deg) * np.sin(phase)
    middle = 0.5 * (time[-1] - 0.5 * CYCLE_S)  # a quarter cycle before a forward row, where the leg swings
    heading = np.radians(heading_deg) + np.radians(turn_deg) * np.clip((time - middle) / 0.1, 0.0, 1.0)
    roll = (
        np.radians(roll_deg) * walking * np.minimum(1.0, phase) * np.minimum(1.0, 2 * np.pi * STRIDES - phase)
    )
    truth = Rotation.from_euler("ZXY", np.column_stack([heading, roll, pitch]))
    sensor = truth * (mount or Rotation.identity())
    gyr = (sensor[:-1].inv() * sensor[1:]).as_rotvec() * rate_hz
    half = sensor[:-1] * Rotation.from_rotvec(0.5 * gyr / rate_hz)
    acc = half.inv().apply([0.0, 0.0, GRAVITY])
    foot = _foot(n, rate_hz, stride_m)
    motion = _leg(n, rate_hz, sensor[1:])
    standing = (0, round(0.9 * STAND_S * rate_hz))
    view = ThighView(Side.LEFT, rate_hz, time[1:], acc, gyr, standing, foot, 0, motion)
    forward = np.round((STAND_S + CYCLE_S * (np.arange(STRIDES) + 0.25)) * rate_hz).astype(int) - 1
    return Thigh(view, truth[1:], forward)


def _foot(n: int, rate_hz: float, stride_m: float) -> FootMotion:
    """It rests while the thigh goes back fastest, and where the person stands."""
    middle = STAND_S + CYCLE_S * (np.arange(STRIDES - 1) + 0.5)
    starts = np.concatenate([[0.0], middle - 0.1, [STAND_S + CYCLE_S * STRIDES]])
    ends = np.concatenate([[STAND_S], middle + 0.1, [n / rate_hz]])
    start, end = (np.round(one * rate_hz).astype(np.intp) for one in (starts, ends))
    rests = Rests(start, end, (start + end) // 2, np.zeros((len(start), 3)))
    place = np.zeros((n, 3))
    place[:, 0] = np.interp(np.arange(n), rests.moment, stride_m * np.arange(len(start)))
    base = walks.analysed().gait.feet[Side.LEFT].motion
    return replace(base, **_motion(n, rate_hz, np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)), place), rests=rests)


def _leg(n: int, rate_hz: float, sensor: Rotation) -> KneeMotion:
    place = np.zeros((n, 3))
    place[:, 0] = np.arange(n) / rate_hz
    base = walks.analysed().gait.knees[Side.LEFT].motion
    return replace(base, **_motion(n, rate_hz, sensor.as_quat(scalar_first=True), place))


def _motion(n: int, rate_hz: float, attitude: np.ndarray, place: np.ndarray) -> dict[str, Any]:
    """What the methods read of a movement; the rest stays that of a simulated walk."""
    return {"rate_hz": rate_hz, "time_s": np.arange(n) / rate_hz, "attitude": attitude, "position_m": place}
