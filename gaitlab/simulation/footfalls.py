"""From a plan to footfalls: where and when each foot stands."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gaitlab.errors import InputError
from gaitlab.recording.model import Floats, Side
from gaitlab.simulation.walk import Gait, Leg, Plan, Stand, Turn, Walk, leftward


@dataclass(slots=True)
class _Contact:
    """One contact of one foot while the course is being laid; infinite times are not known yet."""

    side: Side
    x: float
    y: float
    heading: float
    leg: int
    gait: Gait
    effort: float = 0.0
    initial_contact: float = 0.0
    flat: float = 0.0
    stand_start: float = math.nan
    stand_end: float = math.nan
    heel_off: float = math.inf
    foot_off: float = math.inf


@dataclass(frozen=True, eq=False)
class Footfalls:
    """The k contacts of one foot in order. The first began and the last ends standing.

    Attributes
    ----------
    position_m : ndarray (k, 2)
        Point of the floor under the ankle while the foot is flat.
    heading_rad : ndarray (k,)
        Where the foot points, without jumps by a full turn.
    initial_contact_s, flat_s, heel_off_s, foot_off_s : ndarray (k,)
        Instants of contact; the foot rests in ``[flat_s, heel_off_s)``. Contact and rest of the first begin
        at 0, those of the last end with the course.
    stand_start_s, stand_end_s : ndarray (k,)
        The standing phase within the contact, NaN where there is none.
    effort : ndarray (k,)
        Size of the swing before the contact against a full stride, about 0.3 to 1; 0 for the first.
    leg : ndarray (k,)
        Index of the leg of the plan that the swing before the contact belongs to.
    gaits : tuple of Gait
        Gait of the swing before each contact.
    """

    position_m: Floats
    heading_rad: Floats
    initial_contact_s: Floats
    flat_s: Floats
    heel_off_s: Floats
    foot_off_s: Floats
    stand_start_s: Floats
    stand_end_s: Floats
    effort: Floats
    leg: NDArray[np.int_]
    gaits: tuple[Gait, ...]


@dataclass(frozen=True)
class Span:
    """A leg of the plan and the time [start, end) that it took."""

    leg: Leg
    start_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class Course:
    """All footfalls of a plan.

    A walking leg lasts from the foot off of its first step to that of the next leg's first step, or to the
    initial contact of the closing step where the person stops.
    """

    plan: Plan
    footfalls: Mapping[Side, Footfalls]
    spans: tuple[Span, ...]

    @property
    def duration_s(self) -> float:
        """When the last standing phase ends."""
        return self.spans[-1].end_s


def lay_course(plan: Plan) -> Course:
    """Return the footfalls of a plan; the same plan always gives the same footfalls.

    Raises
    ------
    InputError
        Where changes of gait or variability leave a foot no time to rest.
    """
    layer = _Layer(plan)
    for index, leg in enumerate(plan.legs):
        layer.leg = index
        layer.starts.append(math.nan)
        if isinstance(leg, Stand):
            layer.stand(leg)
        else:
            gait = leg.gait or plan.gait
            for advance, turn in _steps(leg, gait, layer.next_side, layer.rng):
                layer.step(gait, advance, turn)
    return layer.course()


def _steps(
    leg: Walk | Turn, gait: Gait, first: Side, rng: np.random.Generator
) -> Iterator[tuple[float, float]]:
    """Yield how far each step of a leg goes on, and by how much it turns."""
    if isinstance(leg, Turn):
        for _ in range(leg.steps):
            yield leg.step_length_m, leg.angle_rad / leg.steps
        return
    step = 0.5 * gait.stride_length_m
    total = leg.length_m if leg.length_m is not None else 2.0 * step * (leg.n_strides or 0)
    n = max(1, round(total / step))
    longer = np.where((np.arange(n) % 2 == 0) == (first is Side.LEFT), 1.0, -1.0)
    lengths = 1.0 + gait.length_asymmetry * longer + gait.variability * rng.standard_normal(n)
    for length in lengths * (total / lengths.sum()):
        yield float(length), 0.0


@dataclass
class _Layer:
    """Lays contact after contact. ``x``, ``y``, ``heading`` is the point of the path between the feet."""

    plan: Plan
    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0
    now: float = 0.0
    leg: int = 0
    walking: bool = False
    starts: list[float] = field(default_factory=list)
    contacts: dict[Side, list[_Contact]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.plan.seed)
        self.next_side = self.plan.first_foot
        self.last_gait = self.plan.gait
        for side in Side:
            self.contacts[side] = [self._place(side, self.plan.gait)]

    def _place(self, side: Side, gait: Gait) -> _Contact:
        outwards = leftward(side)
        across = 0.5 * gait.step_width_m * outwards
        x = self.x - across * math.sin(self.heading)
        y = self.y + across * math.cos(self.heading)
        return _Contact(side, x, y, self.heading + gait.toe_out_rad * outwards, self.leg, gait)

    def stand(self, leg: Stand) -> None:
        if self.walking:
            self.step(self.last_gait, 0.0, 0.0)
            self.starts[self.leg] = self.now
            self.now = max(self.contacts[side][-1].flat for side in Side)
            self.walking = False
        else:
            self.starts[self.leg] = self.now
        for side in Side:
            contact = self.contacts[side][-1]
            if math.isnan(contact.stand_start):
                contact.stand_start = self.now
            contact.stand_end = self.now + leg.duration_s
        self.now += leg.duration_s

    def step(self, gait: Gait, advance: float, turn: float) -> None:
        """One step: the next foot leaves its place and comes down beyond the other's."""
        side = self.next_side
        old = self.contacts[side][-1]
        pace = 1.0 + gait.variability * float(self.rng.standard_normal())
        swing = gait.swing_s(side) * pace
        if self.walking:
            self.now += gait.step_time_s(side) * pace
        else:
            self.now += gait.heel_off_s + swing
        old.foot_off = self.now - swing
        flat_s = old.foot_off - old.flat
        old.heel_off = old.foot_off - min(gait.heel_off_s, 0.8 * flat_s)
        if flat_s < 0.1 * gait.stride_time_s:
            raise InputError(
                "invalid_plan",
                "The plan leaves a foot no time to rest.",
                "Use a smaller variability or asymmetry.",
            )
        if math.isnan(self.starts[self.leg]):
            self.starts[self.leg] = old.foot_off
        self.x += advance * math.cos(self.heading + 0.5 * turn)
        self.y += advance * math.sin(self.heading + 0.5 * turn)
        self.heading += turn
        new = self._place(side, gait)
        new.initial_contact, new.flat = self.now, self.now + gait.landing_s
        new.effort = float(np.clip(math.hypot(new.x - old.x, new.y - old.y) / gait.stride_length_m, 0.3, 1.2))
        self.contacts[side].append(new)
        self.walking, self.next_side, self.last_gait = True, side.other, gait

    def course(self) -> Course:
        for side in Side:
            last = self.contacts[side][-1]
            last.heel_off = last.foot_off = self.now
        ends = [*self.starts[1:], self.now]
        spans = zip(self.plan.legs, self.starts, ends, strict=True)
        return Course(
            self.plan,
            {side: _footfalls(contacts) for side, contacts in self.contacts.items()},
            tuple(Span(leg, start, end) for leg, start, end in spans),
        )


def _footfalls(contacts: list[_Contact]) -> Footfalls:
    def column(name: str) -> Floats:
        return np.array([getattr(contact, name) for contact in contacts], dtype=np.float64)

    return Footfalls(
        position_m=np.column_stack([column("x"), column("y")]),
        heading_rad=column("heading"),
        initial_contact_s=column("initial_contact"),
        flat_s=column("flat"),
        heel_off_s=column("heel_off"),
        foot_off_s=column("foot_off"),
        stand_start_s=column("stand_start"),
        stand_end_s=column("stand_end"),
        effort=column("effort"),
        leg=np.array([contact.leg for contact in contacts]),
        gaits=tuple(contact.gait for contact in contacts),
    )
