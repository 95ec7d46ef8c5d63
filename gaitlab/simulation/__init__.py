"""Walks of which the truth is known exactly: closed-form feet and knees, and what sensors send of them.

::

    from gaitlab.simulation import TYPICAL_MTW, Plan, Stand, Walk, simulate, write_mtmanager

    walk = simulate(Plan((Stand(3.0), Walk(10.0), Stand(2.0))), TYPICAL_MTW)
    walk.recording                  # as if read from files
    walk.truth.feet, walk.truth.steps, walk.truth.crossing_s(7.62)
    write_mtmanager(walk, "folder")
"""

from gaitlab.simulation.mtmanager import STYLES, FileStyle, write_mtmanager
from gaitlab.simulation.presets import example_walk, ten_metre_and_back, timed_25_foot_walk
from gaitlab.simulation.sampling import GRAVITY_MPS2
from gaitlab.simulation.sensors import TYPICAL_MTW, SensorErrors
from gaitlab.simulation.simulate import Simulation, simulate
from gaitlab.simulation.truth import FootTruth, KneeTruth, StepsTruth, Truth
from gaitlab.simulation.walk import Gait, Person, Plan, Stand, Turn, Walk

__all__ = [
    "GRAVITY_MPS2",
    "STYLES",
    "TYPICAL_MTW",
    "FileStyle",
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
    "example_walk",
    "simulate",
    "ten_metre_and_back",
    "timed_25_foot_walk",
    "write_mtmanager",
]
