"""What a sensor does to the truth: its errors, its mounting and its clock."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from gaitlab.errors import InputError

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class SensorErrors:
    """Errors of one sensor. By default there are none: the samples are exact.

    Attributes
    ----------
    acc_noise, gyr_noise : float
        White noise density in m/s²/√Hz and rad/s/√Hz; a sample, being a mean over its interval, has the
        standard deviation density · √rate.
    acc_offset_mps2, gyr_offset_radps : float or three floats
        Static offset in the sensor's frame: the three values themselves, or the standard deviation from which
        each is drawn.
    gyr_drift : float
        Random walk of the gyroscope's offset in rad/s/√s.
    acc_scale : float
        Factor on the specific force; 1.02 makes gravity 10.0 m/s².
    acc_step_mps2, gyr_step_radps : float
        Step of quantisation; 0 for none.
    acc_range_mps2, gyr_range_radps : float
        Samples are cut off at ± this value and marked as saturated. (A real device cuts off before it
        averages, so its marked samples may stay inside the range.)
    lost_share : float
        Share of packets lost on the way. The first and the last row are always received. A received row after
        a gap carries the mean over the gap and itself.
    lost_burst : float
        Mean number of packets lost in a row.
    mounting : four floats or "random"
        How the sensor sits: the quaternion (w, x, y, z) that turns sensor coordinates into those of the
        segment (forward, left, up).
    first_packet : int
        Packet counter at time 0. Files show it modulo 65536.
    late_start, early_end : int
        The sensor starts up to so many packets later and ends up to so many earlier than the recording,
        drawn; but the left foot's sensor always starts at time 0.
    attitude_tilt_rad, attitude_heading_rad : float
        Standard deviation of the device's own orientation: a static and a slowly wandering tilt of this size
        each; a constant heading.
    mag_noise, mag_disturbance : float
        Noise per sample, and size of iron's field along the way, relative to the earth's field (1).
    pressure_noise_pa : float
        Noise per sample of the barometer.
    """

    acc_noise: float = 0.0
    gyr_noise: float = 0.0
    acc_offset_mps2: float | Vector = 0.0
    gyr_offset_radps: float | Vector = 0.0
    gyr_drift: float = 0.0
    acc_scale: float = 1.0
    acc_step_mps2: float = 0.0
    gyr_step_radps: float = 0.0
    acc_range_mps2: float = math.inf
    gyr_range_radps: float = math.inf
    lost_share: float = 0.0
    lost_burst: float = 2.5
    mounting: Quaternion | Literal["random"] = (1.0, 0.0, 0.0, 0.0)
    first_packet: int = 0
    late_start: int = 0
    early_end: int = 0
    attitude_tilt_rad: float = 0.0
    attitude_heading_rad: float = 0.0
    mag_noise: float = 0.0
    mag_disturbance: float = 0.0
    pressure_noise_pa: float = 0.0

    def __post_init__(self) -> None:
        if self.lost_burst < 1.0:
            raise InputError("invalid_errors", "A gap is at least one packet long.")
        most = self.lost_burst / (self.lost_burst + 1.0)
        if not 0.0 <= self.lost_share <= most:
            raise InputError(
                "invalid_errors",
                f"With gaps of {self.lost_burst:g} packets between 0 and {most:.2f} of all can be lost.",
            )


#: Noise as measured on MTw Awinda sensors at rest (0.015 to 0.02 m/s² and 0.002 rad/s at 100 Hz), offsets as
#: found on them, their ranges, and a usual amount of loss.
TYPICAL_MTW = SensorErrors(
    acc_noise=0.0017,
    gyr_noise=0.0002,
    acc_offset_mps2=0.05,
    gyr_offset_radps=0.008,
    gyr_drift=5e-5,
    acc_scale=1.01,
    acc_range_mps2=157.0,
    gyr_range_radps=34.9,
    lost_share=0.02,
    mounting="random",
    first_packet=27626,
    late_start=20,
    early_end=60,
    attitude_tilt_rad=0.006,
    attitude_heading_rad=0.3,
    mag_noise=0.003,
    mag_disturbance=0.1,
    pressure_noise_pa=3.0,
)
