"""A short walk as sensor files, for tests that need any real recording and none in particular."""

from __future__ import annotations

from functools import cache

import numpy as np

from gaitlab.recording import InputFile, Placement, Sensor
from gaitlab.simulation import Plan, Stand, Walk, simulate


@cache
def short_walk(distance_m: float = 6.0, *, knees: bool = False) -> dict[Placement, InputFile]:
    """MT Manager files of a simulated straight walk: stand, walk, stand."""
    walk = simulate(Plan((Stand(2.0), Walk(distance_m), Stand(1.0))))
    return {
        placement: InputFile(f"walk_{placement}.txt", mt_manager_text(sensor).encode())
        for placement, sensor in walk.recording.sensors.items()
        if knees or placement.is_foot
    }


def mt_manager_text(sensor: Sensor) -> str:
    """The received samples as MT Manager writes them."""
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    packets = (sensor.first_packet + np.arange(sensor.n_samples)) % 65536
    head = (
        f"// Update Rate: {sensor.rate_hz:.1f}Hz\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n"
    )
    rows = zip(packets, sensor.acc_mps2, sensor.gyr_radps, sensor.received, strict=True)
    return head + "".join(
        f"{packet}\t" + "\t".join(f"{value:.6f}" for value in (*acc, *gyr)) + "\n"
        for packet, acc, gyr, received in rows
        if received
    )
