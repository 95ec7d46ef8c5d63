"""How a foot points against the line of walking while it rests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.averages import FEW_STRIDES
from gaitlab.gait.lengths import NO_FOOT
from gaitlab.gait.measurement import TWO_SIDED_95, MeasuredSide, Measurement, measured, not_determinable
from gaitlab.gait.strides import FootGait
from gaitlab.motion.quaternions import matrices
from gaitlab.recording.model import Floats, Side

AXIS_SD_DEG = 10.0
"""How far the axis about which a foot rolls may lie from the right angle to its length: 16° in ``mtw-leg-vicon``, against
the optical line from ankle to toe. All that healthy people differ by is 5°, so the angle is never given."""
NO_REST = "Fewer than {least} rests lie between two straight strides."


def toe_out_deg(foot: FootGait, side: Side) -> Floats:
    """Angle of the foot, by its axis of rolling, against the line through its places of rest before and after, in each
    rest between two straight strides, toes outwards positive, shape (m,)."""
    motion = foot.motion
    sound = foot.straight & ~foot.doubtful
    between = np.flatnonzero(sound[:-1] & sound[1:]) + 1
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
    """Foot progression angle, which is not determinable, with what it would be; and its scatter, left and right."""
    angles, scatters = [], []
    for side in Side:
        which = MeasuredSide(side)
        found = toe_out_deg(feet[side], side) if side in feet and len(feet[side]) > 1 else np.zeros(0)
        n = len(found)
        if n < FEW_STRIDES:
            reason = NO_REST.format(least=FEW_STRIDES) if side in feet else NO_FOOT.format(side=side)
            angles.append(not_determinable(d.FOOT_ANGLE, which, reason, n))
            scatters.append(not_determinable(d.FOOT_ANGLE_SD, which, reason, n))
            continue
        sd = float(np.hypot(AXIS_SD_DEG, found.std(ddof=1) / np.sqrt(n)))
        reason = (
            "How the sensor sits on the foot is not known. By the axis about which the foot rolls the angle would be"
            f" {found.mean():.0f}° ± {sd:.0f}°, which says too little; its scatter is given."
        )
        angles.append(not_determinable(d.FOOT_ANGLE, which, reason, n))
        scatters.append(_scatter(which, found))
    return [*angles, *scatters]


def _scatter(which: MeasuredSide, found: Floats) -> Measurement:
    """Standard deviation with its χ² interval; the quantiles by Wilson and Hilferty's cube, good to 1 % from n = 6 on."""
    scatter, free = float(found.std(ddof=1)), len(found) - 1
    low, high = (
        scatter / (1.0 - 2.0 / (9.0 * free) + z * np.sqrt(2.0 / (9.0 * free))) ** 1.5
        for z in (TWO_SIDED_95, -TWO_SIDED_95)
    )
    value = measured(d.FOOT_ANGLE_SD, which, scatter, scatter / float(np.sqrt(2.0 * free)), len(found))
    return replace(value, interval=(float(low), float(high)))
