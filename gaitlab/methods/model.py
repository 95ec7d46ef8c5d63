"""What a method of the catalogue is, what it is given, and what it gives back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Bools, Floats, Side


class Question(StrEnum):
    """What a method answers; those of one question are called alike and compared with each other."""

    REST = "rest detection"
    STEP = "step detection"
    LENGTH = "step length"
    HEADING = "heading"
    HEIGHT = "height"
    POSITION = "position"
    KNEE = "knee"
    POSTURE = "leg posture"
    THIGH = "thigh navigation"
    CALIBRATION = "calibration"


class Need(StrEnum):
    """What a method must be given; where it is missing the method says so and the others still run."""

    ACCELEROMETER = "accelerometer"
    GYROSCOPE = "gyroscope"
    MAGNETOMETER = "magnetometer"
    PRESSURE = "barometer"
    KNEE = "sensor on shank or thigh"
    THIGH = "sensor on the thigh"
    BOTH_FEET = "both feet"
    KNOWN_LENGTH = "a walk of known length"
    BODY_HEIGHT = "the person's height"
    SEX = "the person's sex"
    REFERENCE = "a reference displacement"


@dataclass(frozen=True)
class Constant:
    """A number of a method: its unit, and where it comes from (paper and place in it, or ours with the reason)."""

    name: str
    value: float
    unit: str
    source: str


@dataclass(frozen=True)
class Method:
    """A method by name.

    Attributes
    ----------
    name : str
        Stable, for programs: ``jimenez2009_gyroscope``.
    question : Question
    title : str
        For people.
    reference : str
        Paper, section, equations.
    needs : tuple of Need
    constants : tuple of Constant
    deviations : tuple of str
        Each deviation from the paper, one sentence with its reason; empty where there is none.
    run : callable
        With the signature of its question, see ``signatures``.
    """

    name: str
    question: Question
    title: str
    reference: str
    needs: tuple[Need, ...]
    constants: tuple[Constant, ...]
    deviations: tuple[str, ...]
    run: Callable[..., Any]


@dataclass(frozen=True, eq=False)
class FootView:
    """A foot as methods see it, n rows on the regular packet clock.

    Attributes
    ----------
    acc_mps2, gyr_radps : ndarray (n, 3)
        Specific force and angular rate, static offsets removed, sensor frame.
    mag : ndarray (n, 3) or None
        Magnetic field, sensor frame, any unit.
    pressure_pa : ndarray (n,) or None
    motion : FootMotion
        Ours: orientation, free acceleration (world, z up), rests, path.
    """

    side: Side
    rate_hz: float
    time_s: Floats
    acc_mps2: Floats
    gyr_radps: Floats
    mag: Floats | None
    pressure_pa: Floats | None
    motion: FootMotion


@dataclass(frozen=True, eq=False)
class Track:
    """Places of a foot at k instants, shape (k, 3), from (0, 0, 0), world of the foot's own motion."""

    time_s: Floats
    place_m: Floats


@dataclass(frozen=True, eq=False)
class Lengths:
    """Lengths of m steps in metres; NaN where not determinable, and then why (one text a step, empty where it is)."""

    length_m: Floats
    reason: tuple[str, ...]
    outside: Bools
    """What lies outside the range that the model was fitted on."""

    @property
    def known(self) -> Bools:
        """Where a length was determined."""
        return np.isfinite(self.length_m)
