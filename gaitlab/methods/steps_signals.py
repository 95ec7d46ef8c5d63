"""What the step-length models see of each step: how the vertical acceleration moved in it, and how long it took."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import Any

import numpy as np

from gaitlab.methods.model import FootView
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.recording.model import Bools, Floats


class Sex(StrEnum):
    """As the models by height know it."""

    FEMALE = "female"
    MALE = "male"


@dataclass(frozen=True)
class Person:
    """Whose steps they are; None where it is not known."""

    height_m: float | None = None
    sex: Sex | None = None


@dataclass(frozen=True, eq=False)
class StepSignals:
    """Steps as the models of Sun et al. (2015), §II see them; arrays have one entry a row, m of them.

    A row is one step of the body, or one stride of a foot: two steps, of which a sensor on the foot sees but one. What
    cannot be read off a row (lost to an interval without samples) is NaN.

    Attributes
    ----------
    start_s, end_s : ndarray
        From one instant to the next.
    max_g, min_g : ndarray
        Highest and lowest vertical acceleration in it, free of gravity, upwards positive, in units of gravity.
    mean_abs_g : ndarray
        Mean of its absolute value: the papers' "magnitude".
    variance_g2 : ndarray
        About its mean.
    frequency_spm : ndarray
        Steps per minute.
    duration_ms : ndarray
        Of one step.
    steps_each : int
        Steps in a row: 1, or 2 for the stride of a foot.
    own_m : ndarray or None
        Length of each row by the inertial path; None where there is none.
    """

    start_s: Floats
    end_s: Floats
    max_g: Floats
    min_g: Floats
    mean_abs_g: Floats
    variance_g2: Floats
    frequency_spm: Floats
    duration_ms: Floats
    steps_each: int = 1
    own_m: Floats | None = None

    def __len__(self) -> int:
        return len(self.start_s)

    @property
    def range_g(self) -> Floats:
        """Peak less trough."""
        return np.asarray(self.max_g - self.min_g)

    def only(self, chosen: Bools) -> StepSignals:
        """The rows where ``chosen``, shape (m,), is true."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        kept: dict[str, Any] = {
            name: value[chosen] for name, value in values.items() if isinstance(value, np.ndarray)
        }
        return replace(self, **kept)


@dataclass(frozen=True)
class StrideBounds:
    """``long_rest_s``: a foot that rests for longer stands, and its stride does not begin in the middle of the rest. Half
    as long again as the stance of a slow walk."""

    long_rest_s: float = 1.0


def step_signals(
    vertical_mps2: Floats,
    time_s: Floats,
    start_s: Floats,
    end_s: Floats,
    *,
    steps_each: int = 1,
    own_m: Floats | None = None,
) -> StepSignals:
    """Signals of steps or strides, of a sensor anywhere on the body.

    Parameters
    ----------
    vertical_mps2 : ndarray (n,)
        Free acceleration, world, upwards.
    time_s : ndarray (n,)
        Times of its rows, ascending.
    start_s, end_s : ndarray (m,)
        Each row's first instant and the one after its last: from one event to the same event of the next step (sensor on
        waist or hand) or of the foot's next stride.
    steps_each : int
        Steps from start to end.
    own_m : ndarray (m,) or None
    """
    first, last = np.searchsorted(time_s, start_s), np.searchsorted(time_s, end_s)
    edges = np.stack([first, last], axis=1).ravel()
    count = np.maximum(last - first, 1)

    def of_each(reduce: Callable[..., Floats], values: Floats) -> Floats:
        if not len(edges):
            return np.zeros(0)
        padded = np.append(values, 0.0)  # so that an interval that ends with the rows has a valid end
        return np.where(last > first, reduce(padded, edges)[::2], np.nan)

    vertical_g = vertical_mps2 / STANDARD_GRAVITY_MPS2
    mean = of_each(np.add.reduceat, vertical_g) / count
    middle = float(vertical_g.mean()) if len(vertical_g) else 0.0
    spread = of_each(np.add.reduceat, (vertical_g - middle) ** 2) / count - (mean - middle) ** 2
    duration_s = (end_s - start_s) / steps_each
    frequency = np.divide(60.0, duration_s, out=np.full(len(first), np.nan), where=duration_s > 0.0)
    return StepSignals(
        start_s=start_s,
        end_s=end_s,
        max_g=of_each(np.maximum.reduceat, vertical_g),
        min_g=of_each(np.minimum.reduceat, vertical_g),
        mean_abs_g=of_each(np.add.reduceat, np.abs(vertical_g)) / count,
        variance_g2=np.maximum(spread, 0.0),
        frequency_spm=frequency,
        duration_ms=1000.0 * duration_s,
        steps_each=steps_each,
        own_m=own_m,
    )


def stride_signals(foot: FootView, params: StrideBounds | None = None) -> StepSignals:
    """Signals of a foot's strides, from the quietest moment of each rest to that of the next: two steps a row. Where the
    foot stood for long, the stride begins with the end of the rest and ends with its beginning.

    The models were made for sensors at the waist or in the hand, which feel every step. A sensor on the foot feels one
    of two, and harder; the frequency is still that of the steps (120 over the time of the stride), and the factor k
    takes up the rest once it is found from a walk of known length.
    """
    motion, rests = foot.motion, foot.motion.rests
    stood = rests.end - rests.start > (params or StrideBounds()).long_rest_s * motion.rate_hz
    leaves = np.where(stood, np.maximum(rests.end - 1, rests.start), rests.moment)
    comes = np.where(stood, rests.start, rests.moment)
    path = np.diff(motion.position_m[rests.moment, :2], axis=0)
    return step_signals(
        motion.acceleration_mps2[:, 2],
        motion.time_s,
        motion.time_s[leaves[:-1]],
        motion.time_s[comes[1:]],
        steps_each=2,
        own_m=np.linalg.norm(path, axis=1),
    )
