"""One world frame for all sensors of a recording, and what is assumed to join them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab.motion.course import Course, CourseParams, Swings
from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Floats, Side


@dataclass(frozen=True)
class FrameParams:
    """How the feet are taken to stand before the walk.

    Attributes
    ----------
    standing_width_m, standing_width_sd_m : float
        Distance between the two foot sensors: an assumption, for nothing in the recording tells it. Comfortable
        stance: 0.17 m between the heel centres (McIlroy and Maki 1997, Clin Biomech 12:66).
    standing_stagger_sd_m : float
        How far one foot may stand before the other when they are "side by side": an assumption.
    standing_s : float
        The feet stand together where both rest for at least this long at once before they leave.
    heading_sd_rad : float
        Standard uncertainty of a foot's direction of walking against the other's, what is left of the heading's drift
        included; 0.5°: on ``mtw-10m-walk`` the ends of the two feet scatter across the line by 0.12 m against each other
        after 20 m, their different places while standing included.
    """

    standing_width_m: float = 0.17
    standing_width_sd_m: float = 0.05
    standing_stagger_sd_m: float = 0.04
    standing_s: float = 0.5
    heading_sd_rad: float = 0.008


@dataclass(frozen=True, eq=False)
class Frame:
    """The feet in one world, and how they came there.

    Attributes
    ----------
    feet : mapping of FootMotion
        In the common frame.
    yaw_rad, shift_m : mappings
        What was done to each side, for its knee.
    stood_together : bool
        Both feet rested at once before the first straight part, so that their places are known to each other.
    """

    feet: Mapping[Side, FootMotion]
    yaw_rad: Mapping[Side, float]
    shift_m: Mapping[Side, Floats]
    stood_together: bool


def to_common_frame(
    feet: Mapping[Side, FootMotion], course: Course, params: FrameParams | None = None
) -> Frame:
    """Bring the feet into one world frame: x along the first straight part, origin midway between the feet where they
    stand before it.

    Three assumptions join the feet: each walks the first straight part in the same direction; they stand side by
    side before it; and ``standing_width_m`` apart. A foot alone stands on the origin.
    """
    p = params or FrameParams()
    anchors = {side: anchor_rest(foot, course) for side, foot in feet.items()}
    aligned: dict[Side, FootMotion] = {}
    yaws: dict[Side, float] = {}
    shifts: dict[Side, Floats] = {}
    for side, foot in feet.items():
        yaws[side] = -_direction(foot, course)
        turned = foot.turned(yaws[side])
        lateral = 0.5 * p.standing_width_m * (1.0 if side is Side.LEFT else -1.0) if len(feet) > 1 else 0.0
        row = foot.rests.moment[anchors[side]] if len(foot.rests) else 0
        shifts[side] = np.array([0.0, lateral, 0.0]) - turned.position_m[row]
        aligned[side] = turned.moved(shifts[side])
    return Frame(aligned, yaws, shifts, len(feet) > 1 and _stand_together(feet, anchors, course, p))


def anchor_rest(foot: FootMotion, course: Course, part: int = 0) -> int:
    """Index of the rest from which the foot leaves into a straight part (by default the first); 0 where it does not."""
    if len(foot.rests) < 2 or part >= len(course.straights):
        return 0
    low, high = Swings.of(foot, CourseParams()).rests_within(course.straights[part])
    return low if high > low else 0


def _stand_together(
    feet: Mapping[Side, FootMotion], anchors: Mapping[Side, int], course: Course, p: FrameParams
) -> bool:
    if not course.straights or not course.follows_standing(course.straights[0]):
        return False
    begin, end = [], []
    for side, foot in feet.items():
        if len(foot.rests) < 2:
            return False
        k = anchors[side]
        begin.append(float(foot.time_s[foot.rests.start[k]]))
        end.append(float(foot.time_s[foot.rests.end[k] - 1]))
    return min(end) - max(begin) >= p.standing_s


def _direction(foot: FootMotion, course: Course) -> float:
    """Direction in radians in which the foot walks the first straight part; of its farthest rest where there is
    none."""
    if len(foot.rests) < 2:
        return 0.0
    swings = Swings.of(foot, CourseParams())
    place = swings.place_m
    low, high = swings.rests_within(course.straights[0]) if course.straights else (0, 0)
    if high <= low:
        low, high = 0, int(np.argmax(np.linalg.norm(place - place[0], axis=1)))
    step = place[high] - place[low]
    return float(np.arctan2(step[1], step[0]))
