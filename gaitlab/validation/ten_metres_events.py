"""Rows 5, 6 and 7: events, stride times and rests against what was checked by hand."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import LONGEST_STRIDE_S
from gaitlab.recording.model import Floats, Side
from gaitlab.validation.model import Figure, Goal, Row
from gaitlab.validation.statistics import MS, mean_absolute, mean_and_sd, share
from gaitlab.validation.ten_metres_trials import CONTACT, OFF, Labels, Trial, feet_of
from gaitlab.validation.truth import match_instants

TOLERANCE_S = 0.05
PARTS = ("straight", "turn", "first step", "last step", "after the trial")
LONG_STANCE_S = 1.3
"""A longer stance may hold steps that nobody labelled: two rests in it are no mistake."""
RIM_S = 0.03
"""A moment of rest this near to the border of a swing is not in it."""


@dataclass(frozen=True, eq=False)
class EventCheck:
    """Events of one kind of one foot against the hand-checked ones.

    Attributes
    ----------
    part : list of str
        Of each labelled event: one of ``PARTS``.
    error_s : ndarray (k,)
        Ours less the labelled, NaN where there is none within the tolerance.
    found, wrong : int
        Events of ours in swings that overlap the trial, and those of them that match no labelled one.
    """

    part: list[str]
    error_s: Floats
    found: int
    wrong: int


def check_events(foot: FootGait, labels: Labels, side: Side) -> tuple[EventCheck, EventCheck]:
    """Foot off and initial contact of one foot."""
    walking = foot.walking
    ours = np.stack([foot.events.foot_off_s[walking], foot.events.initial_contact_s[walking]], axis=1)
    swings = labels.swings[side]
    parts = parts_of(swings, labels)
    inside = (ours[:, OFF] < labels.trial[1]) & (ours[:, CONTACT] > labels.trial[0])
    checks = []
    for kind in (OFF, CONTACT):
        found, truth = match_instants(ours[:, kind], swings[:, kind], TOLERANCE_S)
        error = np.full(len(swings), np.nan)
        error[truth] = ours[found, kind] - swings[truth, kind]
        wrong = inside.copy()
        wrong[found] = False
        checks.append(EventCheck(parts, error, int(inside.sum()), int(wrong.sum())))
    return checks[OFF], checks[CONTACT]


def parts_of(swings: Floats, labels: Labels) -> list[str]:
    """Which part of the trial each labelled swing belongs to."""
    parts = [
        "turn" if off < labels.turn[1] and contact > labels.turn[0] else "straight" for off, contact in swings
    ]
    within = [k for k in range(len(swings)) if swings[k, OFF] < labels.trial[1]]
    for k in range(len(within), len(parts)):
        parts[k] = "after the trial"
    if within:
        parts[within[-1]] = "last step"
        parts[0] = "first step"
    return parts


def stride_time_errors(contact: EventCheck, swings: Floats) -> Floats:
    """Ours less the labelled time from contact to contact, over successive labelled contacts that were both found.

    A time that holds a stop is no stride time.
    """
    errors = np.diff(contact.error_s)
    walked = np.diff(swings[:, CONTACT]) <= LONGEST_STRIDE_S
    return np.asarray(errors[np.isfinite(errors) & walked])


@dataclass(frozen=True)
class StanceCheck:
    """Hand-checked stances, those without a rest, and the short ones with more than one."""

    stances: int
    missed: int
    doubled: int
    swings: int
    false: int


def check_stances(moments_s: Floats, swings: Floats) -> StanceCheck:
    """Moments of rest against the stances between labelled swings; a moment in mid-swing is false."""
    stances = missed = doubled = false = 0
    for (_, contact), (off, _) in itertools.pairwise(swings):
        n = int(np.sum((moments_s >= contact) & (moments_s <= off)))
        stances += 1
        missed += n == 0
        doubled += n > 1 and off - contact < LONG_STANCE_S
    for off, contact in swings:
        false += bool(np.any((moments_s > off + RIM_S) & (moments_s < contact - RIM_S)))
    return StanceCheck(stances, missed, doubled, len(swings), false)


def event_rows(trials: Sequence[Trial]) -> list[Row]:
    """Rows 5, 6 and 7, and the rests."""
    offs, contacts = [], []
    errors: list[float] = []
    for trial, side, foot in feet_of(trials):
        off, contact = check_events(foot, trial.labels, side)
        offs.append(off)
        contacts.append(contact)
        errors += stride_time_errors(contact, trial.labels.swings[side]).tolist()
    rows = _event_rows(5, "initial_contact", "initial contact", contacts)
    rows += _event_rows(6, "foot_off", "foot off", offs)
    rows.append(
        Row(
            "stride_time",
            "stride time against the hand-checked, contact to contact",
            (mean_absolute(errors, MS), *mean_and_sd(errors, MS)),
            len(errors),
            "strides",
            7,
            (Goal("MAE", high=8.0),),
        )
    )
    return [*rows, _rest_row(trials)]


def _event_rows(target: int, key: str, name: str, checks: Sequence[EventCheck]) -> list[Row]:
    error = np.concatenate([check.error_s for check in checks]) if checks else np.zeros(0)
    part = np.array([part for check in checks for part in check.part])
    known = np.isfinite(error)
    found, wrong = sum(check.found for check in checks), sum(check.wrong for check in checks)
    goals = (Goal("recall", low=97.0), Goal("precision", low=97.0))
    figures: tuple[Figure, ...] = (
        share("recall", int(known.sum()), len(error)),
        share("precision", found - wrong, found),
        *mean_and_sd(error[known], MS),
    )
    rows = [
        Row(key, f"{name} within 50 ms of the hand-checked", figures, len(error), "events", target, goals)
    ]
    for one in PARTS:
        here = part == one
        figures = (
            share("recall", int((known & here).sum()), int(here.sum())),
            *mean_and_sd(error[known & here], MS),
        )
        what = f"  {name}: {one}"
        rows.append(Row(f"{key}_{one.replace(' ', '_')}", what, figures, int(here.sum()), "events"))
    return rows


def _rest_row(trials: Sequence[Trial]) -> Row:
    """Rests in the hand-checked stances."""
    checks = [
        check_stances(foot.motion.time_s[foot.motion.rests.moment], trial.labels.swings[side])
        for trial, side, foot in feet_of(trials)
    ]
    stances, swings = sum(c.stances for c in checks), sum(c.swings for c in checks)
    figures = (
        share("missed", sum(c.missed for c in checks), stances),
        share("doubled", sum(c.doubled for c in checks), stances),
        share("in a swing", sum(c.false for c in checks), swings),
    )
    return Row("rests", "rests in the hand-checked stances", figures, stances, "stances")
