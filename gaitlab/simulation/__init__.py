"""A walk of which the truth is known exactly: closed-form feet and knees, and the samples sensors would send
of them.

>>> from gaitlab.simulation import Plan, Stand, Walk, simulate
>>> walk = simulate(Plan((Stand(3.0), Walk(10.0), Stand(2.0))))
>>> walk.recording.sensors, walk.truth.feet  # doctest: +SKIP
"""

from gaitlab.simulation.sampling import GRAVITY_MPS2
from gaitlab.simulation.sensors import TYPICAL_MTW, SensorErrors
from gaitlab.simulation.simulate import Simulation, simulate
from gaitlab.simulation.truth import FootTruth, KneeTruth, StepsTruth, Truth
from gaitlab.simulation.walk import Gait, Person, Plan, Stand, Turn, Walk

__all__ = [
    "GRAVITY_MPS2",
    "TYPICAL_MTW",
    "FootTruth",
    "Gait",
    "KneeTruth",
    "Person",
    "Plan",
    "SensorErrors",
    "Simulation",
    "Stand",
    "StepsTruth",
    "Truth",
    "Turn",
    "Walk",
    "simulate",
]
