"""Means over strides with the uncertainty of the measurement, and their left-right combination."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gaitlab.gait.measurement import Definition, MeasuredSide, Measurement, Status, measured, not_determinable
from gaitlab.recording.model import Floats, Side

FEW_STRIDES = 6
"""Fewer gait cycles than this want attention: Motti Ader et al. 2020, Biosensors 10:128, for foot sensors in
multiple sclerosis."""

SAME_SCALE = ("length", "speed")
"""Groups of parameters that both feet measure by the scale of one kind of sensor."""

TOO_FEW = f"a mean of fewer than {FEW_STRIDES} says little."


def mean_of(
    definition: Definition,
    side: Side,
    values: Floats,
    independent_sd: Floats | float,
    common_sd: float,
    reason: str,
) -> Measurement:
    """Mean of ``values`` with u² = Σ u_independent²/n² + u_common²; not determinable, with ``reason``, where there
    are none.

    The scatter between strides is the patient's and is not part of it.
    """
    n = len(values)
    if n == 0:
        return not_determinable(definition, MeasuredSide(side), reason)
    independent = np.zeros(n) + independent_sd
    sd = float(np.sqrt(np.sum(independent**2) / n**2 + common_sd**2))
    mean = measured(definition, MeasuredSide(side), float(values.mean()), sd, n)
    return with_count(replace(mean, common_sd=float(common_sd)))


def with_count(measurement: Measurement) -> Measurement:
    """Mark a value that rests on few strides."""
    if 0 < measurement.n < FEW_STRIDES:
        return measurement.with_attention(f"It rests on {measurement.n} only; {TOO_FEW}")
    return measurement


def of_both(left: Measurement, right: Measurement, *, a_mean: bool = True) -> Measurement:
    """Mean of the two sides, each side counting alike; not determinable where one of them is not.

    The two sides' errors are independent, but for what is common to all strides of a length or speed: two sensors of a
    kind share their scale and the meaning of their samples, and the mean of both keeps that.

    ``a_mean`` False where the sides are sums: then few strides are no reserve.
    """
    definition = left.definition
    for one, side in ((left, Side.LEFT), (right, Side.RIGHT)):
        if one.status is Status.NOT_DETERMINABLE:
            return not_determinable(
                definition, MeasuredSide.BOTH, f"The {side} side is not determinable: {one.reason}"
            )
    if left.value is None or right.value is None or left.sd is None or right.sd is None:
        return not_determinable(definition, MeasuredSide.BOTH, "One side has no value.")
    value = 0.5 * (left.value + right.value)
    shared = (left.common_sd, right.common_sd) if definition.group in SAME_SCALE else (0.0, 0.0)
    own = left.sd**2 - shared[0] ** 2 + right.sd**2 - shared[1] ** 2
    sd = 0.5 * float(np.sqrt(max(own, 0.0) + sum(shared) ** 2))
    both = measured(definition, MeasuredSide.BOTH, value, sd, left.n + right.n)
    if a_mean and min(left.n, right.n) < FEW_STRIDES:
        return both.with_attention(
            f"It rests on {left.n} of the left and {right.n} of the right only; {TOO_FEW}"
        )
    return both
