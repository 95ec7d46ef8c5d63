"""Simulated walks that several tests analyse, each made once."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.recording.model import Floats, Placement, Recording, Sensor
from gaitlab.simulation import TYPICAL_MTW, Plan, SensorErrors, Simulation, Stand, Turn, Walk, simulate

OUT_AND_BACK = Plan((Stand(4.0), Walk(10.0), Turn(np.pi), Walk(10.0), Stand(2.0)))
STRAIGHT = Plan((Stand(4.0), Walk(10.0), Stand(2.0)))


@cache
def out_and_back(
    errors: SensorErrors | None = TYPICAL_MTW, rate_hz: float = 100.0, seed: int = 3
) -> Simulation:
    """Ten metres, a turn to the left, and back; feet and knees."""
    return simulate(OUT_AND_BACK, errors, rate_hz=rate_hz, seed=seed, sampling="mean")


@cache
def analysed(errors: SensorErrors | None = TYPICAL_MTW, rate_hz: float = 100.0, seed: int = 3) -> Analysis:
    """``out_and_back``, analysed with a course of 7.62 m."""
    return analyze(out_and_back(errors, rate_hz, seed).recording, Settings(course_m=7.62))


def without(recording: Recording, *placements: Placement) -> Recording:
    """The recording with some sensors taken away."""
    kept = {p: s for p, s in recording.sensors.items() if p not in placements}
    return Recording(kept, recording.findings)


def turned(sensor: Sensor, matrix: Floats) -> Sensor:
    """The sensor as if it had been mounted otherwise: its readings in axes turned by ``matrix``, shape (3, 3)."""
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    return replace(
        sensor,
        acc_mps2=sensor.acc_mps2 @ matrix.T,
        gyr_radps=sensor.gyr_radps @ matrix.T,
        mag=None,
        attitude=None,
        free_acc_mps2=None,
    )


def cut(sensor: Sensor, start: int, end: int) -> Sensor:
    """Rows ``[start, end)`` of a sensor."""
    fields = (
        "received",
        "saturated",
        "acc_mps2",
        "gyr_radps",
        "mag",
        "free_acc_mps2",
        "attitude",
        "pressure_pa",
    )
    parts = {name: getattr(sensor, name)[start:end] for name in fields if getattr(sensor, name) is not None}
    return replace(sensor, first_packet=sensor.first_packet + start, **parts)
