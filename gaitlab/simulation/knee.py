"""How the shank, and so the knee, moves over a moving ankle.

The shank is rigid. Its forward lean is a quintic track: leaning back when the heel lands, over the resting
foot like an inverted pendulum, far forward at foot off, still more in early swing, then swinging through. The
body's sway is added all the time, standing included, so a knee hardly ever rests.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Floats
from gaitlab.simulation.foot import FootMotion
from gaitlab.simulation.footfalls import Footfalls
from gaitlab.simulation.jet import Jet, Track, sin_cos
from gaitlab.simulation.motion import Motion, Pose
from gaitlab.simulation.walk import leftward

#: Lean of the shank (rad) for a full stride of 1.3 m: at initial contact, foot flat, heel off, foot off and
#: at its greatest.
_CONTACT, _FLAT, _HEEL_OFF, _FOOT_OFF, _GREATEST = -0.33, -0.19, 0.32, 0.85, 1.02
#: Its rates (rad per stride time) at initial contact, foot flat, heel off and foot off.
_CONTACT_RATE, _FLAT_RATE, _HEEL_OFF_RATE, _FOOT_OFF_RATE = 1.2, 2.0, 1.5, 3.4
#: Body sway: (frequency in Hz, forward, sideways in rad).
_SWAY = ((0.23, 0.006, 0.004), (0.41, 0.004, 0.005), (0.83, 0.0015, 0.002))
#: Outward lean of the shank, and share of the foot's shock that reaches the knee.
_OUTWARD_RAD, _SHOCK_SHARE = 0.03, 0.3


@dataclass(frozen=True, eq=False)
class KneeMotion:
    """The shank of one leg over its foot."""

    foot: FootMotion

    def __post_init__(self) -> None:
        object.__setattr__(self, "_lean", _lean(self.foot.footfalls))

    def pose(self, t_s: Floats) -> Pose:
        """Pose of the shank, its origin in the ankle joint."""
        lean: Track = self.__dict__["_lean"]
        sole = self.foot.pose(t_s)
        x, y, z = sole.point((0.0, 0.0, self.foot.person.ankle_height_m))
        outwards = leftward(self.foot.side)
        forward, sideways = _sway(t_s, phase=0.0 if outwards > 0 else 0.7)
        roll = -(sideways + _OUTWARD_RAD * outwards)
        return Pose(x, y, z, yaw=sole.yaw, pitch=lean(t_s) + forward, roll=roll)

    def joint(self, t_s: Floats) -> Motion:
        """Movement of the knee joint."""
        return self.pose(t_s).motion((0.0, 0.0, self.foot.person.shank_length_m))

    def sensor(self, t_s: Floats) -> Motion:
        """Movement of the sensor on the upper shank."""
        person = self.foot.person
        a, b, c = person.knee_sensor_m
        shock = self.foot.shock(t_s) * _SHOCK_SHARE
        return self.pose(t_s).motion(self.foot.shaken_place((a, b, c + person.shank_length_m), shock))


def _sway(t_s: Floats, phase: float) -> tuple[Jet, Jet]:
    """Slow sway forward and sideways, in radians."""
    zero = np.zeros_like(t_s)
    forward = sideways = Jet(zero, zero, zero)
    for number, (frequency, along, across) in enumerate(_SWAY):
        angle = Jet(2.0 * np.pi * frequency * t_s + number + phase, zero + 2.0 * np.pi * frequency, zero)
        sine, cosine = sin_cos(angle)
        forward, sideways = forward + sine * along, sideways + cosine * across
    return forward, sideways


def _lean(falls: Footfalls) -> Track:
    """Forward lean of the shank in radians."""
    lengths_m = np.array([gait.stride_length_m for gait in falls.gaits])
    before = falls.effort * np.minimum(0.3 + 0.54 * lengths_m, 1.1)
    after = np.append(before[1:], 0.0)
    stands = np.isfinite(falls.stand_start_s)
    stride = np.array([gait.stride_time_s for gait in falls.gaits])
    landing = np.array([gait.landing_s for gait in falls.gaits])
    swing = np.append(falls.initial_contact_s[1:] - falls.foot_off_s[:-1], 1.0)
    zero = np.zeros_like(before)
    first = np.where(stands, falls.stand_start_s, falls.flat_s)
    second = np.where(stands, falls.stand_end_s, falls.heel_off_s)
    walks = np.where(stands, 0.0, 1.0)
    columns = [
        (
            falls.initial_contact_s,
            _CONTACT * before,
            _CONTACT_RATE * before / stride,
            0.1 * before / landing**2,
        ),
        (first, walks * _FLAT * before, walks * _FLAT_RATE * before / stride, zero),
        (second, walks * _HEEL_OFF * after, walks * _HEEL_OFF_RATE * after / stride, zero),
        (falls.foot_off_s, _FOOT_OFF * after, _FOOT_OFF_RATE * after / stride, zero),
        (falls.foot_off_s + 0.2 * swing, _GREATEST * after, zero, -2.4 * after / swing**2 * 4.0),
    ]
    knots, values, rates, bends = (
        np.column_stack(column).ravel()[1:-2] for column in zip(*columns, strict=True)
    )
    return Track.through(knots, values, rates, bends)
