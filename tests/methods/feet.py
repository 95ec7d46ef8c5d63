"""Feet as methods see them: built row by row, simulated, and real."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from gaitlab.methods.model import FootView
from gaitlab.methods.view import foot_view
from gaitlab.motion.displacement import foot_motion
from gaitlab.motion.foot import track_foot
from gaitlab.motion.integration import position_of, velocity_of
from gaitlab.motion.model import Motion, Offsets
from gaitlab.motion.rest import no_rests
from gaitlab.recording.model import Floats, Placement, Side
from gaitlab.simulation import TYPICAL_MTW, SensorErrors, Simulation, simulate
from gaitlab.validation.ten_metres_trials import Labels, find_trials, read_trial
from tests.walks import OUT_AND_BACK

LEFT = Placement.LEFT_FOOT


def built(
    acc_mps2: Floats | None = None,
    gyr_radps: Floats | None = None,
    *,
    n: int = 400,
    rate_hz: float = 100.0,
    free_mps2: Floats | None = None,
    mag: Floats | None = None,
    pressure_pa: Floats | None = None,
) -> FootView:
    """A foot whose sensor is level and never turns its axes; what is not given is that of standing."""
    given = [a for a in (acc_mps2, gyr_radps, free_mps2, mag, pressure_pa) if a is not None]
    n = len(given[0]) if given else n
    still = np.zeros((n, 3))
    acc = still + np.array([0.0, 0.0, 9.81]) if acc_mps2 is None else acc_mps2
    gyr = still if gyr_radps is None else gyr_radps
    free = still if free_mps2 is None else free_mps2
    velocity = velocity_of(free, rate_hz)
    position = position_of(velocity, rate_hz)
    offsets = Offsets(0, min(n, 100), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), True, 9.81, 0.001)
    attitude = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    flags = np.zeros(n, dtype=np.bool_)
    time_s = np.arange(n) / rate_hz
    motion = Motion(
        LEFT,
        rate_hz,
        time_s,
        ~flags,
        flags,
        attitude,
        gyr,
        free,
        velocity,
        position,
        velocity,
        position,
        offsets,
    )
    moved = {"velocity_mps": velocity, "position_m": position}
    none = np.zeros((0, 3, 3))
    foot = foot_motion(moved, motion, no_rests(), none, none, np.zeros(0), np.zeros(0, dtype=np.bool_))
    return FootView(Side.LEFT, rate_hz, time_s, acc, gyr, mag, pressure_pa, foot)


@cache
def walk(errors: SensorErrors | None = TYPICAL_MTW, rate_hz: float = 100.0, seed: int = 3) -> Simulation:
    """Ten metres, a turn to the left, and back, with magnetometer and barometer."""
    return simulate(
        OUT_AND_BACK, errors, rate_hz=rate_hz, seed=seed, sampling="mean", magnetometer=True, pressure=True
    )


@cache
def walked(errors: SensorErrors | None = TYPICAL_MTW, rate_hz: float = 100.0) -> FootView:
    """The left foot of it."""
    recording = walk(errors, rate_hz).recording
    sensor = recording.sensors[LEFT]
    return foot_view(sensor, track_foot(sensor, recording.time_s(LEFT)))


def remounted(errors: SensorErrors | None, matrix: Floats) -> FootView:
    """The same foot with its sensor mounted otherwise, by a rotation matrix, shape (3, 3)."""
    recording = walk(errors).recording
    sensor = recording.sensors[LEFT]
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    assert sensor.mag is not None
    sensor = replace(
        sensor,
        acc_mps2=sensor.acc_mps2 @ matrix.T,
        gyr_radps=sensor.gyr_radps @ matrix.T,
        mag=sensor.mag @ matrix.T,
        attitude=None,
        free_acc_mps2=None,
    )
    return foot_view(sensor, track_foot(sensor, recording.time_s(LEFT)))


@cache
def real_feet(data_dir: Path) -> list[tuple[FootView, Floats, Labels]]:
    """Both feet of the first trial of each of the eight people, with their hand-checked swings."""
    first: dict[str, int] = {}
    files = find_trials(data_dir / "mtw-10m-walk")
    for k, one in enumerate(files):
        first.setdefault(one.name.split("-")[0], k)
    feet = []
    for k in first.values():
        recording, labels = read_trial(files[k])
        for placement, sensor in recording.sensors.items():
            motion = track_foot(sensor, recording.time_s(placement))
            feet.append((foot_view(sensor, motion), labels.swings[placement.side], labels))
    return feet
