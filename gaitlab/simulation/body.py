"""The walking body: two feet and two knees, known at any instant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gaitlab.recording.model import Floats, Placement, Side
from gaitlab.simulation.foot import FootMotion
from gaitlab.simulation.footfalls import Course, lay_course
from gaitlab.simulation.knee import KneeMotion
from gaitlab.simulation.motion import Motion
from gaitlab.simulation.walk import Plan


@dataclass(frozen=True, eq=False)
class Body:
    """A person walking a course. ``knees`` is empty where only the feet matter."""

    course: Course
    feet: Mapping[Side, FootMotion]
    knees: Mapping[Side, KneeMotion]

    @property
    def placements(self) -> tuple[Placement, ...]:
        """Places of the sensors on this body."""
        knees = tuple(Placement.knee(side) for side in self.knees)
        return tuple(Placement.foot(side) for side in self.feet) + knees

    def sensor(self, placement: Placement, t_s: Floats) -> Motion:
        """Movement of the sensor at ``placement`` at the instants ``t_s``, shape (n,)."""
        if placement.is_foot:
            return self.feet[placement.side].sensor(t_s)
        return self.knees[placement.side].sensor(t_s)


def build_body(plan: Plan, *, knees: bool = True) -> Body:
    """Return the body that walks a plan.

    Raises
    ------
    InputError
        Where the plan leaves a foot no time to rest.
    """
    course = lay_course(plan)
    feet = {side: FootMotion(side, plan.person, course.footfalls[side]) for side in Side}
    return Body(course, feet, {side: KneeMotion(feet[side]) for side in Side} if knees else {})
