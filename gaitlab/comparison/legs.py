"""What the methods say of a sensor on shank or thigh."""

from __future__ import annotations

import numpy as np

from gaitlab.comparison.feet import Said, Timed
from gaitlab.comparison.inputs import Inputs
from gaitlab.comparison.model import Value
from gaitlab.comparison.pairs import Compared, Pairs
from gaitlab.methods.model import Method
from gaitlab.methods.posture_bousdar2017 import Posture
from gaitlab.methods.thigh_model import ThighTrack, foot_lengths, leg_angles, mounting
from gaitlab.motion.model import KneeMotion
from gaitlab.motion.quaternions import multiply
from gaitlab.recording.model import Side

KNEE = Compared("way of the knee in a cycle", "cycles", "cm", 100.0, 2)
POSTURE = Compared("", "stances", "", 1.0, 0)
THIGH = Compared("stride length", "strides", "cm", 100.0, 2)
NO_CYCLE = "There is no gait cycle."
NO_MOUNTING = "How the sensor sits on the thigh is not determinable: nobody stood or walked."


def knee(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Path of the knee against ours, both from the first cycle on; the way in each cycle."""
    worn = inputs.knee(side)
    assert worn is not None
    sensor, time_s, shift, ours = worn
    foot = inputs.feet[side].motion
    found: KneeMotion = call(method, sensor, time_s, foot, shift)
    if not len(ours.cycle_start):
        return Said((), None, NO_CYCLE)
    start, end = ours.cycle_start, np.minimum(ours.cycle_end, ours.n_samples - 1)
    rows = slice(int(start[0]), int(end[-1]) + 1)
    apart = found.position_m[rows] - ours.position_m[rows]
    apart = apart - apart[0]
    way, our_way = (
        np.linalg.norm((motion.position_m[end] - motion.position_m[start])[:, :2], axis=1)
        for motion in (found, ours)
    )
    values = (
        Value("way", float(way.sum()), "m", 2),
        Value("RMS to ours", 100.0 * float(np.sqrt(np.mean(np.sum(apart**2, axis=1)))), "cm", 1),
        Value("horizontally", 100.0 * float(np.sqrt(np.mean(np.sum(apart[:, :2] ** 2, axis=1)))), "cm", 1),
        Value("cycles", len(start), "", 0),
    )
    return Said(values, Pairs(way - our_way, foot.scale_sd * float(our_way.mean())))


def posture(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Share of stances in which the thigh makes sense, and how far out the others are."""
    view = inputs.thighs[side]
    mount = mounting(view)
    if mount is None:
        return Said((), None, NO_MOUNTING)
    found: Posture = call(method, leg_angles(view, multiply(view.motion.attitude, mount)))
    judged = np.isfinite(found.outside_m)
    out = np.where(found.coherent, np.nan, np.abs(found.correction_rad).max(axis=1, initial=0.0))
    out = np.degrees(out[judged & ~found.coherent])
    values = (
        Value("stances", int(judged.sum()), "", 0),
        Value("coherent", 100.0 * float(found.coherent[judged].mean()) if judged.any() else np.nan, "%", 0),
        Value("others out by", float(out.mean()) if len(out) else 0.0, "°", 1),
        Value("its toe at most", 100.0 * float(found.outside_m[judged].max(initial=0.0)), "cm", 1),
    )
    return Said(values, None, "" if judged.any() else "No stance can be judged.")


def thigh(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Strides of the thigh and their mean length, each against the foot's own."""
    view = inputs.thighs[side]
    found: ThighTrack = call(method, view)
    if found.reason or not len(found.length_m):
        return Said((), None, found.reason or "It finds no stride.")
    ours = foot_lengths(view, found.stride_row)
    known = ours[np.isfinite(ours)]
    level = found.place_m[:, :2]
    values = (
        Value("strides", len(found.length_m), "", 0),
        Value("mean stride", float(found.length_m.mean()), "m", 3),
        Value("start to end", float(np.linalg.norm(level[-1] - level[0])), "m", 2),
    )
    shared = inputs.feet[side].motion.scale_sd * float(known.mean()) if len(known) else 0.0
    return Said(values, Pairs(found.length_m - ours, shared))
