"""A thigh that swings like a pendulum over a foot that rests while the hip passes it, with readings of known truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from gaitlab.methods.thigh_model import ThighView
from gaitlab.motion.model import FootMotion, KneeMotion, Offsets, Rests
from gaitlab.recording.model import Placement, Side

GRAVITY = 9.80665
NO_OFFSETS = Offsets(0, 300, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), True, GRAVITY, 0.0)
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
    k = len(start)
    return FootMotion(
        **_motion(n, rate_hz, Placement.LEFT_FOOT, np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)), place),
        rests=rests,
        displacement_sd_m=np.zeros(k - 1),
        scale_sd=0.0,
        doubtful_share=np.zeros(k - 1),
        step_covariance_m2=np.zeros((k - 1, 3, 3)),
        place_covariance_m2=np.zeros((k, 3, 3)),
        level=np.ones(k - 1, dtype=bool),
    )


def _leg(n: int, rate_hz: float, sensor: Rotation) -> KneeMotion:
    rows, place = np.zeros(0, dtype=np.intp), np.zeros((n, 3))
    place[:, 0] = np.arange(n) / rate_hz
    attitude = sensor.as_quat(scalar_first=True)
    return KneeMotion(
        **_motion(n, rate_hz, Placement.LEFT_KNEE, attitude, place),
        cycle_start=rows,
        cycle_end=rows,
        residual_m=np.zeros(0),
    )


def _motion(n: int, rate_hz: float, placement: Placement, attitude: np.ndarray, place: np.ndarray) -> dict:
    zeros, never = np.zeros((n, 3)), np.zeros(n, dtype=bool)
    return {
        "placement": placement,
        "rate_hz": rate_hz,
        "time_s": np.arange(n) / rate_hz,
        "received": ~never,
        "saturated": never,
        "attitude": attitude,
        "rate_radps": zeros,
        "acceleration_mps2": zeros,
        "raw_velocity_mps": zeros,
        "raw_position_m": place,
        "velocity_mps": zeros,
        "position_m": place,
        "offsets": NO_OFFSETS,
    }
