"""Whether a thigh's orientation makes sense: the comfort zone of the metatarsal in stance.

Bousdar Ahmed and Metzger 2017, §II-B and §II-C, fig. 3, 5 and 7, eq. 3–4.

Measured on the optical left thigh of ``mtw-leg-vicon``: of six stances the five of straight walking are coherent (roll
−3.2° to 0.4°, pitch −18.6° to 14.6°), that of the turn is not (roll up to 7.2°), and neither is standing with the feet
apart (10°). The zone is for walking straight on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.leg_model import LegAngles, joints_in_base
from gaitlab.methods.model import Method, Need, Question
from gaitlab.motion.model import Indices
from gaitlab.recording.model import Bools, Floats

_SOURCE = "Bousdar Ahmed and Metzger 2017, fig. 3"


@dataclass(frozen=True)
class ComfortZone:
    """Limits of the hip's roll and pitch while the foot stands; pitch is negative where the thigh is forward.

    Source: fig. 3 of the paper, adapted there from its reference [13].
    """

    roll_min_rad: float = constant(math.radians(-3.5), "rad", _SOURCE)
    roll_max_rad: float = constant(math.radians(3.5), "rad", _SOURCE)
    pitch_min_rad: float = constant(math.radians(-28.0), "rad", _SOURCE)
    pitch_max_rad: float = constant(math.radians(18.0), "rad", _SOURCE)

    @property
    def low_rad(self) -> Floats:
        """Least roll and pitch, shape (2,)."""
        return np.array([self.roll_min_rad, self.pitch_min_rad])

    @property
    def high_rad(self) -> Floats:
        """Greatest roll and pitch, shape (2,)."""
        return np.array([self.roll_max_rad, self.pitch_max_rad])


ZONE = ComfortZone()


@dataclass(frozen=True, eq=False)
class Posture:
    """The thigh in each of k stances against the comfort zone.

    Attributes
    ----------
    coherent : ndarray of bool (k,)
        Roll and pitch stay within the zone.
    low_rad, high_rad : ndarray (k, 2)
        Least and greatest roll and pitch of the hip in the stance.
    correction_rad : ndarray (k, 2)
        δ of roll and of pitch, eq. 3 and 4: what must be added to come back to the limit; 0 within.
    outside_m : ndarray (k,)
        How far the metatarsal lies from where it would lie with roll and pitch held at the limits, at its farthest;
        0 within.
    reason : tuple of str
        Why a stance cannot be judged (NaN, and not coherent); empty where it can.
    """

    coherent: Bools
    low_rad: Floats
    high_rad: Floats
    correction_rad: Floats
    outside_m: Floats
    reason: tuple[str, ...]


def extremes(values: Floats, start: Indices, end: Indices) -> tuple[Floats, Floats]:
    """Least and greatest of each column (n, c) in intervals ``[start, end)``, each (k, c); NaN where one is empty."""
    k, n = len(start), len(values)
    low = np.full((k, *values.shape[1:]), np.nan)
    high = low.copy()
    filled = (start >= 0) & (end <= n) & (end > start)
    if np.any(filled):
        edges = np.stack([start[filled], end[filled]], axis=1).ravel()
        padded = np.concatenate([values, values[-1:]])  # an interval may end with the last row
        low[filled] = np.minimum.reduceat(padded, edges)[::2]
        high[filled] = np.maximum.reduceat(padded, edges)[::2]
    return low, high


def corrections(low_rad: Floats, high_rad: Floats, zone: ComfortZone = ZONE) -> Floats:
    """δ of roll and pitch (eq. 3 and 4), shape (k, 2), of their least and greatest in each stance, shapes (k, 2).

    Where a stance leaves the zone on both sides the upper limit goes first, as the equations are written.
    """
    above, below = zone.high_rad - high_rad, zone.low_rad - low_rad
    return np.where(above < 0.0, above, np.where(below > 0.0, below, 0.0))


def judge(leg: LegAngles, zone: ComfortZone = ZONE) -> Posture:
    """The hip's angles in each stance against the zone; the metatarsal by the leg model with knee and ankle at 0."""
    hip = leg.angle_rad[:, :2]
    low, high = extremes(hip, leg.start, leg.end)
    known = np.all(np.isfinite(low) & np.isfinite(high), axis=1)
    correction = np.where(known[:, None], corrections(low, high, zone), np.nan)
    beyond = np.zeros((len(hip), 1))
    rows = np.any((hip < zone.low_rad) | (hip > zone.high_rad), axis=1)
    beyond[rows, 0] = _moved(hip[rows], np.clip(hip[rows], zone.low_rad, zone.high_rad), leg)
    outside = extremes(beyond, leg.start, leg.end)[1][:, 0]
    outside[~known] = np.nan
    coherent = known & np.all(correction == 0.0, axis=1)
    reason = tuple("" if one else "The stance has no orientation of the thigh." for one in known)
    return Posture(coherent, low, high, correction, outside, reason)


def _moved(hip: Floats, held: Floats, leg: LegAngles) -> Floats:
    """Distance (m,) between the metatarsals of two series of hip angles (m, 2)."""
    still = np.zeros((len(hip), 3))
    places = [joints_in_base(np.hstack([angles, still]), leg.links)[:, 3] for angles in (hip, held)]
    distance: Floats = np.linalg.norm(places[0] - places[1], axis=1)
    return distance


METHOD = Method(
    name="bousdar2017_comfort_zone",
    question=Question.POSTURE,
    title="Comfort zone of the metatarsal in stance",
    reference="Bousdar Ahmed and Metzger 2017, §II-A to §II-C, table I, eq. 1–4, fig. 3, 5, 7",
    needs=(Need.THIGH, Need.ACCELEROMETER, Need.GYROSCOPE),
    constants=constants_of(ComfortZone),
    deviations=(
        (
            "Row 4 of table I is taken without its 180°: with it the leg is folded at zero and the foot points backward,"
            " against the text and figures 1 to 3 (the printed table is kept as DH_AS_PRINTED)."
        ),
        (
            "Roll and pitch are taken in the order of the model's own axes; the paper takes Euler angles for them, which"
            " are the same to second order."
        ),
        (
            "Beside the angles by which the zone is left, the distance of the metatarsal is given: the paper shows it only"
            " in figures."
        ),
    ),
    run=judge,
)
