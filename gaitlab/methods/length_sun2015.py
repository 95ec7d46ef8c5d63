"""Step length from frequency and variance: Sun, Wu and Schiller (2015), §III, eq. 9 and 12 to 15."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.length_factors import Factors
from gaitlab.methods.length_models import FREE, ON_A_FOOT
from gaitlab.methods.length_parts import lengths_of, unseen, untimed
from gaitlab.methods.model import Lengths, Method, Need, Question
from gaitlab.methods.steps_signals import Person, StepSignals
from gaitlab.recording.model import Floats

NO_ROOT = "the model gives no length for so small a variance"
AS_PRINTED = (
    "The coefficients are those printed in eq. 12 and 13; those that eq. 11 gives from the relations of table I are"
    " others (a would be negative below 113 steps/min) and have no step length for most variances."
)
Polynomial = tuple[float, float, float]


@dataclass(frozen=True)
class SunParams:
    """Range of the experiments, and the frequency at which the two branches meet, or should."""

    branch_spm: float = constant(140.0, "steps/min", "eq. 12, 13")
    low_spm: float = constant(60.0, "steps/min", "§III-A")
    high_spm: float = constant(180.0, "steps/min", "§III-A")
    shortest_m: float = constant(0.4, "m", "§III-A")
    longest_m: float = constant(0.9, "m", "§III-A")


@dataclass(frozen=True)
class Branch:
    """Polynomials in the frequency, highest power first, of the coefficients of v = a·s² + b·s + c (eq. 9)."""

    a: Polynomial
    b: Polynomial
    c: Polynomial

    def at(self, frequency_spm: Floats) -> tuple[Floats, Floats, Floats]:
        """The three coefficients at each frequency."""
        a, b, c = (np.asarray(np.polyval(one, frequency_spm)) for one in (self.a, self.b, self.c))
        return a, b, c


SLOW = Branch(
    a=(0.0000545, -0.00501, 0.15495), b=(-0.0000461, 0.00404, -0.130), c=(0.0000102, -0.000913, 0.0336)
)
"""Eq. 12, below 140 steps/min; g² and metres."""
FAST = Branch(a=(0.000178, -0.0613, 5.381), b=(-0.000177, 0.0607, -5.272), c=(0.0000423, -0.0145, 1.248))
"""Eq. 13, from 140 steps/min."""


def sun2015(steps: StepSignals, person: Person, factors: Factors) -> Lengths:
    """Step length from its frequency and the variance of its vertical acceleration, eq. 14.

    s = k·(−b + √(b² − 4a(c − v)))/(2a), the larger root of eq. 9; a is positive at every frequency in both branches.
    Below 140 steps/min there is none for very small variances (the parabola's lowest point lies above them). The
    branches do not meet at 140 steps/min: v = 0.01 g² gives 0.58 m just below and 0.65 m there. ``outside`` marks what
    the model was not fitted on: other frequencies than 60 to 180 steps/min, or a root, before k, that is no step of
    0.4 to 0.9 m.
    """
    p = SunParams()
    fast = steps.frequency_spm >= p.branch_spm
    pairs = zip(SLOW.at(steps.frequency_spm), FAST.at(steps.frequency_spm), strict=True)
    a, b, c = (np.where(fast, high, low) for low, high in pairs)
    under_root = b**2 - 4.0 * a * (c - steps.variance_g2)
    root = (-b + np.sqrt(np.maximum(under_root, 0.0))) / (2.0 * a)
    why = (*unseen(steps), *untimed(steps), ((under_root < 0.0) | (root <= 0.0), NO_ROOT))
    strange = (steps.frequency_spm < p.low_spm) | (steps.frequency_spm > p.high_spm)
    return lengths_of(steps, factors.k * root, why, strange | (root < p.shortest_m) | (root > p.longest_m))


METHOD = Method(
    "sun2015",
    Question.LENGTH,
    "Sun: frequency and variance, two branches",
    "Sun, Wu and Schiller 2015, §III, eq. 9, 12 to 15",
    (Need.ACCELEROMETER, Need.KNOWN_LENGTH),
    constants_of(SunParams()),
    (
        FREE,
        AS_PRINTED,
        ON_A_FOOT,
    ),
    sun2015,
)
