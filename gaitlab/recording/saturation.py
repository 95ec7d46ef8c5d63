"""Samples that stood at the end of the sensor's range: the true value was larger by an unknown amount."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording.model import Bools, Floats


@dataclass(frozen=True)
class SaturationParams:
    """Where a range ends.

    The two levels are 1.2 % and 1 % below the nominal ends: the factory calibration (gain, misalignment) of
    each axis shifts them by about 1 % (seen: 156.9 to 158.1 m/s² on one clipped axis of a ±16 g sensor).
    Tuned on: a ±16 g recording with clipped heel strikes (found) and 46 walks with a ±160 m/s² sensor up to
    132 m/s² and 27 rad/s (none found).
    """

    acc_mps2: float = 155.0
    """±16 g = 156.9 m/s², ±160 m/s² for the MTw."""
    gyr_radps: float = 34.55
    """±2000 deg/s = 34.91 rad/s."""
    flat_acc_mps2: float = 35.0
    """A flat top lower than this is a sensor at rest, not a range below ±4 g = 39 m/s²."""
    flat_gyr_radps: float = 4.2
    """Likewise for ±250 deg/s = 4.36 rad/s."""
    flat_share: float = 2e-4
    """Successive samples this near (relative) to the axis's extreme are a flat top: the range is narrower."""
    flat_samples: int = 3
    """How many in a row."""


PARAMS = SaturationParams()


def find_saturation(
    packet: NDArray[np.int64],
    acc_mps2: Floats | None,
    gyr_radps: Floats | None,
    params: SaturationParams = PARAMS,
) -> Bools:
    """Mark the samples whose accelerometer or gyroscope stood at the end of its range, shape (n,)."""
    saturated = np.zeros(len(packet), dtype=bool)
    for signal, level, flat_floor in (
        (acc_mps2, params.acc_mps2, params.flat_acc_mps2),
        (gyr_radps, params.gyr_radps, params.flat_gyr_radps),
    ):
        for axis in () if signal is None else np.ascontiguousarray(signal.T):
            highest, lowest = float(axis.max()), float(axis.min())
            extreme = max(highest, -lowest)
            if extreme >= level:
                saturated |= np.abs(axis) >= level
            if extreme >= flat_floor:
                flat_level = extreme * (1 - params.flat_share)
                _mark_flat_tops(saturated, packet, axis >= flat_level, params.flat_samples)
                _mark_flat_tops(saturated, packet, axis <= -flat_level, params.flat_samples)
    return saturated


def _mark_flat_tops(saturated: Bools, packet: NDArray[np.int64], top: Bools, flat_samples: int) -> None:
    """Mark runs of successive packets that repeat the extreme, in place."""
    at = np.flatnonzero(top)
    if len(at) < flat_samples:
        return
    for run in np.split(at, np.flatnonzero(np.diff(packet[at]) != 1) + 1):
        if len(run) >= flat_samples:
            saturated[run] = True
