"""Where the walk goes: bouts between standing, turns, and straight parts."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Bools, Floats, Side

Span = tuple[float, float]


@dataclass(frozen=True)
class CourseParams:
    """What counts as walking, stopping and turning.

    Attributes
    ----------
    min_stride_m : float
        A shorter movement of a foot that does not turn is a shift of place, not a stride of a walk (the shortest
        stride in mobgap's gates is 0.15 m).
    stop_s : float
        All feet at rest for longer than this is a stop; it ends a bout of walking.
    one_foot_stop_s : float
        The same where one foot alone was recorded: a slow stance lasts up to 2 s.
    stride_turn_rad : float
        A stride in which the foot turns by at least this much is a turning one; 20°, against 3° of scatter in
        straight strides of ``mtw-10m-walk``.
    curve_turn_rad, curve_strides : float, int
        So is one of this many successive strides that together turn this much (45° in 3).
    turn_rad : float
        Turning strides that together turn less than this are no turn of the walk.
    min_straight_m : float
        Shorter stretches give no direction.
    unseen_share : float
        A foot that lost more of a movement's rows did not see whether it turned.
    """

    min_stride_m: float = 0.1
    stop_s: float = 1.0
    one_foot_stop_s: float = 2.5
    stride_turn_rad: float = 0.35
    curve_turn_rad: float = 0.79
    curve_strides: int = 3
    turn_rad: float = 0.79
    min_straight_m: float = 1.0
    unseen_share: float = 0.5


@dataclass(frozen=True)
class TurnSpan:
    """A turn of the walk: times in seconds and the angle in radians, positive to the left; by how much the feet that saw
    it differ from their mean, and how many did."""

    start_s: float
    end_s: float
    angle_rad: float
    spread_rad: float = 0.0
    seen_by: int = 2


@dataclass(frozen=True)
class Course:
    """Intervals in seconds, in order of time.

    ``bouts`` are stretches of walking between standing; turns and straight parts lie within them. A straight part that
    ``follows_standing`` begins its bout.
    """

    bouts: tuple[Span, ...]
    turns: tuple[TurnSpan, ...]
    straights: tuple[Span, ...]

    @property
    def stops(self) -> tuple[Span, ...]:
        """Standing between two bouts."""
        return tuple((a[1], b[0]) for a, b in itertools.pairwise(self.bouts))

    def follows_standing(self, straight: Span) -> bool:
        """True where the straight part is the beginning of a bout."""
        return any(abs(straight[0] - bout[0]) < 1e-6 for bout in self.bouts)


@dataclass(frozen=True, eq=False)
class Swings:
    """Movements of a foot from rest to rest, one entry each; places (k, 2) of its k rests."""

    leave_s: Floats
    reach_s: Floats
    change_rad: Floats
    turning: Bools
    walking: Bools
    place_m: Floats
    unseen: Bools

    @classmethod
    def of(cls, foot: FootMotion, params: CourseParams) -> Swings:
        """Swings of a foot with at least two rests."""
        last = np.maximum(foot.rests.end - 1, foot.rests.start)
        change = foot.turn_rad
        place = foot.rest_position_m[:, :2]
        turning = _turning(change, params)
        walking = turning | (np.linalg.norm(np.diff(place, axis=0), axis=1) >= params.min_stride_m)
        leave, reach = foot.time_s[last[:-1]], foot.time_s[foot.rests.start[1:]]
        return cls(leave, reach, change, turning, walking, place, foot.doubtful_share > params.unseen_share)

    @property
    def middle_s(self) -> Floats:
        """Time midway between leaving and reaching."""
        middle: Floats = 0.5 * (self.leave_s + self.reach_s)
        return middle

    def spans(self, chosen: Bools) -> list[Span]:
        """Intervals of the chosen swings."""
        return [(float(self.leave_s[k]), float(self.reach_s[k])) for k in np.flatnonzero(chosen)]

    def saw(self, span: Span) -> bool:
        """No movement in an interval was lost for the most part."""
        inside = (self.reach_s > span[0]) & (self.leave_s < span[1])
        return not bool((self.unseen & inside).any())

    def turn_within(self, span: Span) -> float:
        """Change of heading over the turning strides in an interval."""
        inside = (self.reach_s > span[0]) & (self.leave_s < span[1]) & self.turning
        return float(self.change_rad[inside].sum())

    def rests_within(self, span: Span) -> tuple[int, int]:
        """First and last of the rests between which the foot walked in an interval; equal where it did not."""
        middle = self.middle_s
        low = int(np.searchsorted(middle, span[0], "left"))
        return low, max(low, int(np.searchsorted(middle, span[1], "right")))

    def way_within(self, span: Span) -> float:
        """How far the foot gets in an interval, in metres."""
        low, high = self.rests_within(span)
        return float(np.linalg.norm(self.place_m[high] - self.place_m[low])) if high > low else 0.0


def _turning(change: Floats, p: CourseParams) -> Bools:
    """True for each stride in which the foot turns, from its changes of heading, shape (k − 1,)."""
    turning: Bools = np.abs(change) >= p.stride_turn_rad
    if len(change) < p.curve_strides:
        return turning
    share = np.abs(change) >= 0.5 * p.curve_turn_rad / p.curve_strides
    total = np.convolve(change, np.ones(p.curve_strides), mode="valid")
    for first in np.flatnonzero(np.abs(total) >= p.curve_turn_rad):
        window = slice(first, first + p.curve_strides)
        turning[window] |= share[window]
    return turning


def find_course(feet: Mapping[Side, FootMotion], params: CourseParams | None = None) -> Course:
    """Bouts, turns and straight parts of a walk that the recorded feet agree on: stops and turns are common to them.

    Turning strides of a bout with no straight part between them are one turn.
    """
    p = params or CourseParams()
    swings = [Swings.of(foot, p) for foot in feet.values() if len(foot.rests) > 1]
    pause = p.stop_s if len(feet) > 1 else p.one_foot_stop_s
    bouts = _joined([span for one in swings for span in one.spans(one.walking)], pause)
    turning = sorted(span for one in swings for span in one.spans(one.turning))
    turns: list[TurnSpan] = []
    straights: list[Span] = []
    for bout in bouts:
        inside = [span for span in turning if bout[0] <= span[0] and span[1] <= bout[1]]
        found = _turns(swings, inside, p)
        edges = [bout[0], *itertools.chain.from_iterable((t.start_s, t.end_s) for t in found), bout[1]]
        parts = zip(edges[::2], edges[1::2], strict=True)
        turns += found
        straights += [part for part in parts if _is_straight(swings, part, p)]
    return Course(tuple(bouts), tuple(turns), tuple(straights))


def _joined(spans: list[Span], pause_s: float) -> list[Span]:
    """Join the intervals that overlap or lie less than a pause apart."""
    joined: list[Span] = []
    for start, end in sorted(spans):
        if joined and start - joined[-1][1] <= pause_s:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((start, end))
    return joined


def _is_straight(swings: Sequence[Swings], span: Span, p: CourseParams) -> bool:
    return span[1] > span[0] and max(one.way_within(span) for one in swings) >= p.min_straight_m


def _turns(swings: Sequence[Swings], turning: Sequence[Span], p: CourseParams) -> list[TurnSpan]:
    """Turns of one bout from its turning strides."""
    merged: list[Span] = []
    for start, end in turning:
        if merged and (start <= merged[-1][1] or not _is_straight(swings, (merged[-1][1], start), p)):
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    turns = [_turn(swings, span) for span in merged]
    return [turn for turn in turns if abs(turn.angle_rad) >= p.turn_rad]


def _turn(swings: Sequence[Swings], span: Span) -> TurnSpan:
    """A turn by the feet that saw it; by all where none did."""
    seeing = [one for one in swings if one.saw(span)]
    angles = [one.turn_within(span) for one in seeing or swings]
    spread = 0.5 * (max(angles) - min(angles))
    return TurnSpan(*span, float(np.mean(angles)), spread, len(seeing))
