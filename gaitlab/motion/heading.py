"""Where the walk goes: turns, straight parts, and one world frame for all sensors of a recording."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.motion.foot import heading_change
from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Bools, Floats, Side


@dataclass(frozen=True)
class HeadingParams:
    """What counts as turning, and how the feet are taken to stand at the start.

    Attributes
    ----------
    stride_turn_rad : float
        A stride in which the foot turns by at least this much is a turning one; 20°, against 3° of scatter in
        straight strides of ``mtw-10m-walk``.
    curve_turn_rad, curve_strides : float, int
        So is one of this many successive strides that together turn this much (45° in 3).
    turn_rad : float
        Turning strides that together turn less than this are no turn of the walk.
    min_straight_m : float
        Shorter stretches give no direction.
    standing_width_m, standing_width_sd_m : float
        Distance between the two foot sensors while standing before the walk: an assumption, for nothing in the
        recording tells it. Comfortable stance: 0.17 m between the heel centres (McIlroy and Maki 1997, Clin Biomech
        12:66).
    standing_stagger_sd_m : float
        How far one foot may stand before the other when they are "side by side": an assumption.
    """

    stride_turn_rad: float = 0.35
    curve_turn_rad: float = 0.79
    curve_strides: int = 3
    turn_rad: float = 0.79
    min_straight_m: float = 1.0
    standing_width_m: float = 0.17
    standing_width_sd_m: float = 0.05
    standing_stagger_sd_m: float = 0.03


@dataclass(frozen=True)
class TurnSpan:
    """A turn of the walk: times in seconds and the angle in radians, positive to the left."""

    start_s: float
    end_s: float
    angle_rad: float


@dataclass(frozen=True)
class Course:
    """Turns and straight parts of a walk, as intervals in seconds, in order of time."""

    turns: tuple[TurnSpan, ...]
    straights: tuple[tuple[float, float], ...]


def turning_strides(foot: FootMotion, params: HeadingParams | None = None) -> Bools:
    """True for each stride (from one rest to the next) in which the foot turns, shape (k − 1,)."""
    return _turning(heading_change(foot, foot.rests), params or HeadingParams())


def _turning(change: Floats, p: HeadingParams) -> Bools:
    turning: Bools = np.abs(change) >= p.stride_turn_rad
    share = np.abs(change) >= 0.5 * p.curve_turn_rad / p.curve_strides
    if len(change) < p.curve_strides:
        return turning
    total = np.convolve(change, np.ones(p.curve_strides), mode="valid")
    for first in np.flatnonzero(np.abs(total) >= p.curve_turn_rad):
        window = slice(first, first + p.curve_strides)
        turning[window] |= share[window]
    return turning


@dataclass(frozen=True, eq=False)
class _Swings:
    """Movements of a foot from rest to rest: when it leaves and reaches, how far its heading changes, where it rests."""

    leave_s: Floats
    reach_s: Floats
    change_rad: Floats
    turning: Bools
    place_m: Floats

    @classmethod
    def of(cls, foot: FootMotion, params: HeadingParams) -> _Swings:
        last = np.maximum(foot.rests.end - 1, foot.rests.start)
        change = heading_change(foot, foot.rests)
        leave, reach = foot.time_s[last[:-1]], foot.time_s[foot.rests.start[1:]]
        return cls(leave, reach, change, _turning(change, params), foot.rest_position_m[:, :2])

    def turn_within(self, start_s: float, end_s: float) -> float:
        """Change of heading over the turning strides in an interval."""
        inside = (self.reach_s > start_s) & (self.leave_s < end_s) & self.turning
        return float(self.change_rad[inside].sum())

    def places_within(self, start_s: float, end_s: float) -> Floats:
        """Places (m, 2) of the rests between which the foot walked in an interval."""
        middle = 0.5 * (self.leave_s + self.reach_s)
        low, high = np.searchsorted(middle, start_s, "left"), np.searchsorted(middle, end_s, "right")
        return self.place_m[low : high + 1] if high > low else self.place_m[:0]


def find_course(feet: Mapping[Side, FootMotion], params: HeadingParams | None = None) -> Course:
    """Turns and straight parts of a walk that both feet agree on: turns are common to them.

    Turning strides with no straight part between them are one turn.
    """
    p = params or HeadingParams()
    swings = [_Swings.of(foot, p) for foot in feet.values() if len(foot.rests) > 1]
    if not swings:
        return Course((), ())
    spans = [
        (float(one.leave_s[k]), float(one.reach_s[k])) for one in swings for k in np.flatnonzero(one.turning)
    ]

    def is_straight(start: float, end: float) -> bool:
        return end > start and _longest(swings, start, end) >= p.min_straight_m

    merged = _merged(spans, is_straight)
    turns = [TurnSpan(a, b, float(np.mean([one.turn_within(a, b) for one in swings]))) for a, b in merged]
    turns = [turn for turn in turns if abs(turn.angle_rad) >= p.turn_rad]
    first, last = min(float(one.leave_s[0]) for one in swings), max(float(one.reach_s[-1]) for one in swings)
    edges = [first, *itertools.chain.from_iterable((t.start_s, t.end_s) for t in turns), last]
    parts = zip(edges[::2], edges[1::2], strict=True)
    return Course(tuple(turns), tuple((a, b) for a, b in parts if is_straight(a, b)))


def to_common_frame(
    feet: Mapping[Side, FootMotion], course: Course, params: HeadingParams | None = None
) -> tuple[dict[Side, FootMotion], dict[Side, tuple[float, Floats]]]:
    """Bring the feet into one world frame: x along the first straight part, origin midway between the feet at the
    start.

    Three assumptions join the feet: each walks the first straight part in the same direction; they stand side by
    side at the start; and ``standing_width_m`` apart. A foot alone stands on the origin.

    Returns
    -------
    feet : dict of FootMotion
    moves : dict of (yaw_rad, shift_m)
        What was done to each side, for its knee.
    """
    p = params or HeadingParams()
    aligned: dict[Side, FootMotion] = {}
    moves: dict[Side, tuple[float, Floats]] = {}
    for side, foot in feet.items():
        yaw = -_direction(foot, course, p)
        lateral = 0.0
        if len(feet) == 2:
            lateral = 0.5 * p.standing_width_m * (1.0 if side is Side.LEFT else -1.0)
        turned = foot.turned(yaw)
        start = turned.rest_position_m[0] if len(foot.rests) else turned.position_m[0]
        shift = np.array([0.0, lateral, 0.0]) - start
        aligned[side] = turned.moved(shift)
        moves[side] = (yaw, shift)
    return aligned, moves


def _merged(
    spans: list[tuple[float, float]], is_straight: Callable[[float, float], bool]
) -> list[tuple[float, float]]:
    """Join the spans that overlap or have no straight part between them."""
    merged: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if merged and (start <= merged[-1][1] or not is_straight(merged[-1][1], start)):
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return merged


def _longest(swings: Sequence[_Swings], start_s: float, end_s: float) -> float:
    """How far the farther-walking foot gets in an interval, in metres."""
    lengths = [0.0]
    for one in swings:
        places = one.places_within(start_s, end_s)
        if len(places):
            lengths.append(float(np.linalg.norm(places[-1] - places[0])))
    return max(lengths)


def _direction(foot: FootMotion, course: Course, params: HeadingParams) -> float:
    """Direction in radians in which the foot walks the first straight part; of its farthest rest where there is
    none."""
    if len(foot.rests) < 2:
        return 0.0
    swings = _Swings.of(foot, params)
    places = swings.places_within(*course.straights[0]) if course.straights else swings.place_m[:0]
    if len(places) < 2:
        away = np.linalg.norm(swings.place_m - swings.place_m[0], axis=1)
        places = swings.place_m[[0, int(np.argmax(away))]]
    step = places[-1] - places[0]
    return float(np.arctan2(step[1], step[0]))
