"""Heading of a foot: by compass, by gyroscope, or by both where the compass can be trusted (Feliz et al. 2009, §II.C)."""

from __future__ import annotations

import numpy as np

from gaitlab.methods.model import Constant, FootView, Method, Need, Question
from gaitlab.motion.magnetometer import MagnetometerParams, judge_field
from gaitlab.motion.model import FieldEvidence, FootMotion
from gaitlab.motion.quaternions import conjugate, matrices, multiply, twist_about_vertical
from gaitlab.motion.strapdown import apply
from gaitlab.recording.model import Floats

PAPER = "Feliz et al. 2009"


def first_moment(motion: FootMotion) -> int:
    """Row of the first rest's quietest moment; 0 where the foot never rests."""
    moment = motion.rests.moment
    return int(moment[0]) if len(moment) else 0


def vertical_rate_integral(motion: FootMotion) -> Floats:
    """Integral of the angular rate about the vertical, 0 at the first rest, radians, shape (n,).

    It is no heading: a foot that pitches by θ and rolls by φ adds the area ∮ sin θ dφ in every stride, several degrees.
    """
    turned = np.cumsum(motion.rate_radps[:, 2]) / motion.rate_hz
    return np.asarray(turned - turned[first_moment(motion)])


def foot_heading(motion: FootMotion) -> Floats:
    """Heading of each row by the orientation, 0 at the first rest, radians, positive to the left, shape (n,).

    The turns about the vertical from rest to rest, added up, and in between the turn since the rest before, by swing and
    twist: whatever way the sensor sits, and without the singularity of a yaw angle.
    """
    moment = motion.rests.moment
    knots = moment if len(moment) else np.zeros(1, dtype=np.intp)
    at_rest = np.concatenate([[0.0], np.cumsum(motion.turn_rad)])
    since = np.maximum(np.searchsorted(knots, np.arange(motion.n_samples), side="right") - 1, 0)
    start = conjugate(motion.attitude[knots])[since]
    turn = twist_about_vertical(multiply(motion.attitude, start))
    swept = vertical_rate_integral(motion)
    return at_rest[since] + _nearest_turn(turn, swept - swept[knots[since]])


def _nearest_turn(angle: Floats, guide: Floats) -> Floats:
    """The angle with as many whole turns as bring it nearest to the guide."""
    return np.asarray(angle + 2.0 * np.pi * np.round((guide - angle) / (2.0 * np.pi)))


def _compass_share(motion: FootMotion, evidence: FieldEvidence | None) -> Floats:
    """What the compass adds to the gyroscope's heading where it is trusted, 0 at the first rest, radians, shape (n,)."""
    since = motion.time_s - motion.time_s[first_moment(motion)]
    if evidence is None or not evidence.used:
        return np.zeros(len(since))
    known = motion.offsets.drift_sd_radps**2
    share = known / (known + evidence.drift_sd_radps**2)
    return np.asarray(-share * evidence.drift_radps * since)


def by_compass(foot: FootView) -> Floats:
    """Heading of each row by the magnetic field alone, 0 at the first rest, shape (n,).

    Tilt compensation: the field, shape (n, 3), is turned into the world by the orientation; the direction in which north
    then seems to lie is the heading's error, and what is left is the heading against north, whatever the orientation's own
    heading. Whole turns, which no compass shows, are the gyroscope's.
    """
    assert foot.mag is not None
    motion, first = foot.motion, first_moment(foot.motion)
    north = apply(matrices(motion.attitude), foot.mag)
    seen = np.arctan2(north[:, 1], north[:, 0])
    turned = foot_heading(motion) - (seen - seen[first])
    heading = _nearest_turn(turned, foot_heading(motion))
    return np.asarray(heading - heading[first])


def by_gyroscope(foot: FootView, *, letter: bool = False) -> Floats:
    """Heading of each row by integration of the angular rates, 0 at the first rest, radians, shape (n,).

    All three rates are integrated into an orientation, made level at the rests, whose heading this is: what the
    magnetometer may have added to ours is taken out again. ``letter``: the rate about the vertical alone is integrated; in
    ``mtw-10m-walk`` that differs by 100° (SD) at the end of 20 m.
    """
    if letter:
        return vertical_rate_integral(foot.motion)
    return foot_heading(foot.motion) - _compass_share(foot.motion, foot.motion.field)


def combined(foot: FootView, params: MagnetometerParams | None = None) -> Floats:
    """Heading of each row by the gyroscope, its drift corrected by the compass where that can be trusted, shape (n,).

    The paper's future work 1 and 2. Judged as in ``gaitlab.motion.magnetometer``: in the rests the field's direction must
    scatter little about a steady drift, and its strength little about its mean. The two drifts are then weighed by their
    variances. Where the field is not trusted this is the gyroscope's heading.
    """
    assert foot.mag is not None
    evidence = foot.motion.field or judge_field(foot.motion, foot.mag, params)
    return by_gyroscope(foot) + _compass_share(foot.motion, evidence)


_OFFSET = "The gyroscope's static offset, found while standing, is removed first."
_ORIENTATION = "The tilt is that of gaitlab's orientation, where the paper takes the device's."
_TRUST = MagnetometerParams()
METHODS = (
    Method(
        "feliz2009_compass",
        Question.HEADING,
        "Compass with the tilt taken out",
        f"{PAPER}, §II.C",
        (Need.MAGNETOMETER, Need.GYROSCOPE),
        (),
        (_ORIENTATION, "Whole turns, which a compass does not show, are the gyroscope's."),
        by_compass,
    ),
    Method(
        "feliz2009_gyroscope",
        Question.HEADING,
        "Angular rates, integrated",
        f"{PAPER}, §II.C",
        (Need.GYROSCOPE,),
        (),
        (
            _OFFSET,
            (
                "The three rates are integrated into an orientation, level at every rest; the rate about the vertical alone,"
                " which is no heading while the foot pitches and rolls, is letter=True."
            ),
        ),
        by_gyroscope,
    ),
    Method(
        "feliz2009_combined",
        Question.HEADING,
        "Gyroscope, its drift corrected by the compass where that can be trusted",
        f"{PAPER}, §IV, future work 1 and 2",
        (Need.GYROSCOPE, Need.MAGNETOMETER),
        (
            Constant("scatter_rad", _TRUST.scatter_rad, "rad", "ours: the paper leaves this open"),
            Constant("strength_spread", _TRUST.strength_spread, "", "ours: the paper leaves this open"),
            Constant("least_rests", _TRUST.least_rests, "", "ours: fewer show no drift"),
        ),
        (
            _ORIENTATION,
            _OFFSET,
            (
                "The paper proposes a Kalman filter; here the steady drifts that the two show are weighed by their variances,"
                " which is its result for a constant offset of the gyroscope."
            ),
        ),
        combined,
    ),
)
