"""A foot as the methods of the catalogue see it."""

from __future__ import annotations

from gaitlab.methods.model import FootView
from gaitlab.motion.free import calibrate
from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Sensor


def foot_view(sensor: Sensor, motion: FootMotion) -> FootView:
    """The calibrated signals of a foot's sensor beside the movement that was made of them.

    Raises
    ------
    InputError
        Where the file holds neither a gyroscope nor an orientation, or no acceleration at all.
    """
    calibrated = calibrate(sensor)
    return FootView(
        side=sensor.placement.side,
        rate_hz=sensor.rate_hz,
        time_s=motion.time_s,
        acc_mps2=calibrated.acc_mps2,
        gyr_radps=calibrated.gyr_radps,
        mag=sensor.mag,
        pressure_pa=sensor.pressure_pa,
        motion=motion,
    )
