"""What is walked: a course of standing, walking and turning by a person with a gait, turned into footfalls.

The world is that of ``gaitlab.result``: z up, x along the first straight part, the origin on the floor midway
between the feet at the start. Time 0 is the start of the first standing phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from gaitlab.errors import InputError
from gaitlab.recording.model import Side


def leftward(side: Side) -> float:
    """Sign of this side's outside on the axis that points to the left: 1 for the left, −1 for the right."""
    return 1.0 if side is Side.LEFT else -1.0


@dataclass(frozen=True)
class Person:
    """Body and the places of the sensors on it. Points are (forward, left, up) in metres.

    Attributes
    ----------
    foot_length_m : float
        Length of the shoe; its heel edge lies 23 % behind, the line on which it rolls off 62 % before the
        ankle.
    ankle_height_m, shank_length_m : float
        Height of the ankle joint over the sole; distance from ankle to knee joint.
    foot_sensor_m : tuple
        Place of the foot sensor, from the point of the sole under the ankle. The default is the back of the
        foot.
    knee_sensor_m : tuple
        Place of the knee sensor, from the knee joint, in the frame of the shank; the left of the right leg is
        its inside. The default is the upper shank, in front.
    """

    foot_length_m: float = 0.26
    ankle_height_m: float = 0.08
    shank_length_m: float = 0.40
    foot_sensor_m: tuple[float, float, float] = (0.05, 0.0, 0.07)
    knee_sensor_m: tuple[float, float, float] = (0.05, 0.0, -0.08)

    @property
    def heel_m(self) -> float:
        """How far the rear edge of the sole lies behind the ankle."""
        return 0.23 * self.foot_length_m

    @property
    def forefoot_m(self) -> float:
        """How far the line on which the sole rolls off lies before the ankle."""
        return 0.62 * self.foot_length_m


@dataclass(frozen=True)
class Gait:
    """How a person walks. The defaults resemble a healthy adult at a comfortable speed of 1.2 m/s.

    Attributes
    ----------
    stride_length_m, stride_time_s : float
        Length and duration of a full stride (two steps) in mid-walk.
    step_width_m : float
        Distance across the line of walking between the ankles of the two feet.
    toe_out_rad : float
        Angle by which each foot points outwards.
    stance_share : float
        Contact time over stride time.
    landing_share, heel_off_share : float
        Parts of the stride time in which the foot comes down from heel contact to flat, and in which the heel
        is up before foot off. What is left of the stance is the foot's rest.
    toe_up_rad, heel_rise_rad : float
        Pitch of the foot at initial contact, and of the sole at foot off.
    lift_m : float
        Greatest height of the whole sole over the floor in mid-swing.
    circumduction_m : float
        How far the swinging foot passes outwards.
    heel_strike_mps2 : float
        Greatest deceleration of the heel when it lands, and size of the vibration that follows.
    length_asymmetry, time_asymmetry : float
        Left steps are longer, and take longer, by this share, right ones shorter.
    variability : float
        Coefficient of variation of the length and time of single steps.
    """

    stride_length_m: float = 1.30
    stride_time_s: float = 1.08
    step_width_m: float = 0.10
    toe_out_rad: float = 0.10
    stance_share: float = 0.62
    landing_share: float = 0.09
    heel_off_share: float = 0.25
    toe_up_rad: float = 0.30
    heel_rise_rad: float = 1.1
    lift_m: float = 0.045
    circumduction_m: float = 0.015
    heel_strike_mps2: float = 25.0
    length_asymmetry: float = 0.0
    time_asymmetry: float = 0.0
    variability: float = 0.0

    def __post_init__(self) -> None:
        if not 0.51 <= self.stance_share <= 0.9:
            raise InputError("invalid_gait", "The stance share must lie between 0.51 and 0.9 to be walking.")
        if self.rest_share < 0.05:
            raise InputError(
                "invalid_gait",
                "The foot would rest for less than 5 % of the stride.",
                "Make the stance share larger, or the landing and heel-off shares smaller.",
            )
        if min(self.stride_length_m, self.stride_time_s, self.toe_up_rad, self.heel_rise_rad) <= 0.0:
            raise InputError("invalid_gait", "Lengths, times and angles of a gait must be above zero.")
        if self.step_time_s(Side.LEFT) <= 0 or min(self.step_time_s(s) - self.swing_s(s) for s in Side) <= 0:
            raise InputError("invalid_gait", "A foot would leave the floor before the other has reached it.")

    @property
    def rest_share(self) -> float:
        """Part of the stride in which the foot is flat and still."""
        return self.stance_share - self.landing_share - self.heel_off_share

    @property
    def landing_s(self) -> float:
        """Time from initial contact to flat foot."""
        return self.landing_share * self.stride_time_s

    @property
    def heel_off_s(self) -> float:
        """Time from the heel's rise to foot off."""
        return self.heel_off_share * self.stride_time_s

    def step_time_s(self, side: Side) -> float:
        """Time from the other foot's contact to this foot's."""
        return 0.5 * self.stride_time_s * (1.0 + leftward(side) * self.time_asymmetry)

    def swing_s(self, side: Side) -> float:
        """Time for which this foot is in the air."""
        return (1.0 - self.stance_share) * self.stride_time_s * (1.0 + leftward(side) * self.time_asymmetry)


@dataclass(frozen=True)
class Stand:
    """Stand still, feet side by side. A walk before it ends with a closing step."""

    duration_s: float = 3.0

    def __post_init__(self) -> None:
        if self.duration_s <= 0.0:
            raise InputError("invalid_plan", "Standing must last longer than zero seconds.")


@dataclass(frozen=True)
class Walk:
    """Walk straight on for a length (steps are stretched a little to fit it) or a number of strides."""

    length_m: float | None = None
    n_strides: int | None = None
    gait: Gait | None = None

    def __post_init__(self) -> None:
        if (self.length_m is None) == (self.n_strides is None):
            raise InputError("invalid_plan", "A walk needs either a length or a number of strides.")
        if (self.length_m or self.n_strides or 0) <= 0:
            raise InputError("invalid_plan", "A walk must be longer than zero.")


@dataclass(frozen=True)
class Turn:
    """Change direction by an angle, positive to the left, in short steps; one for each 45° if not said."""

    angle_rad: float = math.pi
    n_steps: int | None = None
    step_length_m: float = 0.20
    gait: Gait | None = None

    @property
    def steps(self) -> int:
        """Number of steps taken."""
        return self.n_steps or max(1, math.ceil(abs(self.angle_rad) / (math.pi / 4) - 1e-9))


Leg = Stand | Walk | Turn


@dataclass(frozen=True)
class Plan:
    """A course, who walks it and how.

    Attributes
    ----------
    legs : tuple
        ``Stand``, ``Walk`` and ``Turn`` in order; the first and the last are ``Stand``.
    gait, person
        Gait of every leg that names none of its own; body.
    first_foot : Side
        The foot that makes the first step.
    seed : int
        Draws the variability of single steps.

    Raises
    ------
    InputError
        Where the course does not begin and end standing.
    """

    legs: tuple[Leg, ...] = field(default=(Stand(), Walk(10.0), Stand()))
    gait: Gait = Gait()
    person: Person = Person()
    first_foot: Side = Side.RIGHT
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.legs or not (isinstance(self.legs[0], Stand) and isinstance(self.legs[-1], Stand)):
            raise InputError(
                "invalid_plan", "A course begins and ends standing.", "Add Stand() at both ends of the plan."
            )

    def with_gait(self, **changes: float) -> Plan:
        """Return the same course walked with some properties of the gait changed."""
        return replace(self, gait=replace(self.gait, **changes))
