"""Walks worth having by name: the tests of the clinic, and gaits that are hard on an algorithm."""

from __future__ import annotations

import math

from gaitlab.recording.model import Side
from gaitlab.simulation.sensors import TYPICAL_MTW
from gaitlab.simulation.simulate import Simulation, simulate
from gaitlab.simulation.walk import Gait, Plan, Stand, Turn, Walk

T25FW_M = 7.62

COMFORTABLE = Gait()
FAST = Gait(
    stride_length_m=1.60, stride_time_s=0.92, stance_share=0.59, heel_strike_mps2=60.0, toe_up_rad=0.42
)
SLOW = Gait(
    stride_length_m=0.80,
    landing_share=0.07,
    stride_time_s=1.60,
    stance_share=0.68,
    heel_rise_rad=0.8,
    toe_up_rad=0.18,
)
#: Short steps, hardly any roll of the foot: what Parkinson's disease or deep cerebral changes look like.
SHUFFLING = Gait(
    stride_length_m=0.45,
    stride_time_s=0.95,
    step_width_m=0.14,
    stance_share=0.72,
    heel_rise_rad=0.35,
    toe_up_rad=0.06,
    lift_m=0.012,
    heel_strike_mps2=8.0,
    variability=0.03,
)
#: Left steps longer and slower than right ones, as in a hemiparesis of the left side.
LIMPING = Gait(
    stride_length_m=0.95,
    stride_time_s=1.35,
    stance_share=0.66,
    length_asymmetry=0.12,
    time_asymmetry=0.08,
    heel_rise_rad=0.8,
    circumduction_m=0.05,
    variability=0.02,
)
ATAXIC = Gait(
    stride_length_m=1.0,
    stride_time_s=1.25,
    heel_rise_rad=0.8,
    toe_up_rad=0.2,
    step_width_m=0.22,
    stance_share=0.66,
    variability=0.06,
)


def timed_25_foot_walk(gait: Gait = COMFORTABLE) -> Plan:
    """Stand 4 s, walk beyond a course of 7.62 m, stop."""
    return Plan((Stand(4.0), Walk(T25FW_M + 1.5), Stand(3.0)), gait)


def ten_metre_and_back(gait: Gait = COMFORTABLE) -> Plan:
    """Stand, walk 10 m, turn by 180°, walk back, stop."""
    return Plan((Stand(4.0), Walk(10.0), _turn(math.pi, gait), Walk(10.0), Stand(3.0)), gait)


def stop_and_go(gait: Gait = COMFORTABLE) -> Plan:
    """Three walks with stops of 1.5 and 4 s between them."""
    return Plan((Stand(3.0), Walk(4.0), Stand(1.5), Walk(3.0), Stand(4.0), Walk(4.0), Stand(2.0)), gait)


def square(gait: Gait = COMFORTABLE, side_m: float = 5.0, *, to: Side = Side.LEFT) -> Plan:
    """Once around a square, back to where it began, with quarter turns to one side."""
    quarter = _turn(math.pi / 2 if to is Side.LEFT else -math.pi / 2, gait)
    return Plan((Stand(3.0), *(Walk(side_m), quarter) * 4, Stand(2.0)), gait)


def long_walk(minutes: float, gait: Gait = COMFORTABLE, length_m: float = 30.0) -> Plan:
    """Up and down a corridor for about so many minutes."""
    turn = _turn(math.pi, gait)
    strides = length_m / gait.stride_length_m + turn.steps / 2
    laps = max(1, round(minutes * 60.0 / (strides * gait.stride_time_s)))
    return Plan((Stand(5.0), *(Walk(length_m), turn) * laps, Stand(3.0)), gait)


def example_walk(seed: int = 0) -> Simulation:
    """A timed 25-foot walk with sensors on feet and knees that err as real ones do (for ``gaitlab demo``)."""
    gait = Gait(stride_length_m=1.38, stride_time_s=1.02, variability=0.015)
    return simulate(
        timed_25_foot_walk(gait), TYPICAL_MTW, seed=seed, magnetometer=True, free_acceleration=True
    )


def _turn(angle_rad: float, gait: Gait) -> Turn:
    """A turn of 45° a step; who makes short steps needs twice as many of them."""
    a_step = math.pi / 8 if gait.stride_length_m < 0.7 else math.pi / 4
    return Turn(angle_rad, n_steps=math.ceil(abs(angle_rad) / a_step - 1e-9))
