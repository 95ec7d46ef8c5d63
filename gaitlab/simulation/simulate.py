"""A simulated recording together with the truth about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording.model import Floats, Placement, Recording
from gaitlab.simulation.body import build_body
from gaitlab.simulation.device import Channels, record
from gaitlab.simulation.motion import Motion
from gaitlab.simulation.sampling import Sampling, draw_ticks
from gaitlab.simulation.sensors import SensorErrors
from gaitlab.simulation.truth import Truth, tell_truth
from gaitlab.simulation.walk import Plan


@dataclass(frozen=True, eq=False)
class Simulation:
    """What the sensors recorded, and what really happened."""

    recording: Recording
    truth: Truth


def simulate(
    plan: Plan,
    errors: SensorErrors | Mapping[Placement, SensorErrors] | None = None,
    *,
    rate_hz: float = 100.0,
    seed: int = 0,
    knees: bool = True,
    orientation: bool = True,
    magnetometer: bool = False,
    pressure: bool = False,
    free_acceleration: bool = False,
    sampling: Sampling = "strapdown",
) -> Simulation:
    """Walk a plan with a sensor on each foot and knee. The same arguments always give the same numbers.

    Parameters
    ----------
    plan : Plan
        What is walked, by whom and how.
    errors : SensorErrors or mapping of Placement, optional
        One set for every sensor, or one for each; offsets and mountings are drawn for each sensor on its own.
        None (and a placement that is missing) means perfect sensors.
    rate_hz : float
        Packets per second, 10 to 1000.
    seed : int
        Draws the errors. (Variability of the steps is drawn by ``plan.seed``.)
    knees, orientation, magnetometer, pressure, free_acceleration : bool
        Whether there are knee sensors, and which channels the sensors have beside accelerometer and
        gyroscope.
    sampling : "strapdown" or "mean"
        What a sample means, see ``gaitlab.simulation.sampling``.

    Raises
    ------
    InputError
        Where the rate is out of range or the plan cannot be walked.
    """
    if not 10.0 <= rate_hz <= 1000.0:
        raise InputError("invalid_rate", "The sampling rate must lie between 10 and 1000 Hz.")
    body = build_body(plan, knees=knees)
    n = int(np.floor(body.course.duration_s * rate_hz)) + 1
    channels = Channels(orientation, magnetometer, pressure, free_acceleration)
    sensors = {}
    for number, placement in enumerate(Placement):
        if placement not in body.placements:
            continue
        own = (
            errors.get(placement, SensorErrors()) if isinstance(errors, Mapping) else errors or SensorErrors()
        )
        rng = np.random.default_rng([seed, number])
        ticks = draw_ticks(n, rate_hz, own, rng, may_be_late=placement is not Placement.LEFT_FOOT)

        def motion(t_s: Floats, placement: Placement = placement) -> Motion:
            return body.sensor(placement, t_s)

        sensors[placement] = record(placement, motion, ticks, own, channels, sampling, rng)
    return Simulation(Recording(sensors), tell_truth(body, np.arange(n) / rate_hz))
