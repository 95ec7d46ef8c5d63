"""The two signals every stage needs, specific force and angular rate, from whatever the file holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.quaternions import angular_rate, conjugate, rotate
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True, eq=False)
class Signals:
    """Specific force (n, 3), m/s², and angular rate (n, 3), rad/s, in the sensor's frame."""

    acc_mps2: Floats
    gyr_radps: Floats


def signals_of(sensor: Sensor) -> Signals:
    """Measured signals, or those that the device's orientation implies where a column is missing.

    Raises
    ------
    InputError
        Where the file holds neither a gyroscope nor an orientation, or no acceleration at all.
    """
    acc, gyr = sensor.acc_mps2, sensor.gyr_radps
    if gyr is None:
        if sensor.attitude is None:
            raise InputError(
                "no_orientation",
                f"The {sensor.placement.label} has neither a gyroscope nor an orientation.",
                "Export Gyr_X, Gyr_Y, Gyr_Z, or a quaternion or rotation matrix, and upload again.",
                file=sensor.source.name,
            )
        gyr = angular_rate(sensor.attitude, sensor.rate_hz)
    if acc is None:
        if sensor.attitude is None or sensor.free_acc_mps2 is None:
            raise InputError(
                "no_acceleration",
                f"The {sensor.placement.label} has no acceleration.",
                "Export Acc_X, Acc_Y, Acc_Z and upload again.",
                file=sensor.source.name,
            )
        force = sensor.free_acc_mps2 + np.array([0.0, 0.0, STANDARD_GRAVITY_MPS2])
        acc = rotate(conjugate(sensor.attitude), force)
    return Signals(acc, gyr)
