"""A sensor with its errors: from exact samples to what stands in a recording."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from gaitlab.recording.model import Bools, Floats, Placement, Sensor, Source
from gaitlab.simulation.motion import Motion
from gaitlab.simulation.sampling import FREE_FALL, Sampling, Ticks, exact_samples
from gaitlab.simulation.sensors import SensorErrors, Vector

#: The earth's magnetic field: size 1, dip about 60°.
_FIELD = np.array([0.35, 0.35, -0.869])
#: Wave vectors of iron's field along the way (rad/m), one for each component.
_IRON = np.array([[1.9, 0.7, 0.3], [-1.1, 2.3, 0.5], [0.8, -1.7, 0.9]])


@dataclass(frozen=True)
class Channels:
    """What a sensor sends beside specific force and angular rate."""

    orientation: bool = True
    magnetometer: bool = False
    pressure: bool = False
    free_acceleration: bool = False


def record(
    placement: Placement,
    motion: Callable[[Floats], Motion],
    ticks: Ticks,
    errors: SensorErrors,
    channels: Channels,
    sampling: Sampling,
    rng: np.random.Generator,
) -> Sensor:
    """Return what a sensor that moves as ``motion`` (a function of the time in seconds) records.

    Lost rows are filled as a reader of its file would: the next received sample held back, the slow channels
    interpolated.
    """
    own, for_errors, for_others = rng.spawn(3)
    device = f"00B4{own.integers(0x100, 0xFFF):03X}{list(Placement).index(placement)}"
    mounting = _mounting(errors, own)
    ends = motion(ticks.at_s(np.concatenate([[-1], ticks.rows])))
    exact = exact_samples(motion, ends, ticks, sampling)
    force, rate = (mounting.inv().apply(values) for values in exact)
    acc, gyr = _with_errors(force, rate, ticks, errors, for_errors)
    acc, acc_cut = _digitise(acc, errors.acc_step_mps2, errors.acc_range_mps2)
    gyr, gyr_cut = _digitise(gyr, errors.gyr_step_radps, errors.gyr_range_radps)
    filled = _next_received(ticks)
    saturated = np.zeros(len(ticks.received), dtype=np.bool_)
    saturated[ticks.rows] = acc_cut | gyr_cut
    return Sensor(
        placement=placement,
        source=_source(placement, acc, gyr),
        rate_hz=ticks.rate_hz,
        first_packet=errors.first_packet + ticks.start,
        received=ticks.received,
        saturated=saturated,
        acc_mps2=acc[filled],
        gyr_radps=gyr[filled],
        device=device,
        **_further_channels(ends, mounting, acc, ticks, errors, channels, for_others),
    )


def _further_channels(
    ends: Motion,
    mounting: Rotation,
    acc: Floats,
    ticks: Ticks,
    errors: SensorErrors,
    channels: Channels,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """The sensor's fields beside accelerometer and gyroscope; each channel has its own stream of errors."""
    for_attitude, for_mag, for_pressure = rng.spawn(3)
    position_m, true_attitude = ends.position_m[1:], ends.rotation[1:] * mounting
    fields = {}
    if channels.magnetometer:
        mag = true_attitude.inv().apply(_field(position_m, errors))
        fields["mag"] = _interpolated(mag + errors.mag_noise * for_mag.standard_normal(mag.shape), ticks)
    if channels.pressure:
        noise = errors.pressure_noise_pa * for_pressure.standard_normal(len(acc))
        pressure = _pressure_pa(position_m[:, 2]) + noise
        fields["pressure_pa"] = _interpolated(pressure[:, None], ticks)[:, 0]
    if channels.orientation or channels.free_acceleration:
        estimate = _device_attitude(true_attitude, ticks.at_s(ticks.rows), errors, for_attitude)
        if channels.orientation:
            fields["attitude"] = _interpolated_attitude(estimate, ticks)
        if channels.free_acceleration:
            fields["free_acc_mps2"] = _free_acceleration(estimate, acc, ticks)
    return fields


def _mounting(errors: SensorErrors, rng: np.random.Generator) -> Rotation:
    drawn = Rotation.from_quat(rng.standard_normal(4))
    return drawn if errors.mounting == "random" else Rotation.from_quat(errors.mounting, scalar_first=True)


def _with_errors(
    force: Floats, rate: Floats, ticks: Ticks, errors: SensorErrors, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    n, per_sample = len(ticks.received), np.sqrt(ticks.rate_hz)
    noise = rng.standard_normal((3, n, 3))
    acc_offset, gyr_offset = (
        _offset(size, rng) for size in (errors.acc_offset_mps2, errors.gyr_offset_radps)
    )
    drift = errors.gyr_drift / per_sample * np.cumsum(noise[2], axis=0)
    acc_error = errors.acc_noise * per_sample * noise[0] + acc_offset
    gyr_error = errors.gyr_noise * per_sample * noise[1] + gyr_offset + drift
    return errors.acc_scale * force + ticks.gap_mean(acc_error), rate + ticks.gap_mean(gyr_error)


def _offset(size: float | Vector, rng: np.random.Generator) -> Floats:
    drawn = rng.standard_normal(3)
    return np.asarray(size) if isinstance(size, tuple) else size * drawn


def _digitise(values: Floats, step: float, limit: float) -> tuple[Floats, Bools]:
    if step > 0.0:
        values = np.round(values / step) * step
    return np.clip(values, -limit, limit), np.any(np.abs(values) >= limit, axis=1)


def _device_attitude(true: Rotation, t_s: Floats, errors: SensorErrors, rng: np.random.Generator) -> Rotation:
    """The device's own orientation: the truth, tilted a little, in a world with another heading."""
    static, wander, phase = rng.standard_normal(2), rng.standard_normal((2, 2)), rng.uniform(0, 2 * np.pi, 2)
    heading = errors.attitude_heading_rad * rng.standard_normal()
    waves = np.sin(2.0 * np.pi * np.outer(t_s, [0.05, 0.13]) + phase)
    tilt = np.zeros((len(t_s), 3))
    tilt[:, :2] = errors.attitude_tilt_rad * (static + waves @ wander)
    return Rotation.from_rotvec([0.0, 0.0, heading]) * Rotation.from_rotvec(tilt) * true


def _free_acceleration(attitude: Rotation, acc: Floats, ticks: Ticks) -> Floats:
    """The device's own acceleration without gravity, by its orientation at the start of each interval."""
    before = attitude[np.maximum(np.arange(len(acc)) - 1, 0)]
    return _interpolated(before.apply(acc) + FREE_FALL, ticks)


def _field(position_m: Floats, errors: SensorErrors) -> Floats:
    field: Floats = _FIELD + errors.mag_disturbance * np.sin(position_m @ _IRON.T)
    return field


def _pressure_pa(height_m: Floats) -> Floats:
    """Pressure of the standard atmosphere, ISO 2533."""
    pressure: Floats = 101325.0 * (1.0 - 2.25577e-5 * height_m) ** 5.25588
    return pressure


def _next_received(ticks: Ticks) -> NDArray[np.int_]:
    """For each row the number, among the received ones, of the next received row."""
    return np.searchsorted(ticks.rows, np.arange(len(ticks.received)))


def _interpolated(values: Floats, ticks: Ticks) -> Floats:
    rows = np.arange(len(ticks.received))
    return np.column_stack([np.interp(rows, ticks.rows, column) for column in values.T])


def _interpolated_attitude(attitude: Rotation, ticks: Ticks) -> Floats:
    quaternions = attitude.as_quat(scalar_first=True)
    flips = np.cumprod(
        np.where(np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0.0, -1.0, 1.0), dtype=np.float64
    )
    quaternions[1:] *= flips[:, None]
    filled = _interpolated(quaternions, ticks)
    unit: Floats = filled / np.linalg.norm(filled, axis=1, keepdims=True)
    return unit


def _source(placement: Placement, acc: Floats, gyr: Floats) -> Source:
    content = acc.tobytes() + gyr.tobytes()
    return Source(f"simulated {placement.label}", hashlib.sha256(content).hexdigest(), len(content))
