"""Strides and steps: what each foot did between its rests, and how the two feet alternate."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.events import FootEvents, find_events
from gaitlab.motion.heading import Course, turning_strides
from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Bools, Floats, Side

MIN_WALKING_STRIDE_M = 0.1
"""A shorter movement of a foot is a shift of place, not a stride of a walk (shortest stride in mobgap's gates: 0.15
m)."""


@dataclass(frozen=True, eq=False)
class FootGait:
    """Strides of one foot; arrays have one entry a stride, from rest k to rest k + 1.

    Attributes
    ----------
    start_s, end_s : ndarray
        Quietest moments of the two rests.
    length_m, length_sd_m : ndarray
        Horizontal distance between the rests and its standard uncertainty.
    common_sd : float
        Part of the relative uncertainty of the lengths that all strides share (scale).
    turning, straight, steady : ndarray of bool
        The foot turns in the stride; it lies in a straight part and walks; and is neither the first nor the last
        there (of a walk that has no such stride, all straight ones: see ``few_straight``).
    few_straight : bool
        No straight part has a stride between its first and its last.
    doubtful : ndarray of bool
        More than a tenth of its rows were lost or saturated.
    """

    motion: FootMotion
    events: FootEvents
    start_s: Floats
    end_s: Floats
    length_m: Floats
    length_sd_m: Floats
    common_sd: float
    turning: Bools
    straight: Bools
    steady: Bools
    few_straight: bool
    doubtful: Bools

    def __len__(self) -> int:
        return len(self.length_m)

    @property
    def walking(self) -> Bools:
        """Strides that belong to a walk."""
        return (self.length_m >= MIN_WALKING_STRIDE_M) | self.turning


def foot_gait(motion: FootMotion, course: Course, common_sd: float) -> FootGait:
    """Strides of a foot on a course."""
    moments = motion.time_s[motion.rests.moment]
    start, end = moments[:-1], moments[1:]
    length = np.linalg.norm(np.diff(motion.rest_position_m, axis=0)[:, :2], axis=1)
    events = find_events(motion)
    turning = turning_strides(motion)
    straight = np.zeros(len(length), dtype=np.bool_)
    steady = np.zeros(len(length), dtype=np.bool_)
    middle = 0.5 * (events.foot_off_s + events.initial_contact_s)
    for low, high in course.straights:
        inside = (middle >= low) & (middle <= high) & ~turning & (length >= MIN_WALKING_STRIDE_M)
        straight |= inside
        rows = np.flatnonzero(inside)
        steady[rows[1:-1]] = True
    few_straight = not steady.any()
    if few_straight:
        steady = straight.copy()
    return FootGait(
        motion,
        events,
        start,
        end,
        length,
        motion.displacement_sd_m,
        common_sd,
        turning,
        straight,
        steady,
        few_straight,
        _doubtful(motion),
    )


def _doubtful(motion: FootMotion) -> Bools:
    if len(motion.rests) < 2:
        return np.zeros(0, dtype=np.bool_)
    bad = np.concatenate([[0], np.cumsum(~motion.received | motion.saturated)])
    low, high = motion.rests.moment[:-1], motion.rests.moment[1:]
    share: Bools = (bad[high] - bad[low]) / np.maximum(high - low, 1) > 0.1
    return share


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps on straight parts, in order of their initial contacts; arrays have one entry a step.

    Attributes
    ----------
    left : ndarray of bool
        The left foot made it.
    contact_s, time_s : ndarray
        Its initial contact, and the time since the other foot's.
    length_m, width_m : ndarray
        From the other foot's place of rest to this one's: along and across the line of walking (the line between this
        foot's places of rest before and after). Width is positive with the left foot on the left.
    steady : ndarray of bool
        The stride that made it is steady.
    """

    left: Bools
    contact_s: Floats
    time_s: Floats
    length_m: Floats
    width_m: Floats
    steady: Bools

    def __len__(self) -> int:
        return len(self.left)


def find_steps(feet: Mapping[Side, FootGait]) -> Steps:
    """Steps between the two feet; none where one foot is missing.

    A step is counted where the other foot's initial contact was the one just before, in the same straight part.
    """
    if len(feet) < 2:
        return _no_steps()
    contacts = [
        (float(foot.events.initial_contact_s[k]), side, int(k))
        for side, foot in feet.items()
        for k in np.flatnonzero(foot.walking)
    ]
    contacts.sort(key=lambda one: one[0])
    places = {side: foot.motion.rest_position_m for side, foot in feet.items()}
    rows = []
    for (t_before, other, j), (t, side, k) in itertools.pairwise(contacts):
        if side is other or not (feet[side].straight[k] and feet[other].walking[j]):
            continue
        if not feet[other].straight[j]:
            continue
        here, there = places[side], places[other]
        line = (here[k + 1] - here[k])[:2]
        line = line / max(float(np.linalg.norm(line)), 1e-9)
        step = (here[k + 1] - there[j + 1])[:2]
        across = float(step @ np.array([-line[1], line[0]])) * (1.0 if side is Side.LEFT else -1.0)
        rows.append(
            (side is Side.LEFT, t, t - t_before, float(step @ line), across, bool(feet[side].steady[k]))
        )
    if not rows:
        return _no_steps()
    left, contact, time, length, width, steady = (np.array(column) for column in zip(*rows, strict=True))
    return Steps(left, contact, time, length, width, steady)


def _no_steps() -> Steps:
    none, no = np.zeros(0), np.zeros(0, dtype=np.bool_)
    return Steps(no, none, none, none, none, no)
