"""How a foot points against the line of walking while it rests."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import FEW_STRIDES
from gaitlab.gait.lengths import NO_FOOT
from gaitlab.gait.measurement import MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.motion.quaternions import matrices
from gaitlab.recording.model import Floats, Side

AXIS_SD_DEG = 10.0
"""How far the axis about which a foot rolls may lie from the right angle to its length: 16° in ``mtw-leg-vicon``, against
the optical line from ankle to toe."""
NO_REST = "Fewer than two rests lie between two straight strides."
USEFUL_SD_DEG = 5.0
"""An angle more uncertain than this, all of what healthy people differ by, is not given."""


def toe_out_deg(foot: FootGait, side: Side) -> Floats:
    """Angle of the foot, by its axis of rolling, against the line through its places of rest before and after, in each
    rest between two straight strides, toes outwards positive, shape (m,)."""
    motion = foot.motion
    between = np.flatnonzero(foot.straight[:-1] & foot.straight[1:]) + 1
    if not len(between):
        return np.zeros(0)
    world = matrices(motion.attitude[motion.rests.moment[between]])
    x, y, _ = np.einsum("ijk,j->ik", world, foot.events.lateral)
    place = motion.rest_position_m
    line = place[between + 1] - place[between - 1]
    angle = np.arctan2(-x, y) - np.arctan2(line[:, 1], line[:, 0])
    outwards = 1.0 if side is Side.LEFT else -1.0
    return np.asarray(outwards * np.degrees(np.angle(np.exp(1j * angle))))


def foot_angles(feet: Mapping[Side, FootGait]) -> list[Measurement]:
    """Foot progression angle and its scatter, left and right."""
    angles, scatters = [], []
    for side in Side:
        which = MeasuredSide(side)
        found = toe_out_deg(feet[side], side) if side in feet and len(feet[side]) > 1 else np.zeros(0)
        n = len(found)
        if n < 2:
            reason = NO_REST if side in feet else NO_FOOT.format(side=side)
            angles.append(not_determinable(d.FOOT_ANGLE, which, reason))
            scatters.append(not_determinable(d.FOOT_ANGLE_SD, which, reason))
            continue
        angles.append(_angle(which, found))
        scatter = float(found.std(ddof=1))
        value = measured(d.FOOT_ANGLE_SD, which, scatter, scatter / float(np.sqrt(2.0 * (n - 1))), n)
        scatters.append(value.with_attention(f"It rests on {n} only.") if n < FEW_STRIDES else value)
    return [*angles, *scatters]


def _angle(which: MeasuredSide, found: Floats) -> Measurement:
    """Given only where the axis of rolling tells the foot's direction well enough."""
    mean = float(found.mean())
    sd = float(np.hypot(AXIS_SD_DEG, found.std(ddof=1) / np.sqrt(len(found))))
    if sd <= USEFUL_SD_DEG:
        return measured(d.FOOT_ANGLE, which, mean, sd, len(found))
    reason = (
        "How the sensor sits on the foot is not known. By the axis about which the foot rolls the angle would be"
        f" {mean:.0f}° ± {sd:.0f}°, which says too little; its scatter is given."
    )
    return not_determinable(d.FOOT_ANGLE, which, reason, len(found))
