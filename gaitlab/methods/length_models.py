"""The step-length models that Sun et al. (2015) set beside their own (§II), and the inertial path's.

All on one footing: each gives metres for every row of ``StepSignals``, in the paper's units (g, steps/min, ms), times
the steps in the row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.length_factors import Factors
from gaitlab.methods.length_parts import Why, lengths_of, unseen, untimed
from gaitlab.methods.model import Constant, Lengths, Method, Need, Question
from gaitlab.methods.steps_signals import Person, Sex, StepSignals
from gaitlab.recording.model import Bools, Floats

PAPER = "Sun, Wu and Schiller 2015, §II"


@dataclass(frozen=True)
class UsualStep:
    """What is taken where nobody measured the person's step."""

    usual_step_m: float = constant(0.70, "m", "middle of the 0.65 to 0.75 m of §III-A")


@dataclass(frozen=True)
class HeightParams:
    """Step length as a share of the body's height."""

    male_share: float = constant(0.415, "", "§II, 2")
    female_share: float = constant(0.413, "", "§II, 2")


@dataclass(frozen=True)
class CommonGait:
    """Steps per minute for which the models by frequency alone are meant."""

    low_spm: float = constant(90.0, "steps/min", "§III-A")
    high_spm: float = constant(120.0, "steps/min", "§III-A")

    def outside(self, steps: StepSignals) -> Bools:
        """Steps of another frequency."""
        return (steps.frequency_spm < self.low_spm) | (steps.frequency_spm > self.high_spm)


@dataclass(frozen=True)
class NonlinearParams:
    """Relative step length as a polynomial of the relative frequency."""

    square: float = constant(1.5, "", "eq. 6")
    slope: float = constant(-1.8475, "", "eq. 6")
    level: float = constant(1.3468, "", "eq. 6")


@dataclass(frozen=True)
class BylemansParams:
    """Exponent and scale."""

    root: float = constant(2.7, "", "eq. 8")
    scale: float = constant(0.1, "", "eq. 8")


def constant_length(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """The same length for every step: k times the usual step (§II, 1)."""
    return lengths_of(steps, np.full(len(steps), factors.k * UsualStep().usual_step_m), ())


def by_height(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """0.415 of a man's height, 0.413 of a woman's (§II, 2); no factor: nothing of it is individual but the height."""
    share = {Sex.MALE: HeightParams().male_share, Sex.FEMALE: HeightParams().female_share}
    everywhere = np.ones(len(steps), dtype=np.bool_)
    height = person.height_m if person.height_m is not None and person.height_m > 0.0 else np.nan
    why: list[Why] = []
    if np.isnan(height):
        why.append((everywhere, "the person's height is not known"))
    if person.sex is None:
        why.append((everywhere, "the person's sex is not known"))
    length = share[person.sex] * height if person.sex is not None else np.nan
    return lengths_of(steps, np.full(len(steps), length), why)


def weinberg(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """k·(a_max − a_min)^¼, eq. 1."""
    return lengths_of(steps, factors.k * _root(steps.range_g, 4.0), unseen(steps))


def kim(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """k·(mean |a|)^⅓, eq. 2."""
    return lengths_of(steps, factors.k * _root(steps.mean_abs_g, 3.0), unseen(steps))


def scarlett(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """k·(mean |a| − a_min)/(a_max − a_min), eq. 3."""
    bounce = _over(steps.mean_abs_g - steps.min_g, steps.range_g)
    return lengths_of(steps, factors.k * bounce, unseen(steps))


def xu(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """k·[(a_max − a_min) + (a_max − a_min)^¼], eq. 4."""
    return lengths_of(steps, factors.k * (steps.range_g + _root(steps.range_g, 4.0)), unseen(steps))


def frequency_linear(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """a·f + b, eq. 5."""
    step = factors.a * steps.frequency_spm + factors.b
    why = (*_uncalibrated(steps, factors.a, factors.b), *untimed(steps), _negative(step))
    return lengths_of(steps, step, why, CommonGait().outside(steps))


def frequency_nonlinear(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """d = d_n·(1.5 k_f² − 1.8475 k_f + 1.3468) with k_f = f/f_n, eq. 6; d_n is k times the usual step."""
    p = NonlinearParams()
    timed = np.isfinite(steps.frequency_spm)
    normal = factors.normal_spm
    if np.isnan(normal) and timed.any():
        normal = float(steps.frequency_spm[timed].mean())
    relative = steps.frequency_spm / normal
    step = factors.k * UsualStep().usual_step_m * (p.square * relative**2 + p.slope * relative + p.level)
    return lengths_of(steps, step, untimed(steps), CommonGait().outside(steps))


def shin(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """a·f + b·v + c, eq. 7."""
    step = factors.a * steps.frequency_spm + factors.b * steps.variance_g2 + factors.c
    calibrated = _uncalibrated(steps, factors.a, factors.b, factors.c)
    return lengths_of(steps, step, (*calibrated, *unseen(steps), *untimed(steps), _negative(step)))


def bylemans(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """0.1·(mean |a|)^(1/2.7)·√(k/(√Δt·(a_max − a_min))), Δt in ms, eq. 8."""
    p = BylemansParams()
    slowness = _over(factors.k, np.sqrt(np.maximum(steps.duration_ms, 0.0)) * steps.range_g)
    step = p.scale * _root(steps.mean_abs_g, p.root) * np.sqrt(np.maximum(slowness, 0.0))
    return lengths_of(steps, step, (*unseen(steps), *untimed(steps)))


def inertial(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """What the foot's own path says: no model of walking, nothing of the person, no factor."""
    own = steps.own_m
    if own is None:
        missing = np.ones(len(steps), dtype=np.bool_)
        return lengths_of(steps, np.full(len(steps), np.nan), ((missing, "there is no inertial path"),))
    return lengths_of(steps, own / steps.steps_each, ((~np.isfinite(own), "the path is not known"),))


def _root(values: Floats, degree: float) -> Floats:
    return np.asarray(np.maximum(values, 0.0) ** (1.0 / degree))


def _over(above: Floats | float, below: Floats) -> Floats:
    out = np.full(len(below), np.nan)
    return np.asarray(np.divide(above, below, out=out, where=below > 0.0))


def _uncalibrated(steps: StepSignals, *factors: float) -> tuple[Why, ...]:
    missing = not np.isfinite(factors).all()
    return ((np.full(len(steps), missing), "a walk of known length has to set the factors first"),)


def _negative(step: Floats) -> Why:
    return step <= 0.0, "the model gives no positive length"


FREE = "The vertical acceleration is free of gravity: with gravity in it mean |a| would not tell one step from another."
ON_A_FOOT = (
    "On a foot a row is a stride: signals of the stride, frequency 120 over its time, length twice the step's, since the"
    " foot's sensor feels one of two steps; k takes up the rest."
)
SQUARED = "Eq. 15 sets k to the square of the ratio of distances, since k stands under a square root."
USUAL = "Where no test walk set k, the usual step stands: the paper leaves the default open."


def _method(
    name: str,
    title: str,
    where: str,
    run: Callable[[StepSignals, Person, Factors], Lengths],
    needs: tuple[Need, ...],
    constants: tuple[Constant, ...] = (),
    deviations: tuple[str, ...] = (),
) -> Method:
    return Method(
        name, Question.LENGTH, title, f"{PAPER}, {where}", needs, constants, (*deviations, ON_A_FOOT), run
    )


_KNOWN, _FELT = (Need.KNOWN_LENGTH,), (Need.ACCELEROMETER, Need.KNOWN_LENGTH)
_USUAL, _COMMON = constants_of(UsualStep()), constants_of(CommonGait())
METHODS = (
    _method(
        "constant", "the same length every step", "1", constant_length, _KNOWN, _USUAL, deviations=(USUAL,)
    ),
    _method(
        "height",
        "a share of the body's height",
        "2",
        by_height,
        (Need.BODY_HEIGHT, Need.SEX),
        constants_of(HeightParams()),
    ),
    _method("weinberg", "Weinberg: range of acceleration", "eq. 1", weinberg, _FELT, deviations=(FREE,)),
    _method("kim", "Kim: mean size of acceleration", "eq. 2", kim, _FELT, deviations=(FREE,)),
    _method("scarlett", "Scarlett: mean over range", "eq. 3", scarlett, _FELT, deviations=(FREE,)),
    _method("xu", "Xu: range and its fourth root", "eq. 4", xu, _FELT, deviations=(FREE,)),
    _method("frequency_linear", "linear in frequency", "eq. 5", frequency_linear, _KNOWN, _COMMON),
    _method(
        "frequency_nonlinear",
        "quadratic in frequency",
        "eq. 6",
        frequency_nonlinear,
        _KNOWN,
        (*constants_of(NonlinearParams()), *_USUAL, *_COMMON),
        (USUAL,),
    ),
    _method("shin", "Shin: frequency and variance", "eq. 7", shin, _FELT, deviations=(FREE,)),
    _method(
        "bylemans",
        "Bylemans: size, range and duration",
        "eq. 8",
        bylemans,
        _FELT,
        constants_of(BylemansParams()),
        (FREE, SQUARED),
    ),
    Method(
        "gaitlab",
        Question.LENGTH,
        "path of the foot between its rests",
        "ours: gaitlab.motion.path",
        (Need.ACCELEROMETER, Need.GYROSCOPE),
        (),
        (),
        inertial,
    ),
)
