"""What was measured: the samples of each sensor on one regular packet clock.

Conventions for the whole of gaitlab: SI units and radians; vectors are rows, shape ``(n, 3)``; quaternions
are scalar-first ``(w, x, y, z)`` and turn sensor coordinates into world coordinates, z up; intervals are
``[start, end)``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


class Side(StrEnum):
    """Side of the body."""

    LEFT = "left"
    RIGHT = "right"

    @property
    def other(self) -> Side:
        return Side.RIGHT if self is Side.LEFT else Side.LEFT


class Placement(StrEnum):
    """Where a sensor is worn."""

    LEFT_FOOT = "left_foot"
    RIGHT_FOOT = "right_foot"
    LEFT_KNEE = "left_knee"
    RIGHT_KNEE = "right_knee"

    @property
    def side(self) -> Side:
        return Side(self.value.split("_")[0])

    @property
    def is_foot(self) -> bool:
        return self.value.endswith("foot")

    @property
    def label(self) -> str:
        """For people: ``left foot``."""
        return self.value.replace("_", " ")

    @staticmethod
    def foot(side: Side) -> Placement:
        return Placement(f"{side}_foot")

    @staticmethod
    def knee(side: Side) -> Placement:
        return Placement(f"{side}_knee")


@dataclass(frozen=True)
class Finding:
    """Something about the data that the reader of a result should know; not an error.

    ``code`` is stable and machine-readable; ``message`` is one sentence for people and says what it means for
    the result.
    """

    code: str
    message: str
    placement: Placement | None = None


@dataclass(frozen=True)
class Source:
    """The file a sensor's samples came from: name as given (never used as a path) and hash of the content."""

    name: str
    sha256: str
    size_bytes: int


@dataclass(frozen=True, eq=False)
class Sensor:
    """Samples of one sensor on the regular packet clock: row i was sent with packet ``first_packet + i``.

    Rows that were lost are filled (the next received sample held back over the gap for accelerometer and
    gyroscope, since the device integrates on board and sends the mean over the gap; magnetometer, pressure
    and orientation interpolated) and marked in ``received``.

    Attributes
    ----------
    rate_hz : float
        Packets per second.
    first_packet : int
        Unwrapped packet counter of row 0, comparable between the sensors of one recording.
    received : ndarray (n,)
        False where the row was lost and filled.
    saturated : ndarray (n,)
        True where accelerometer or gyroscope stood at the end of its range.
    acc_mps2, gyr_radps, mag, free_acc_mps2 : ndarray (n, 3) or None
        Specific force and angular rate in the sensor's frame; magnetic field in the sensor's frame, arbitrary
        unit; the device's own free acceleration in its world frame. None where the file has no such columns.
    attitude : ndarray (n, 4) or None
        The device's own orientation.
    pressure_pa : ndarray (n,) or None
    averaged : bool
        Each sample is the mean over the interval that ends with it, as a device sends that integrates on board (MTw);
        False where it was sampled at an instant.
    """

    placement: Placement
    source: Source
    rate_hz: float
    first_packet: int
    received: Bools
    saturated: Bools
    acc_mps2: Floats | None
    gyr_radps: Floats | None
    mag: Floats | None = None
    free_acc_mps2: Floats | None = None
    attitude: Floats | None = None
    pressure_pa: Floats | None = None
    device: str | None = None
    averaged: bool = True

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    @property
    def n_samples(self) -> int:
        return len(self.received)

    @property
    def n_lost(self) -> int:
        return int(np.count_nonzero(~self.received))

    @property
    def n_saturated(self) -> int:
        return int(np.count_nonzero(self.saturated))


@dataclass(frozen=True, eq=False)
class Recording:
    """The sensors of one trial on one clock.

    ``first_packet`` is the earliest first packet of all sensors: time 0 of every result.
    """

    sensors: Mapping[Placement, Sensor]
    findings: tuple[Finding, ...] = field(default=())

    def __post_init__(self) -> None:
        ordered = {p: self.sensors[p] for p in Placement if p in self.sensors}
        object.__setattr__(self, "sensors", MappingProxyType(ordered))

    @property
    def rate_hz(self) -> float:
        return next(iter(self.sensors.values())).rate_hz

    @property
    def first_packet(self) -> int:
        return min(sensor.first_packet for sensor in self.sensors.values())

    def time_s(self, placement: Placement) -> Floats:
        """Times of a sensor's rows in seconds since ``first_packet``, shape (n,)."""
        sensor = self.sensors[placement]
        start = sensor.first_packet - self.first_packet
        return (start + np.arange(sensor.n_samples)) / sensor.rate_hz
