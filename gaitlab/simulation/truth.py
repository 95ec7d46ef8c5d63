"""What really happened in a simulated walk, exactly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from gaitlab.recording.model import Floats, Side
from gaitlab.simulation.body import Body
from gaitlab.simulation.footfalls import Course, Span
from gaitlab.simulation.walk import Stand, Turn, Walk, leftward


@dataclass(frozen=True, eq=False)
class FootTruth:
    """One foot. It makes k contacts with the floor and k − 1 strides between them.

    Attributes
    ----------
    rests_s : ndarray (k, 2)
        Intervals [start, end) in which the foot is flat and perfectly still.
    foot_off_s, initial_contact_s : ndarray (k − 1,)
        Instants at which the swings between the contacts begin and end.
    footfall_m : ndarray (k, 2)
        Point of the floor under the ankle.
    heading_rad : ndarray (k,)
        Direction in which the foot points.
    position_m, velocity_mps : ndarray (n, 3)
        Of the sensor, at ``Truth.t_s``.
    stride_length_m : ndarray (k − 1,)
        Horizontal distance of the sensor between successive rests.
    turning : ndarray (k − 1,)
        Whether the stride is not wholly within a straight part.
    """

    rests_s: Floats
    foot_off_s: Floats
    initial_contact_s: Floats
    footfall_m: Floats
    heading_rad: Floats
    position_m: Floats
    velocity_mps: Floats
    stride_length_m: Floats
    turning: NDArray[np.bool_]

    @property
    def stride_time_s(self) -> Floats:
        """Times between successive initial contacts, shape (k − 2,)."""
        return np.diff(self.initial_contact_s)

    @property
    def distance_m(self) -> float:
        """Sum of the strides."""
        return float(self.stride_length_m.sum())


@dataclass(frozen=True, eq=False)
class KneeTruth:
    """One knee: paths of its joint and of its sensor at ``Truth.t_s``, shape (n, 3)."""

    joint_m: Floats
    position_m: Floats
    velocity_mps: Floats


@dataclass(frozen=True, eq=False)
class StepsTruth:
    """Steps within straight parts, in order of time. Each ends with the contact of ``side``.

    ``length_m`` is measured along, ``width_m`` across the direction of walking, between the ankles;
    ``time_s`` between the contacts; ``contact_s`` is when the step ended.
    """

    side: tuple[Side, ...]
    contact_s: Floats
    length_m: Floats
    width_m: Floats
    time_s: Floats


@dataclass(frozen=True, eq=False)
class Truth:
    """A simulated walk.

    World: z up, x along the first straight part, the origin on the floor midway between the feet at the
    start. Times in seconds on the packet clock: 0 is the first packet of the recording.

    Attributes
    ----------
    t_s : ndarray (n,)
        The packets of the whole recording.
    feet, knees : mapping of Side
        ``knees`` is empty where none were simulated.
    straights, turns, stands : tuple of Span
        Parts of the course with the leg of the plan that each came from. A walking part lasts from the foot
        off of its first step to that of the next part's first step, or to the last initial contact.
    steps : StepsTruth
    """

    t_s: Floats
    feet: Mapping[Side, FootTruth]
    knees: Mapping[Side, KneeTruth]
    straights: tuple[Span, ...]
    turns: tuple[Span, ...]
    stands: tuple[Span, ...]
    steps: StepsTruth
    body: Body

    @property
    def first_movement_s(self) -> float:
        """When the first heel rises: the earliest movement of a foot."""
        return min(float(foot.rests_s[0, 1]) for foot in self.feet.values())

    def crossing_s(self, course_m: float) -> float | None:
        """When the first foot has come ``course_m`` forward from where it stood; None where none does.

        The foot is taken at the point of the sole under the ankle; since both feet start side by side on the
        line, this is when the leading foot crosses the end of the course.
        """
        found = [self._crossing_s(side, course_m) for side in Side]
        return min((t for t in found if t is not None), default=None)

    def _crossing_s(self, side: Side, course_m: float) -> float | None:
        def ahead(t_s: Floats) -> Floats:
            return self.body.feet[side].pose(t_s).x.value - course_m

        beyond = np.flatnonzero(ahead(self.t_s) >= 0.0)
        if len(beyond) == 0 or beyond[0] == 0:
            return None
        after = int(beyond[0])
        root = brentq(
            lambda t: float(ahead(np.array([t]))[0]), self.t_s[after - 1], self.t_s[after], xtol=1e-9
        )
        return float(root)


def tell_truth(body: Body, t_s: Floats) -> Truth:
    """Return the truth about a body's movement at the instants ``t_s``."""
    course = body.course
    kinds = {kind: tuple(s for s in course.spans if isinstance(s.leg, kind)) for kind in (Stand, Walk, Turn)}
    knees = {}
    for side, knee in body.knees.items():
        sensor = knee.sensor(t_s)
        knees[side] = KneeTruth(knee.joint(t_s).position_m, sensor.position_m, sensor.velocity_mps)
    return Truth(
        t_s=t_s,
        feet={side: _foot(body, side, t_s) for side in Side},
        knees=knees,
        straights=kinds[Walk],
        turns=kinds[Turn],
        stands=kinds[Stand],
        steps=_steps(course),
        body=body,
    )


def _foot(body: Body, side: Side, t_s: Floats) -> FootTruth:
    falls = body.course.footfalls[side]
    rests = np.column_stack([falls.flat_s, falls.heel_off_s])
    sensor = body.feet[side].sensor(t_s)
    resting = body.feet[side].sensor(rests.mean(axis=1)).position_m[:, :2]
    turned = np.abs(np.diff(falls.heading_rad)) > 1e-9
    in_turn = np.array(
        [isinstance(body.course.plan.legs[leg], Turn) for leg in falls.leg[1:]], dtype=np.bool_
    )
    return FootTruth(
        rests_s=rests,
        foot_off_s=falls.foot_off_s[:-1],
        initial_contact_s=falls.initial_contact_s[1:],
        footfall_m=falls.position_m,
        heading_rad=falls.heading_rad,
        position_m=sensor.position_m,
        velocity_mps=sensor.velocity_mps,
        stride_length_m=np.linalg.norm(np.diff(resting, axis=0), axis=1),
        turning=turned | in_turn,
    )


def _steps(course: Course) -> StepsTruth:
    contacts = sorted(
        (falls.initial_contact_s[k], side, k)
        for side, falls in course.footfalls.items()
        for k in range(1, len(falls.leg))
    )
    rows = []
    for (before_s, other, i), (now_s, side, k) in pairwise(contacts):
        falls, others = course.footfalls[side], course.footfalls[other]
        if falls.leg[k] != others.leg[i] or not isinstance(course.plan.legs[falls.leg[k]], Walk):
            continue
        heading = falls.heading_rad[k] - leftward(side) * falls.gaits[k].toe_out_rad
        ahead = np.array([np.cos(heading), np.sin(heading)])
        apart = falls.position_m[k] - others.position_m[i]
        across = leftward(side) * (ahead[0] * apart[1] - ahead[1] * apart[0])
        rows.append((side, now_s, apart @ ahead, across, now_s - before_s))
    columns = [np.array([row[c] for row in rows], dtype=np.float64) for c in range(1, 5)]
    return StepsTruth(tuple(row[0] for row in rows), *columns)
