"""How a foot moves between its footfalls.

A foot stands flat and perfectly still; its heel rises and it rolls about the forefoot; it leaves the floor,
swings with the toes first down and then up; it lands on the rear edge of the heel and comes down flat. With
the pitch θ(t) of the sole (toes up positive), its progress s(t) from one footfall to the next and its lift
z(t), each a quintic track, the point of the sole under the ankle is at

    footfall + s·(next footfall − footfall) + X(θ)·heading + (H(θ) + z)·up,

where X and H say how a sole that ends at heel and forefoot rolls on the floor without slipping; it is never
below the floor. The heel lands on a cushion a few millimetres thick, which is pressed flat after contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.recording.model import Bools, Floats, Side
from gaitlab.simulation.footfalls import Footfalls
from gaitlab.simulation.jet import Jet, Track, sin_cos
from gaitlab.simulation.motion import Motion, Pose
from gaitlab.simulation.walk import Person, leftward

# The shape of a gait cycle; tuned so that the angular rate about the pitch axis follows the median of 1,500
# hand-checked swings of eight healthy adults from 0.3 s before to 0.25 s after foot off and initial contact.

#: The foot speeds up over the first and slows down over the last part of its way (shares of its time).
_SPEED_UP, _SLOW_DOWN = 0.28, 0.45
#: The tip of the shoe starts forward before foot off, the heel comes to rest after contact (shares of swing).
_DRAG, _SLIP = 0.07, 0.07
#: The heel rises fastest at this share of its rise before foot off.
_FASTEST_RISE = 0.11
#: The sole is tipped most soon after foot off, the toes are highest just before contact (shares of swing).
_AFTER_OFF, _BEFORE_CONTACT = 0.085, 0.085
#: Rate at which the toes come down at initial contact, over the mean rate of the landing; its change.
_LANDING_RATE, _LANDING_BEND = 1.05, 4.5
#: Share of the landing in which the heel's cushion is pressed flat.
_CUSHION = 0.23
#: Waves of the shock between initial contact and flat foot; how fast it decays (strongest at 1/6 of the landing).
_SHOCK_WAVES, _SHOCK_DECAY = 2.5, 5
#: Roll of the foot in swing; how far the sensor rocks when a shock displaces it (rad per metre).
_SWING_ROLL_RAD, _ROCKING_RADPM = 0.12, 12.0
#: Direction of the shock in segment coordinates: forward, outwards, up.
_SHOCK_DIRECTION = (-0.6, 0.2, 0.77)


@dataclass(frozen=True, eq=False)
class FootMotion:
    """One foot: its pose at any time, and the shock that its initial contacts give."""

    side: Side
    person: Person
    footfalls: Footfalls

    def __post_init__(self) -> None:
        falls = self.footfalls
        tracks = {
            "x": _between(falls, falls.position_m[:, 0]),
            "y": _between(falls, falls.position_m[:, 1]),
            "yaw": _between(falls, falls.heading_rad),
            "tip": _tip(falls),
            "swing": _swing_bump(falls),
            "lift": _lift(falls),
        }
        object.__setattr__(self, "_tracks", tracks)

    def pose(self, t_s: Floats) -> Pose:
        """Pose of the sole at the instants ``t_s``; its origin is the point of the sole under the ankle."""
        tracks: dict[str, Track] = self.__dict__["_tracks"]
        outwards = leftward(self.side)
        swing_no, swinging = _swing_at(self.footfalls, t_s)
        yaw, tip, bump = tracks["yaw"](t_s), tracks["tip"](t_s), tracks["swing"](t_s)
        aside = np.array([gait.circumduction_m for gait in self.footfalls.gaits[1:]] or [0.0])[swing_no]
        forward, up = _rolling(tip, self._softening(swing_no, swinging), self.person)
        sine, cosine = sin_cos(yaw)
        left = bump * (outwards * aside)
        return Pose(
            x=tracks["x"](t_s) + cosine * forward - sine * left,
            y=tracks["y"](t_s) + sine * forward + cosine * left,
            z=up + tracks["lift"](t_s),
            yaw=yaw,
            pitch=-tip,
            roll=bump * (outwards * _SWING_ROLL_RAD),
        )

    def sensor(self, t_s: Floats) -> Motion:
        """Movement of the foot's sensor, shaken by each initial contact."""
        sole, shock = self.pose(t_s), self.shock(t_s)
        shaken = replace(sole, roll=sole.roll + shock * _ROCKING_RADPM)
        return shaken.motion(self.shaken_place(self.person.foot_sensor_m, shock))

    def shaken_place(self, place: tuple[float, float, float], shock: Jet) -> tuple[Jet, Jet, Jet]:
        """A place in segment coordinates while a shock displaces it."""
        forward, out, up = _SHOCK_DIRECTION
        left = out * leftward(self.side)
        return shock * forward + place[0], shock * left + place[1], shock * up + place[2]

    def shock(self, t_s: Floats) -> Jet:
        """A short damped vibration (m) after each initial contact; zero once the foot is flat."""
        falls, gaits = self.footfalls, self.footfalls.gaits
        fall = np.clip(np.searchsorted(falls.initial_contact_s, t_s, side="right") - 1, 0, None)
        length = np.array([gait.landing_s for gait in gaits])
        frequency = 2.0 * np.pi * _SHOCK_WAVES / length
        size: Floats = falls.effort * np.array([gait.heel_strike_mps2 for gait in gaits]) / frequency**2
        u = np.clip((t_s - falls.initial_contact_s[fall]) / length[fall], 0.0, 1.0)
        inner = Jet(u, np.where((u > 0.0) & (u < 1.0), 1.0 / length[fall], 0.0), np.zeros_like(u))
        return _envelope(inner) * sin_cos(inner * (2.0 * np.pi * _SHOCK_WAVES))[0] * size[fall]

    def _softening(self, swing_no: np.ndarray, swinging: Bools) -> Floats:
        """Sine of the pitch below which the foot is turned over its edges softly; 0 in contact."""
        smallest = [
            0.7 * np.sin(effort * min(gait.toe_up_rad, gait.heel_rise_rad))
            for effort, gait in zip(self.footfalls.effort[1:], self.footfalls.gaits[1:], strict=True)
        ]
        return np.where(swinging, np.array(smallest or [0.0])[swing_no], 0.0)


def _swing_at(falls: Footfalls, t_s: Floats) -> tuple[np.ndarray, Bools]:
    """For each instant the number of the swing under way or else next to come, and whether it is under way."""
    off, contact = falls.foot_off_s[:-1], falls.initial_contact_s[1:]
    if len(off) == 0:
        return np.zeros(len(t_s), dtype=np.int_), np.zeros(len(t_s), dtype=np.bool_)
    number = np.minimum(np.searchsorted(contact, t_s, side="right"), len(off) - 1)
    return number, (t_s > off[number]) & (t_s < contact[number])


def _between(falls: Footfalls, value: Floats) -> Track:
    """Track that stays at ``value[k]`` while foot k rests and goes over to the next while the foot swings."""
    swing = falls.initial_contact_s[1:] - falls.foot_off_s[:-1]
    start, swing = falls.foot_off_s[:-1] - _DRAG * swing, (1.0 + _DRAG + _SLIP) * swing
    step = np.diff(value)
    speed = step / (swing * (1.0 - 0.5 * (_SPEED_UP + _SLOW_DOWN)))
    zero = np.zeros_like(step)
    columns = [
        (start, value[:-1], zero),
        (start + _SPEED_UP * swing, value[:-1] + 0.5 * _SPEED_UP * swing * speed, speed),
        (start + (1.0 - _SLOW_DOWN) * swing, value[1:] - 0.5 * _SLOW_DOWN * swing * speed, speed),
        (start + swing, value[1:], zero),
    ]
    knots, values, rates = (np.column_stack(column).ravel() for column in zip(*columns, strict=True))
    return _track(knots, values, rates, np.zeros_like(knots), float(value[0]))


def _tip(falls: Footfalls) -> Track:
    """Pitch of the sole, toes up positive."""
    gaits, zero = falls.gaits[1:], np.zeros(len(falls.gaits) - 1)
    tip = falls.effort[1:] * np.array([gait.heel_rise_rad for gait in gaits])
    toe_up = falls.effort[1:] * np.array([gait.toe_up_rad for gait in gaits])
    landing = np.array([gait.landing_s for gait in gaits])
    heel_off, foot_off, contact = falls.heel_off_s[:-1], falls.foot_off_s[:-1], falls.initial_contact_s[1:]
    rise, swing = foot_off - heel_off, contact - foot_off
    rising, slowing = (1.0 - _FASTEST_RISE) * rise, _FASTEST_RISE * rise + _AFTER_OFF * swing
    speed = tip / (0.4 * rising + 0.6 * slowing)
    before, dropping = _BEFORE_CONTACT * swing, _LANDING_RATE * toe_up / landing
    first_bend, bend = 0.6 * dropping / before, _LANDING_BEND * toe_up / landing**2
    highest = toe_up + 0.5 * dropping * before - (bend - first_bend) * before**2 / 12.0
    columns = [
        (heel_off, zero, zero, zero),
        (heel_off + rising, -0.4 * speed * rising, -speed, zero),
        (foot_off + _AFTER_OFF * swing, -tip, zero, 1.1 * speed / slowing),
        (contact - before, highest, zero, -first_bend),
        (contact, toe_up, -dropping, -bend),
        (contact + landing, zero, zero, zero),
    ]
    knots, values, rates, bends = (np.column_stack(column).ravel() for column in zip(*columns, strict=True))
    return _track(knots, values, rates, bends, 0.0)


def _lift(falls: Footfalls) -> Track:
    """Height of the whole sole over the floor, until the heel's cushion is pressed flat."""
    start, end = falls.foot_off_s[:-1], falls.initial_contact_s[1:]
    gaits, zero = falls.gaits[1:], np.zeros(len(start))
    height = np.array([gait.lift_m for gait in gaits])
    pressing = _CUSHION * np.array([gait.landing_s for gait in gaits])
    speed = falls.effort[1:] * np.array([gait.heel_strike_mps2 for gait in gaits]) * pressing / 1.5
    columns = [
        (start, zero, zero, zero),
        (0.5 * (start + end), height, zero, -8.0 * height / (end - start) ** 2),
        (end, 0.5 * speed * pressing, -speed, zero),
        (end + pressing, zero, zero, zero),
    ]
    knots, values, rates, bends = (np.column_stack(column).ravel() for column in zip(*columns, strict=True))
    return _track(knots, values, rates, bends, 0.0)


def _swing_bump(falls: Footfalls) -> Track:
    """Zero in contact, one in mid-swing."""
    start, end = falls.foot_off_s[:-1], falls.initial_contact_s[1:]
    knots = np.column_stack([start, 0.5 * (start + end), end]).ravel()
    values = np.tile([0.0, 1.0, 0.0], len(start))
    bends = np.column_stack([0 * start, -8.0 / (end - start) ** 2, 0 * start]).ravel()
    return _track(knots, values, np.zeros_like(knots), bends, 0.0)


def _envelope(u: Jet) -> Jet:
    """Rises from 0 at u = 0 to 1 at its strongest and falls to 0 at u = 1, smoothly at both ends."""
    k, x, rest = _SHOCK_DECAY, u.value, 1.0 - u.value
    g, slope = x * rest**k, rest ** (k - 1) * (1.0 - (k + 1) * x)
    bend = k * rest ** (k - 2) * ((k + 1) * x - 2.0)
    peak = (k**k / (k + 1) ** (k + 1)) ** 3
    return u.through(g**3 / peak, 3.0 * g**2 * slope / peak, (6.0 * g * slope**2 + 3.0 * g**2 * bend) / peak)


def _track(knots: Floats, values: Floats, rates: Floats, bends: Floats, constant: float) -> Track:
    """The track through these knots, or a constant where the foot makes no step."""
    if len(knots) == 0:
        return Track.through(np.array([0.0, 1.0]), np.full(2, constant), np.zeros(2), np.zeros(2))
    return Track.through(knots, values, rates, bends)


def _rolling(tip: Jet, softening: Floats, person: Person) -> tuple[Jet, Jet]:
    """How far forward and up the sole goes, under the ankle, when it tips on its heel or forefoot edge.

    A convex sole with support function H(θ) rolls by X(θ) = −∫H dθ. With a sharp heel edge h behind and a
    forefoot edge b before the point, H = h·sin θ, X = −h(1 − cos θ) for θ > 0, and H = b·|sin θ|, X = b(1 −
    cos θ) for θ < 0. In the air, where only a smooth path matters, |sin θ| and sgn θ are replaced below
    ``softening`` by polynomials that never lie under |sin θ| and meet it with two equal derivatives.
    """
    sine, cosine = sin_cos(tip)
    s = sine.value
    soft = np.where(softening > 0.0, softening, 1.0)
    w = np.clip(s / soft, -1.0, 1.0)
    inside = (softening > 0.0) & (np.abs(s) < softening)
    w2 = w * w
    size = sine.through(
        np.where(inside, soft * (5.0 + 15.0 * w2 - 5.0 * w2**2 + w2**3) / 16.0, np.abs(s)),
        np.where(inside, w * (30.0 - 20.0 * w2 + 6.0 * w2**2) / 16.0, np.sign(s)),
        np.where(inside, (30.0 - 60.0 * w2 + 30.0 * w2**2) / (16.0 * soft), 0.0),
    )
    sign = sine.through(
        np.where(inside, w * (35.0 - 35.0 * w2 + 21.0 * w2**2 - 5.0 * w2**3) / 16.0, np.sign(s)),
        np.where(inside, 35.0 * (1.0 - w2) ** 3 / (16.0 * soft), 0.0),
        np.where(inside, -210.0 * w * (1.0 - w2) ** 2 / (16.0 * soft**2), 0.0),
    )
    heel, forefoot = person.heel_m, person.forefoot_m
    half_sum, half_difference = 0.5 * (heel + forefoot), 0.5 * (forefoot - heel)
    up = size * half_sum + sine * (-half_difference)
    forward = (-cosine + 1.0) * (half_difference + (-half_sum) * sign)
    return forward, up
