"""Free movement of any sensor: offsets, orientation, free acceleration and its uncorrected integrals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.motion import ikizoglu2018, strapdown
from gaitlab.motion.integration import position_of, velocity_of
from gaitlab.motion.model import Motion, Offsets
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2, find_offsets
from gaitlab.motion.orientation import OrientationSource, estimate
from gaitlab.motion.quaternions import matrices, midway
from gaitlab.motion.signals import signals_of
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True, eq=False)
class Calibrated:
    """Specific force and angular rate of a sensor without their static offsets, shapes (n, 3), sensor frame."""

    acc_mps2: Floats
    gyr_radps: Floats
    offsets: Offsets

    @property
    def up(self) -> Floats:
        """Direction of gravity in the sensor's axes while standing, shape (3,)."""
        mean = self.acc_mps2[self.offsets.start : self.offsets.end].mean(axis=0)
        unit: Floats = mean / max(float(np.linalg.norm(mean)), 1e-9)
        return unit


def calibrate(sensor: Sensor) -> Calibrated:
    """Remove the static offsets that a standing foot shows."""
    signals = signals_of(sensor)
    offsets = find_offsets(sensor, signals.acc_mps2, signals.gyr_radps)
    acc = signals.acc_mps2 - np.array(offsets.acc_mps2)
    return Calibrated(acc, signals.gyr_radps - np.array(offsets.gyr_radps), offsets)


@dataclass(frozen=True, eq=False)
class Oriented:
    """A sensor in the world by some orientation.

    Attributes
    ----------
    attitude : ndarray (n, 4)
        Sensor to world, at the end of each sample's interval.
    rotation : ndarray (3, 3, n)
        The same in its middle.
    force_mps2 : ndarray (n, 3)
        Specific force, world.
    """

    attitude: Floats
    rotation: Floats
    force_mps2: Floats


def oriented(calibrated: Calibrated, attitude: Floats, rate_hz: float) -> Oriented:
    """Turn the specific force into the world: each sample by the orientation in the middle of its interval."""
    rotation = matrices(midway(attitude, calibrated.gyr_radps, rate_hz))
    return Oriented(attitude, rotation, strapdown.apply(rotation, calibrated.acc_mps2))


def free_motion(sensor: Sensor, time_s: Floats, source: OrientationSource | None = None) -> Motion:
    """Movement of any sensor up to its uncorrected integrals: orientation, offsets, free acceleration.

    ``source`` None takes VQF where the file has a gyroscope, else the device's orientation.
    """
    calibrated = calibrate(sensor)
    if source is None:
        source = OrientationSource.VQF if sensor.gyr_radps is not None else OrientationSource.DEVICE
    attitude = orientation(sensor, calibrated, source)
    return moved(sensor, time_s, calibrated, oriented(calibrated, attitude, sensor.rate_hz))


def moved(sensor: Sensor, time_s: Floats, calibrated: Calibrated, seen: Oriented) -> Motion:
    """Free acceleration of a sensor with a known orientation, and its uncorrected integrals."""
    rate_hz, offsets = sensor.rate_hz, calibrated.offsets
    acceleration = remove_gravity(seen.force_mps2, offsets)
    velocity = velocity_of(acceleration, rate_hz)
    position = position_of(velocity, rate_hz)
    return Motion(
        sensor.placement,
        rate_hz,
        time_s,
        sensor.received,
        sensor.saturated,
        seen.attitude,
        strapdown.apply(
            seen.rotation, calibrated.gyr_radps
        ),  # a turn about the rate leaves the rate as it is
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


def orientation(sensor: Sensor, calibrated: Calibrated, source: OrientationSource) -> Floats:
    """Orientation of each row, shape (n, 4), level but for a degree or two.

    Raises
    ------
    InputError
        If the device's orientation is asked for and the file has none.
    """
    if source is OrientationSource.DEVICE:
        if sensor.attitude is None:
            raise InputError(
                "no_device_orientation",
                f"The {sensor.placement.label} has no orientation of the device's own.",
                "Export a quaternion or rotation matrix, or let the orientation be estimated.",
                file=sensor.source.name,
            )
        return sensor.attitude
    if source is OrientationSource.VQF:
        return estimate(calibrated.acc_mps2, calibrated.gyr_radps, sensor.rate_hz)
    turned = strapdown.integrate_rate(calibrated.gyr_radps, sensor.rate_hz)
    up = strapdown.mean_force(oriented(calibrated, turned, sensor.rate_hz).force_mps2, sensor.rate_hz)
    return strapdown.level_throughout(turned, up)


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
