"""Strides and steps: what each foot did between its rests, and how the two feet alternate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.events import FootEvents, find_events
from gaitlab.gait.verdicts import Verdicts, judge_strides
from gaitlab.motion.course import Course, CourseParams, Span, Swings
from gaitlab.motion.model import FootMotion, Indices
from gaitlab.recording.model import Bools, Floats, Side


@dataclass(frozen=True, eq=False)
class FootGait:
    """Strides of one foot; arrays have one entry a stride, from rest k to rest k + 1.

    Attributes
    ----------
    start_s, end_s : ndarray
        Instants within the two rests: the quietest, or where the foot has stood for long, the last and the first.
    length_m, length_sd_m : ndarray
        Horizontal distance between the rests and its standard uncertainty.
    common_sd : float
        Part of the relative uncertainty of the lengths that all strides share (scale).
    turning, walking : ndarray of bool
        The foot turns in the stride; the stride belongs to a walk (a turn on the spot does not).
    bout, part : ndarray of int
        Which bout and which straight part it belongs to; −1 for none.
    steady : ndarray of bool
        It lies in a straight part and is neither the first nor the last there (of a walk that has no such stride,
        all straight ones: see ``few_straight``).
    few_straight : bool
        No straight part has a stride between its first and its last.
    verdicts : Verdicts
        Which strides want attention or are invalid, and why.
    """

    motion: FootMotion
    events: FootEvents
    start_s: Floats
    end_s: Floats
    length_m: Floats
    length_sd_m: Floats
    common_sd: float
    turning: Bools
    walking: Bools
    bout: Indices
    part: Indices
    steady: Bools
    few_straight: bool
    verdicts: Verdicts

    def __len__(self) -> int:
        return len(self.length_m)

    @property
    def straight(self) -> Bools:
        """Strides of straight parts."""
        straight: Bools = self.part >= 0
        return straight

    @property
    def doubtful(self) -> Bools:
        """Invalid strides: left out of means, where others are left."""
        return self.verdicts.invalid

    @property
    def continued(self) -> Bools:
        """Strides before which the foot walked already, in the same bout: their stride time is known."""
        continued = np.zeros(len(self), dtype=np.bool_)
        continued[1:] = self.walking[1:] & self.walking[:-1] & (self.bout[1:] == self.bout[:-1])
        return continued


def foot_gait(motion: FootMotion, course: Course) -> FootGait:
    """Strides of a foot on a course."""
    length = np.linalg.norm(np.diff(motion.rest_position_m, axis=0)[:, :2], axis=1)
    start, end = _bounds(motion)
    events = find_events(motion)
    if len(length):
        swings = Swings.of(motion, CourseParams())
        turning, middle = swings.turning, swings.middle_s
        walking = swings.walking & ~events.on_the_spot
    else:
        turning = walking = np.zeros(0, dtype=np.bool_)
        middle = np.zeros(0)
    bout = _index_of(middle, course.bouts, walking)
    part = _index_of(middle, course.straights, walking & ~turning)
    steady = np.zeros(len(length), dtype=np.bool_)
    for index in range(len(course.straights)):
        steady[np.flatnonzero(part == index)[1:-1]] = True
    few_straight = not steady.any()
    return FootGait(
        motion,
        events,
        start,
        end,
        length,
        motion.displacement_sd_m,
        motion.scale_sd,
        turning,
        walking,
        bout,
        part,
        part >= 0 if few_straight else steady,
        few_straight,
        judge_strides(motion, length, motion.displacement_sd_m),
    )


def _bounds(motion: FootMotion, long_rest_s: float = 1.0) -> tuple[Floats, Floats]:
    """Instants at which strides start and end: in a long rest not its middle, or standing would be walking."""
    rests, time_s = motion.rests, motion.time_s
    last = np.maximum(rests.end - 1, rests.start)
    long = (last - rests.start) / motion.rate_hz > long_rest_s
    leave = np.where(long, last, rests.moment)
    reach = np.where(long, rests.start, rests.moment)
    return time_s[leave[:-1]], time_s[reach[1:]]


def _index_of(middle_s: Floats, spans: tuple[Span, ...], belongs: Bools) -> Indices:
    """Index of the interval in which each stride lies; −1 for none."""
    index = np.full(len(middle_s), -1, dtype=np.intp)
    for k, (low, high) in enumerate(spans):
        index[np.searchsorted(middle_s, low) : np.searchsorted(middle_s, high, "right")] = k
    index[~belongs] = -1
    return index


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps of straight parts, in order of their initial contacts; arrays have one entry a step.

    Attributes
    ----------
    left : ndarray of bool
        The left foot made it.
    time_s : ndarray
        Its initial contact, less that of the other foot before it.
    length_m, width_m : ndarray
        From the other foot's place of rest to this one's: along and across the line of walking (the line between
        this foot's places of rest before and after). Width is positive with the left foot on the left.
    part : ndarray of int
        The straight part.
    steady : ndarray of bool
        The stride that made it is steady, and neither it nor the other foot's is doubtful.
    """

    left: Bools
    time_s: Floats
    length_m: Floats
    width_m: Floats
    part: Indices
    steady: Bools

    def __len__(self) -> int:
        return len(self.left)


def find_steps(feet: Mapping[Side, FootGait]) -> Steps:
    """Steps between the two feet; none where one foot is missing.

    A step is counted where the other foot's initial contact was the one just before, in the same straight part.
    """
    rows = np.concatenate([_contacts(side, foot) for side, foot in feet.items()])
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    contact, left, part, steady, doubtful = rows[:, :5].T
    other = left[1:] != left[:-1]
    k = 1 + np.flatnonzero(other & (part[1:] >= 0) & (part[1:] == part[:-1]))
    line, step = rows[k, 7:9] - rows[k, 5:7], rows[k, 7:9] - rows[k - 1, 7:9]
    line /= np.maximum(np.linalg.norm(line, axis=1), 1e-9)[:, None]
    across = step[:, 1] * line[:, 0] - step[:, 0] * line[:, 1]
    return Steps(
        left[k] > 0,
        contact[k] - contact[k - 1],
        np.einsum("ij,ij->i", step, line),
        np.where(left[k] > 0, across, -across),
        part[k].astype(np.intp),
        (steady[k] > 0) & (doubtful[k] + doubtful[k - 1] == 0),
    )


def _contacts(side: Side, foot: FootGait) -> Floats:
    """A row for each stride of the walk, shape (m, 9): its contact, whether it is a left one, straight part, steady,
    doubtful, and the places (x, y) of rest before and after it."""
    k = np.flatnonzero(foot.walking)
    place = foot.motion.rest_position_m[:, :2]
    left = np.full(len(k), side is Side.LEFT)
    flags = (left, foot.part[k], foot.steady[k], foot.doubtful[k])
    return np.column_stack([foot.events.initial_contact_s[k], *flags, place[k], place[k + 1]])
