"""What the step-length models say of the strides of each foot."""

from __future__ import annotations

import numpy as np

from gaitlab.comparison.feet import Said, Timed
from gaitlab.comparison.inputs import Inputs
from gaitlab.comparison.model import MethodLengths, Value
from gaitlab.comparison.pairs import Compared, Pairs
from gaitlab.methods.length_factors import Factors, KnownWalk, calibrate
from gaitlab.methods.model import Lengths, Method, Need
from gaitlab.recording.model import Side

LENGTH = Compared("stride length", "strides", "cm", 100.0, 2)
NO_STRIDE = "There is no stride."


def factors_of(method: Method, inputs: Inputs) -> Factors:
    """The person's factors from both feet of the walk itself, whose length is known."""
    if Need.KNOWN_LENGTH not in method.needs or inputs.known_length_m is None:
        return Factors()
    walks = [KnownWalk(steps, inputs.known_length_m) for steps in inputs.strides.values() if len(steps)]
    return calibrate(method, walks, inputs.person)


def length(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Mean stride and step, how many are determinable, and their sum; each stride against ours."""
    steps = inputs.strides[side]
    found: Lengths = call(method, steps, inputs.person, factors_of(method, inputs))
    assert steps.own_m is not None
    if not len(steps):
        return Said((), None, NO_STRIDE)
    known = found.length_m[found.known]
    mean = float(known.mean()) if len(known) else np.nan
    values: tuple[Value, ...] = (
        Value("mean stride", mean, "m", 3),
        Value("step", mean / steps.steps_each, "m", 3),
        Value("strides", len(known), f"of {len(steps)}", 0),
        Value("sum", float(known.sum()) if len(known) else np.nan, "m", 2),
    )
    if found.outside.any():
        values += (Value("outside its range", int(found.outside.sum()), "", 0),)
    foot = inputs.feet[side].motion
    pairs = Pairs(found.length_m - steps.own_m, foot.scale_sd * float(steps.own_m.mean()))
    why = dict.fromkeys(text for text in found.reason if text)
    reason = "; ".join(why) if len(known) < len(steps) else ""
    picture = MethodLengths(method.name, side, found.length_m, steps.own_m)
    return Said(values, pairs, f"{reason[0].upper()}{reason[1:]}." if reason else "", lengths=picture)
