"""The rows of ten metres and back: paths, closing, events, stride time, rests."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.recording.model import Floats, Side
from gaitlab.validation.model import Cell, Column, Details, Figure, Goal, Row
from gaitlab.validation.statistics import (
    MS,
    M,
    mean_absolute,
    mean_and_sd,
    median_and_p95,
    share,
)
from gaitlab.validation.ten_metres import HALT_S, Labels, Trial
from gaitlab.validation.truth import match_instants

TOLERANCE_S = 0.05
OFF, CONTACT = 0, 1
PARTS = ("straight", "turn", "first step", "last step", "after the trial")
LONG_STANCE_S = 1.3
"""A longer stance may hold steps that nobody labelled: two rests in it are no mistake."""


@dataclass(frozen=True, eq=False)
class Way:
    """How far one foot came: out and back by way of its farthest rest, and from its first place to its last."""

    out_and_back_m: float
    closing_m: Floats

    @property
    def closing_length_m(self) -> float:
        """Horizontal."""
        return float(np.linalg.norm(self.closing_m))


def way_of(foot: FootGait, labels: Labels, side: Side) -> Way:
    """Way of a foot from where it stood before its first labelled swing to where it stands after the trial.

    It stands there once the step is done, if any, that is under way half a second after the trial's last contact.
    """
    moments = foot.motion.time_s[foot.motion.rests.moment]
    places = foot.motion.rest_position_m[:, :2]
    if len(places) < 2:
        return Way(float("nan"), np.full(2, np.nan))
    swings = labels.swings[side]
    began = float(swings[0, OFF]) if len(swings) else labels.trial[0]
    first = max(int(np.searchsorted(moments, began)) - 1, 0)
    rests = foot.motion.rests
    left = foot.motion.time_s[np.maximum(rests.end - 1, rests.start)]
    last = int(np.searchsorted(left[:-1], labels.trial[1] + HALT_S))
    path = places[first : max(last, first) + 1]
    far = path[np.argmax(np.linalg.norm(path - path[0], axis=1))]
    length = np.linalg.norm(far - path[0]) + np.linalg.norm(path[-1] - far)
    return Way(float(length), path[-1] - path[0])


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


def stride_time_errors(contact: EventCheck) -> Floats:
    """Ours less the labelled time from contact to contact, over successive labelled contacts that were both found."""
    errors = np.diff(contact.error_s)
    return np.asarray(errors[np.isfinite(errors)])


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
        false += bool(np.any((moments_s > off + 0.03) & (moments_s < contact - 0.03)))
    return StanceCheck(stances, missed, doubled, len(swings), false)


def _feet(trials: Sequence[Trial]) -> Iterator[tuple[Trial, Side, FootGait]]:
    for trial in trials:
        for side, foot in trial.feet.items():
            yield trial, side, foot


def rows_of(trials: Sequence[Trial]) -> tuple[Row, ...]:
    """All rows."""
    return (*path_rows(trials), *event_rows(trials), *rest_rows(trials))


def path_rows(trials: Sequence[Trial]) -> list[Row]:
    """Rows 3 and 4."""
    ways = [{s: way_of(foot, trial.labels, s) for s, foot in trial.feet.items()} for trial in trials]
    both = [way for way in ways if len(way) == len(Side)]
    differences = [way[Side.LEFT].out_and_back_m - way[Side.RIGHT].out_and_back_m for way in both]
    closing = [one.closing_length_m for way in ways for one in way.values()]
    middle = [
        float(np.linalg.norm(0.5 * (way[Side.LEFT].closing_m + way[Side.RIGHT].closing_m))) for way in both
    ]
    return [
        Row(
            "path_left_minus_right",
            "path out and back by the farthest rest, left − right",
            mean_and_sd(differences, M),
            len(differences),
            "trials",
            3,
            (Goal("SD", high=0.5),),
        ),
        Row(
            "closing_foot",
            "closing error of a foot at the end of the trial",
            median_and_p95(closing, M),
            len(closing),
            "feet",
            4,
            (Goal("median", high=0.3), Goal("P95", high=0.8)),
        ),
        Row(
            "closing_middle",
            "the same, of the point midway between the feet",
            median_and_p95(middle, M),
            len(middle),
            "trials",
        ),
    ]


def event_rows(trials: Sequence[Trial]) -> list[Row]:
    """Rows 5, 6 and 7."""
    offs, contacts = [], []
    errors: list[float] = []
    for trial, side, foot in _feet(trials):
        off, contact = check_events(foot, trial.labels, side)
        offs.append(off)
        contacts.append(contact)
        errors += stride_time_errors(contact).tolist()
    rows = []
    rows += _event_rows(5, "initial_contact", "initial contact", contacts)
    rows += _event_rows(6, "foot_off", "foot off", offs)
    rows.append(
        Row(
            "stride_time",
            "stride time, contact to contact, against the hand-checked",
            (mean_absolute(errors, MS), *mean_and_sd(errors, MS)),
            len(errors),
            "strides",
            7,
            (Goal("MAE", high=8.0),),
        )
    )
    return rows


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


def rest_rows(trials: Sequence[Trial]) -> list[Row]:
    """Rests in the hand-checked stances."""
    checks = [
        check_stances(foot.motion.time_s[foot.motion.rests.moment], trial.labels.swings[side])
        for trial, side, foot in _feet(trials)
    ]
    stances, swings = sum(c.stances for c in checks), sum(c.swings for c in checks)
    figures = (
        share("missed", sum(c.missed for c in checks), stances),
        share("doubled", sum(c.doubled for c in checks), stances),
        share("in a swing", sum(c.false for c in checks), swings),
    )
    return [Row("rests", "rests in the hand-checked stances", figures, stances, "stances")]


def details_of(trials: Sequence[Trial]) -> tuple[Details, ...]:
    """One row a foot of each trial."""
    columns = (
        Column("trial"),
        Column("foot"),
        Column("lost", "%", 1),
        Column("out and back", "m", 3),
        Column("closing", "m", 3),
        Column("labelled swings", "", 0),
        Column("contacts found", "", 0),
        Column("contacts wrong", "", 0),
        Column("foot offs found", "", 0),
        Column("foot offs wrong", "", 0),
        Column("stride time MAE", "ms", 1),
    )
    rows = [_detail(trial, side, foot) for trial, side, foot in _feet(trials)]
    return (Details("trials", columns, tuple(rows)),)


def _detail(trial: Trial, side: Side, foot: FootGait) -> tuple[Cell, ...]:
    way = way_of(foot, trial.labels, side)
    off, contact = check_events(foot, trial.labels, side)
    strides = stride_time_errors(contact)
    return (
        trial.name,
        side.value,
        100.0 * float(np.mean(~foot.motion.received)),
        way.out_and_back_m,
        way.closing_length_m,
        len(contact.part),
        int(np.isfinite(contact.error_s).sum()),
        contact.wrong,
        int(np.isfinite(off.error_s).sum()),
        off.wrong,
        1000.0 * float(np.mean(np.abs(strides))) if len(strides) else None,
    )
