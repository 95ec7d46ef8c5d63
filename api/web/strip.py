"""The walk at a glance: when each foot stood, swung and turned, on one line of time."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.result import Foot, Result

TICK_STEPS_S = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600)
MOST_TICKS = 8


@dataclass(frozen=True)
class Span:
    """A piece of the line of time, in percent of its length."""

    start: float
    width: float


@dataclass(frozen=True)
class Lane:
    """One foot: where it was on the ground."""

    side: str
    stances: tuple[Span, ...]


@dataclass(frozen=True)
class Strip:
    """The drawing's geometry; ``ticks`` are (position, seconds)."""

    lanes: tuple[Lane, ...]
    turns: tuple[Span, ...]
    timed: Span | None
    ticks: tuple[tuple[float, int], ...]
    description: str


def walk_strip(result: Result) -> Strip | None:
    """Lay out a trial on a line of time; None where no foot has samples."""
    ends = [sensor.samples / result.clock.rate_hz for sensor in result.sensors.values() if sensor.samples]
    if not ends or not result.feet:
        return None
    end_s = max(ends + [stride.end_s for foot in result.feet.values() for stride in foot.strides])

    def span(start: float, stop: float) -> Span:
        return Span(round(100 * start / end_s, 3), round(100 * max(0.0, stop - start) / end_s, 3))

    lanes = tuple(
        Lane(side, tuple(span(*stance) for stance in _stances(foot, end_s)))
        for side, foot in result.feet.items()
    )
    timed = result.walk.timed
    steps = "; ".join(f"{side} foot {len(foot.strides)} strides" for side, foot in result.feet.items())
    return Strip(
        lanes=lanes,
        turns=tuple(span(turn.start_s, turn.end_s) for turn in result.walk.turns),
        timed=None if timed is None else span(timed.start_s, timed.end_s),
        ticks=_ticks(end_s),
        description=f"Stance of each foot over {end_s:.0f} s: {steps}; {len(result.walk.turns)} turns.",
    )


def _stances(foot: Foot, end_s: float) -> list[tuple[float, float]]:
    """On the ground from each contact to the next foot off, before the first and after the last of them."""
    marks = sorted(
        [(at, False) for at in foot.events.foot_off_s] + [(at, True) for at in foot.events.initial_contact_s]
    )
    stances, since = [], 0.0
    down = not marks or not marks[0][1]
    for at, lands in marks:
        if down and not lands:
            stances.append((since, at))
        if lands and not down:
            since = at
        down = lands
    if down:
        stances.append((since, end_s))
    return stances


def _ticks(end_s: float) -> tuple[tuple[float, int], ...]:
    step = next((s for s in TICK_STEPS_S if end_s / s <= MOST_TICKS), TICK_STEPS_S[-1])
    return tuple((round(100 * at / end_s, 3), at) for at in range(0, int(end_s) + 1, step))
