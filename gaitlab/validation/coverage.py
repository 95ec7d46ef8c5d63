"""Do the 95 % intervals hold the truth? Simulated walks, of which the truth is known exactly, by what troubles them.

The truth of a parameter is the parameter of the same strides computed from the true places and events, so that what is
judged is the measurement and its stated uncertainty, not the choice of strides. What simulated walks lack of real ones is
not in the table: sensors that move on the foot, events of another shape. Those were taken from real recordings, and widen
the intervals of times and phases.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.gait import course as walking
from gaitlab.gait import lengths, timed_walk, timing
from gaitlab.gait import variability as scatter
from gaitlab.gait.knees import knee_gait, knee_parameters
from gaitlab.gait.measurement import MeasuredSide, Measurement
from gaitlab.gait.strides import FootGait, find_steps
from gaitlab.recording.model import Floats, Side
from gaitlab.simulation import TYPICAL_MTW, Plan, SensorErrors, Simulation, Stand, Truth, Turn, Walk, simulate
from gaitlab.simulation.presets import COMFORTABLE, FAST, SHUFFLING, SLOW
from gaitlab.simulation.sampling import Sampling
from gaitlab.validation.model import Figure, Goal, Row, Table

CLASSES: Mapping[str, SensorErrors] = {
    "clean": TYPICAL_MTW,
    "10 % lost": replace(TYPICAL_MTW, lost_share=0.10),
    "saturated": replace(TYPICAL_MTW, acc_range_mps2=40.0),
    "drifting": replace(TYPICAL_MTW, gyr_drift=1e-3),
}
"""What troubles the sensors: typical errors, many lost packets, impacts beyond the accelerometer's range (that of a real
one lies higher, and so do real impacts), and a gyroscope that drifts by 0.3 °/s over half a minute."""
PACES = {"comfortable": COMFORTABLE, "fast": FAST, "slow": SLOW, "shuffling": SHUFFLING}
SAMPLINGS: tuple[Sampling, ...] = ("strapdown", "mean")
LEAST_VARIABILITY = 0.02
COVERED = (90.0, 99.0)
"""Per cent of the 95 % intervals that should hold the truth."""
ENOUGH = 300
"""Of fewer intervals all may hold the truth by chance (0.99³⁰⁰ = 0.05), and are not too wide for that."""
EACH_STRIDE = "each stride length"


class Judged(NamedTuple):
    """One interval against the truth: whose it is, in which class, whether it holds it, and the error over the
    standard uncertainty."""

    name: str
    kind: str
    inside: bool
    relative: float


@dataclass(frozen=True)
class _Trial:
    """A simulated walk and what was made of it."""

    kind: str
    pace: str
    truth: Truth
    analysis: Analysis


def coverage_table(seeds: int = 8) -> Table:
    """The share of intervals that hold the truth, a row a parameter, over ``seeds`` walks a class and pace; the trials of
    a class and pace are one session, whose variability is pooled."""
    trials = list(_trials(seeds))
    judged = [one for trial in trials for one in _judged(trial)]
    judged += _sessions(trials)
    names = dict.fromkeys(one.name for one in judged)
    rows = tuple(_row(name, [one for one in judged if one.name == name]) for name in names)
    return Table("coverage", "simulation", len(trials), rows)


def _row(name: str, judged: list[Judged]) -> Row:
    figures, goals = [], []
    for kind in CLASSES:
        inside = [one.inside for one in judged if one.kind == kind]
        figures.append(Figure(kind, 100.0 * float(np.mean(inside)) if inside else float("nan"), "%", 0))
        goals.append(Goal(kind, COVERED[0], COVERED[1] if len(inside) >= ENOUGH else None))
    spread = float(np.sqrt(np.mean([one.relative**2 for one in judged])))
    figures.append(Figure("error/uncertainty, RMS", spread, "", 2))
    key = name.replace(" ", "_")
    return Row(key, name.replace("_", " "), tuple(figures), len(judged), "intervals", goals=tuple(goals))


def _trials(seeds: int) -> Iterator[_Trial]:
    number = 0
    for kind, errors in CLASSES.items():
        for pace in PACES:
            for seed in range(seeds):
                number += 1
                walk = simulated_walk(pace, errors, number, SAMPLINGS[seed % 2], knees=seed == 0)
                yield _Trial(
                    kind, pace, walk.truth, analyze(walk.recording, Settings(course_m=_course_m(pace)))
                )


def simulated_walk(
    pace: str, errors: SensorErrors, seed: int, sampling: Sampling, *, knees: bool = False
) -> Simulation:
    """Out and back with a turn, a stop, and on; every seed other steps and other errors."""
    gait = replace(PACES[pace], variability=max(PACES[pace].variability, LEAST_VARIABILITY))
    turn = Turn(np.pi, n_steps=8 if gait.stride_length_m < 0.7 else 4)
    legs = (Stand(4.0), Walk(n_strides=8), turn, Walk(n_strides=8), Stand(1.8), Walk(n_strides=4), Stand(2.0))
    return simulate(Plan(legs, gait, seed=seed), errors, seed=seed, knees=knees, sampling=sampling)


def _course_m(pace: str) -> float:
    return round(6.0 * PACES[pace].stride_length_m, 2)


def true_feet(analysis: Analysis, truth: Truth) -> dict[Side, FootGait]:
    """The strides that the analysis found, with their true places and events.

    Events of a stride in which the foot does not truly swing just once are NaN.
    """
    feet = {}
    for side, foot in analysis.gait.feet.items():
        own = truth.feet[side]
        rows = np.rint(foot.motion.time_s * foot.motion.rate_hz).astype(np.intp)
        motion = replace(foot.motion, position_m=own.position_m[rows])
        middle = 0.5 * (own.foot_off_s + own.initial_contact_s)
        first, last = np.searchsorted(middle, foot.start_s), np.searchsorted(middle, foot.end_s)
        known = last - first == 1
        which = np.where(known, np.minimum(first, len(middle) - 1), 0)
        events = replace(
            foot.events,
            foot_off_s=np.where(known, own.foot_off_s[which], np.nan),
            initial_contact_s=np.where(known, own.initial_contact_s[which], np.nan),
        )
        length = np.linalg.norm(np.diff(motion.rest_position_m, axis=0)[:, :2], axis=1)
        feet[side] = replace(foot, motion=motion, events=events, length_m=length)
    return feet


def true_parameters(analysis: Analysis, truth: Truth, feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """The parameters of an analysis from the truth."""
    gait = analysis.gait
    steps = find_steps(feet)
    course_m = float(str(analysis.result.provenance.settings["course_m"]))
    knees = {}
    for side, knee in gait.knees.items():
        rows = np.rint(knee.motion.time_s * knee.motion.rate_hz).astype(np.intp)
        motion = replace(knee.motion, position_m=truth.knees[side].position_m[rows])
        shift = round((feet[side].motion.time_s[0] - knee.motion.time_s[0]) * knee.motion.rate_hz)
        knees[side] = knee_gait(motion, feet[side], shift)
    timed = timed_walk.timed_walk(timed_walk.time_course(feet, gait.course, course_m))
    return [
        *timed,
        *walking.speeds(feet),
        *lengths.traversed_distance(feet),
        *lengths.stride_length(feet),
        *lengths.step_length(feet, steps, True),
        *lengths.step_width(feet, steps, True),
        *timing.times_and_phases(feet, steps),
        walking.path_deviation(feet, gait.course, True),
        *walking.start_to_end(feet),
        *(one for one in knee_parameters(knees) if one.definition.name == "knee_sway"),
    ]


def _judged(trial: _Trial) -> Iterator[Judged]:
    gait = trial.analysis.gait
    feet = true_feet(trial.analysis, trial.truth)
    for side, foot in gait.feet.items():
        errors = (foot.length_m - feet[side].length_m) / foot.length_sd_m
        for error in errors[foot.walking & ~foot.doubtful]:
            yield Judged(EACH_STRIDE, trial.kind, bool(abs(error) <= 1.96), float(error))
    found = {(one.definition.name, one.side): one for one in gait.parameters}
    true = {
        (one.definition.name, one.side): one.value
        for one in true_parameters(trial.analysis, trial.truth, feet)
    }
    true |= _true_spans(trial)
    for key, value in true.items():
        if value is not None and np.isfinite(value):
            yield from _compared(found[key], value, trial.kind)


def _compared(one: Measurement, truth: float, kind: str) -> Iterator[Judged]:
    if one.value is None or one.sd is None or one.ci95 is None:
        return
    low, high = one.ci95
    yield Judged(one.definition.name, kind, low <= truth <= high, (one.value - truth) / max(one.sd, 1e-12))


def _true_spans(trial: _Trial) -> dict[tuple[str, MeasuredSide], float | None]:
    """Truth of what is told by when and how far the feet move: turns and stops."""
    truth, course = trial.truth, trial.analysis.gait.course
    both = MeasuredSide.BOTH
    spans: dict[tuple[str, MeasuredSide], float | None] = {}
    if len(course.turns) == 1:
        turn = course.turns[0]
        leave, reach = _true_rest_edges(truth, turn.start_s, turn.end_s)
        spans["turn_duration", both] = reach - leave
        spans["turn_angle", both] = 180.0
    if len(course.stops) == 1:
        (start, end) = course.stops[0]
        still, gone = (
            _nearest(np.concatenate([foot.rests_s[:, k] for foot in truth.feet.values()]), at)
            for k, at in ((0, start), (1, end))
        )
        spans["stop_duration", both] = gone - still
    return spans


def _true_rest_edges(truth: Truth, start_s: float, end_s: float) -> tuple[float, float]:
    """The true end of a rest nearest to an instant, and the true start of one nearest to another."""
    ends, starts = (np.concatenate([foot.rests_s[:, k] for foot in truth.feet.values()]) for k in (1, 0))
    return _nearest(ends, start_s), _nearest(starts, end_s)


def _nearest(values: Floats, at: float) -> float:
    return float(values[np.abs(values - at).argmin()])


def _sessions(trials: list[_Trial]) -> Iterator[Judged]:
    """Variability pooled over the trials of a class and pace, against that of all simulated strides of the pace."""
    for pace in PACES:
        own = [trial for trial in trials if trial.pace == pace]
        people = _pooled([scatter.spreads_of(true_feet(one.analysis, one.truth)) for one in own])
        true = {}
        for name, sides in people.items():
            for side, spread in ((MeasuredSide(s), one) for s, one in sides.items()):
                size = 1.0 if name == "double_support_sd" else 100.0
                true[name, side] = size * float(np.sqrt(spread.variance))
        for kind in CLASSES:
            session = _pooled([one.analysis.gait.spreads for one in own if one.kind == kind])
            for measured in scatter.variability(session):
                if (key := (measured.definition.name, measured.side)) in true:
                    yield from _compared(measured, true[key], kind)


def _pooled(trials: list[scatter.Spreads]) -> dict[str, dict[Side, scatter.Spread]]:
    gathered: dict[tuple[str, Side], list[scatter.Spread]] = defaultdict(list)
    for trial in trials:
        for name, sides in trial.items():
            for side, spread in sides.items():
                gathered[name, side].append(spread)
    pooled: dict[str, dict[Side, scatter.Spread]] = defaultdict(dict)
    for (name, side), spreads in gathered.items():
        pooled[name][side] = scatter.pooled([one for one in spreads if np.isfinite(one.variance)])
    return pooled
