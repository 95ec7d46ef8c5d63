"""The textbook way back from samples to movement, for tests: nothing is corrected, so errors show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from gaitlab.recording import Sensor
from gaitlab.recording.model import Floats
from gaitlab.simulation import GRAVITY_MPS2


@dataclass(frozen=True)
class Path:
    """Rows that were received, and orientation, velocity and position there."""

    rows: np.ndarray
    rotation: Rotation
    velocity_mps: Floats
    position_m: Floats


def integrate(sensor: Sensor, velocity_mps: Floats, position_m: Floats) -> Path:
    """Integrate the received samples from a known start; the first row's attitude is the starting one."""
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    assert sensor.attitude is not None
    rows = np.flatnonzero(sensor.received)
    dt = (np.diff(rows) / sensor.rate_hz)[:, None]
    turns = Rotation.from_rotvec(sensor.gyr_radps[rows[1:]] * dt)
    attitudes = [Rotation.from_quat(sensor.attitude[0], scalar_first=True)]
    for turn in turns:
        attitudes.append(attitudes[-1] * turn)
    rotation = Rotation.concatenate(attitudes)
    acceleration = rotation[:-1].apply(sensor.acc_mps2[rows[1:]]) - [0.0, 0.0, GRAVITY_MPS2]
    velocity = velocity_mps + np.vstack([np.zeros(3), np.cumsum(acceleration * dt, axis=0)])
    steps = 0.5 * (velocity[1:] + velocity[:-1]) * dt
    position = position_m + np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
    return Path(rows, rotation, velocity, position)
