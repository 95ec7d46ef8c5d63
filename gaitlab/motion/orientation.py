"""Orientation of a sensor against the world: from the gyroscope alone, estimated by VQF, or the device's own."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from vqf import offlineVQF

from gaitlab.recording.model import Floats


class OrientationSource(StrEnum):
    """Where the orientation comes from.

    ``STRAPDOWN``: the gyroscope's integral, made level at the rests of a foot (anything else: by the mean force).
    """

    STRAPDOWN = "strapdown"
    VQF = "vqf"
    DEVICE = "device"


def estimate(acc: Floats, gyr: Floats, rate_hz: float) -> Floats:
    """Orientation from accelerometer and gyroscope, offsets removed; shape (n, 4), heading arbitrary but continuous.

    Source: Laidig and Seel, "VQF: Highly accurate IMU orientation estimation with bias estimation and magnetic
    disturbance rejection", Information Fusion 91 (2023) 187–204; the offline variant (forward and backward), six
    axes, published parameters. The magnetometer is left out: indoors it turns the heading by tens of degrees.
    """
    result = offlineVQF(np.ascontiguousarray(gyr), np.ascontiguousarray(acc), None, 1.0 / rate_hz)
    attitude: Floats = result["quat6D"]
    return attitude
