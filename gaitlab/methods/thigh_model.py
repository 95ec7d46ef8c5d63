"""A thigh as methods see it, what they give back, and what they share: how the sensor sits, its strides, their length.

Thigh axes: x forward, y to the left, z up along the bone. Pitch is positive where the thigh lies back, as in
``leg_model``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.signal import find_peaks

from gaitlab.methods.constants import constant
from gaitlab.methods.leg_model import ADULT, LegAngles, Links, forward_of, hip_angles
from gaitlab.motion.free import calibrate
from gaitlab.motion.knee import track_knee
from gaitlab.motion.model import FootMotion, Indices, KneeMotion
from gaitlab.motion.quaternions import multiply, turn_to_left
from gaitlab.recording.model import Floats, Sensor, Side

_OURS = "ours: the step detector of reference [12] is not at hand"


@dataclass(frozen=True)
class SwingFactors:
    """Length of a stride from the thigh's swing: ``per_rad_m`` · swing + ``base_m``.

    Where no stride of known length was given: a leg of 0.9 m (0.53 of a height of 1.7 m, Drillis and Contini 1966) that
    stays stretched from contact to foot off covers once its length times the swing, and so does the other leg.
    """

    per_rad_m: float = constant(1.8, "m/rad", "ours: twice a leg of 0.9 m; replaced where strides are known")
    base_m: float = constant(0.0, "m", "ours: a thigh that does not swing leads nowhere")


@dataclass(frozen=True, eq=False)
class ThighView:
    """A thigh's sensor and its foot; n rows of the thigh on the regular packet clock.

    Attributes
    ----------
    acc_mps2, gyr_radps : ndarray (n, 3)
        Specific force and angular rate, static offsets removed, sensor frame.
    standing : tuple of 2 ints
        Rows ``[start, end)`` in which the person stood.
    foot : FootMotion
        Of the same side: its rests are the stances.
    shift : int
        Thigh row = foot row + shift.
    motion : KneeMotion
        Ours: orientation, and the path of the sensor tied to the foot, in the foot's world.
    factors : SwingFactors
    links : Links
    """

    side: Side
    rate_hz: float
    time_s: Floats
    acc_mps2: Floats
    gyr_radps: Floats
    standing: tuple[int, int]
    foot: FootMotion
    shift: int
    motion: KneeMotion
    factors: SwingFactors = field(default_factory=SwingFactors)
    links: Links = ADULT

    @property
    def stances(self) -> tuple[Indices, Indices]:
        """Start and end, ``[start, end)``, of the foot's rests in the thigh's rows, those that lie within it."""
        start, end = self.foot.rests.start + self.shift, self.foot.rests.end + self.shift
        start, end = np.maximum(start, 0), np.minimum(end, len(self.time_s))
        inside = end > start
        return start[inside], end[inside]


@dataclass(frozen=True, eq=False)
class ThighTrack:
    """How a thigh moved, and where its strides led. World: z up, x the thigh's heading at the first stance.

    Attributes
    ----------
    attitude : ndarray (n, 4)
        Thigh to world; no rows where it is not determinable.
    heading_rad, roll_rad, pitch_rad : ndarray (n,)
        Heading, θ1 and θ2 of ``leg_model``.
    stride_row : ndarray (m,)
        Row at which the thigh is farthest forward, once a stride.
    swing_rad : ndarray (m,)
        From the farthest back before to there.
    length_m : ndarray (m,)
    place_m : ndarray (m + 1, 3)
        Place before the first stride, which is (0, 0, 0), and after each.
    correction_rad : ndarray (k, 2)
        What was given to the filter after each stance, roll and pitch; 0 where nothing was.
    reason : str
        Why there is no track; empty where there is one.
    """

    attitude: Floats
    heading_rad: Floats
    roll_rad: Floats
    pitch_rad: Floats
    stride_row: Indices
    swing_rad: Floats
    length_m: Floats
    place_m: Floats
    correction_rad: Floats
    reason: str = ""

    def places_at(self, rows: Indices) -> Floats:
        """Where the strides so far have led at each of ``rows``, shape (len(rows), 3): for rows in which the foot rests."""
        places: Floats = self.place_m[np.searchsorted(self.stride_row, rows)]
        return places


@dataclass(frozen=True)
class StrideParams:
    """How strides are found in the pitch.

    Attributes
    ----------
    share : float
        A swing counts from this share of the recording's own large swings on. Set between a turn's short steps and the
        knee's small second wave; not tuned.
    least_rad : float
        Below it nobody walks: the pitch of a standing person sways by about 1°.
    apart_s : float
        Two strides of one leg are at least so far apart: 150 strides a minute are run, not walked.
    """

    share: float = constant(0.3, "1", _OURS)
    least_rad: float = constant(0.1, "rad", _OURS)
    apart_s: float = constant(0.4, "s", _OURS)


def thigh_view(
    sensor: Sensor,
    time_s: Floats,
    foot: FootMotion,
    shift: int,
    motion: KneeMotion | None = None,
    factors: SwingFactors | None = None,
    links: Links = ADULT,
) -> ThighView:
    """What the methods are given of a sensor on the thigh; ``motion`` is worked out where it is not at hand.

    Where nobody stood, ``standing`` is empty.
    """
    calibrated = calibrate(sensor)
    motion = motion or track_knee(sensor, time_s, foot, shift)
    offsets = calibrated.offsets
    standing = (offsets.start, offsets.end if offsets.standing else offsets.start)
    return ThighView(
        foot.placement.side,
        sensor.rate_hz,
        time_s,
        calibrated.acc_mps2,
        calibrated.gyr_radps,
        standing,
        foot,
        shift,
        motion,
        factors or SwingFactors(),
        links,
    )


def mounting(view: ThighView) -> Floats | None:
    """Thigh to sensor, shape (4,); None where nobody stood or walked.

    z is gravity while standing; y, across it, is the axis about which the thigh turns most during the walk; and while
    the foot rests the hip passes over it, so that the pitch then grows, which says where left is. The paper aligns the
    sensor with the leg by hand.
    """
    start, end = view.stances
    up = view.acc_mps2[slice(*view.standing)].sum(axis=0)
    size = float(np.linalg.norm(up))
    if len(start) < 2 or size == 0.0:
        return None
    up = up / size
    walk = slice(int(end[0]), int(start[-1]))
    across = view.gyr_radps[walk] - np.outer(view.gyr_radps[walk] @ up, up)
    spread, axes = np.linalg.eigh(across.T @ across)
    left = axes[:, 2] - up * float(up @ axes[:, 2])
    if spread[2] <= 0.0 or not np.any(left):
        return None
    left /= np.linalg.norm(left)
    turned = np.concatenate([[0.0], np.cumsum(view.gyr_radps @ left)])
    inner = slice(1, -1) if len(start) > 2 else slice(None)
    passed = float(np.sum(turned[end[inner]] - turned[start[inner]]))
    left = -left if passed < 0.0 else left
    return _quaternion(np.stack([np.cross(left, up), left, up], axis=1))


def _quaternion(matrix: Floats) -> Floats:
    """Of a rotation matrix (3, 3): the row of 4·q·qᵀ with the greatest diagonal entry."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    rows = np.array(
        [
            [1 + a + e + i, h - f, c - g, d - b],
            [h - f, 1 + a - e - i, b + d, c + g],
            [c - g, b + d, 1 - a + e - i, f + h],
            [d - b, c + g, f + h, 1 - a - e + i],
        ]
    )
    row = rows[np.argmax(np.diag(rows))]
    unit: Floats = row / np.linalg.norm(row)
    return unit


@dataclass(frozen=True, eq=False)
class Swings:
    """m swings of a thigh.

    Attributes
    ----------
    back, forward : ndarray (m,)
        Rows at which the thigh is farthest back, and after it farthest forward.
    swing_rad : ndarray (m,)
        From the one to the other.
    """

    back: Indices
    forward: Indices
    swing_rad: Floats


def swings_of(pitch_rad: Floats, rate_hz: float, params: StrideParams | None = None) -> Swings:
    """The thigh's swings, one a stride, by the peaks of its pitch (n,) alone."""
    p = params or StrideParams()
    none = np.zeros(0, dtype=np.intp)
    if len(pitch_rad) < 3:
        return Swings(none, none, np.zeros(0))
    apart = max(1, round(p.apart_s * rate_hz))
    peaks, found = find_peaks(-pitch_rad, prominence=p.least_rad, distance=apart)
    if not len(peaks):
        return Swings(none, none, np.zeros(0))
    large = found["prominences"] >= p.share * np.quantile(found["prominences"], 0.75)
    forward = peaks[large].astype(np.intp)
    return swings_between(pitch_rad, np.concatenate([[0], forward[:-1]]).astype(np.intp), forward)


def swings_between(pitch_rad: Floats, first: Indices, forward: Indices) -> Swings:
    """Swings that end at the rows ``forward`` and begin where the thigh is farthest back since the rows ``first``."""
    back = np.array(
        [a + np.argmax(pitch_rad[a:b]) for a, b in zip(first, forward, strict=True)], dtype=np.intp
    )
    return Swings(back, forward, pitch_rad[back] - pitch_rad[forward])


def lengths_of(swing_rad: Floats, factors: SwingFactors) -> Floats:
    """Length of each stride, shape (m,)."""
    length: Floats = factors.per_rad_m * swing_rad + factors.base_m
    return length


def fit_factors(swing_rad: Floats, length_m: Floats) -> SwingFactors:
    """Least squares over strides of known length, through 0: a thigh that does not swing leads nowhere.

    A base as well, as a regression usually has, is badly known from few strides of one pace: left out one at a time,
    the strides of ``mtw-leg-vicon`` are met within 17 and 8 cm with it and within 14 and 7 cm without.
    """
    known = np.isfinite(swing_rad) & np.isfinite(length_m)
    swing, length = swing_rad[known], length_m[known]
    if not np.any(swing):
        return SwingFactors()
    return SwingFactors(float(swing @ length) / float(swing @ swing), 0.0)


def calibrated(view: ThighView, track: ThighTrack, train: int) -> ThighView:
    """The same thigh with factors fitted to its first ``train`` strides, whose lengths are those of its foot."""
    swing, length = track.swing_rad[:train], foot_lengths(view, track.stride_row)[:train]
    return replace(view, factors=fit_factors(swing, length))


def foot_lengths(view: ThighView, stride_row: Indices) -> Floats:
    """Horizontal way of the foot (m,) from its rest before each row to its rest after; NaN where there are not both."""
    moment = view.foot.rests.moment + view.shift
    place = view.foot.rest_position_m[:, :2]
    after = np.searchsorted(moment, stride_row)
    known = (after > 0) & (after < len(moment))
    length = np.full(len(stride_row), np.nan)
    length[known] = np.linalg.norm(place[after[known]] - place[after[known] - 1], axis=1)
    return length


def leg_angles(view: ThighView, attitude: Floats) -> LegAngles:
    """The leg by its thigh alone (§II-B): knee and ankle are 0 while the foot stands; ``attitude`` thigh to world."""
    heading, roll, pitch = hip_angles(attitude)
    start, end = view.stances
    angles = np.zeros((len(roll), 5))
    angles[:, 0], angles[:, 1] = roll, pitch
    return LegAngles(angles, heading, start, end, view.links)


def no_track(view: ThighView, reason: str) -> ThighTrack:
    """A track of nothing."""
    none, rows = np.zeros(0), np.zeros(0, dtype=np.intp)
    corrections = np.zeros((len(view.stances[0]), 2))
    start = np.zeros((1, 3))
    return ThighTrack(np.zeros((0, 4)), none, none, none, rows, none, none, start, corrections, reason)


def track_of(
    view: ThighView,
    attitude: Floats,
    correction_rad: Floats,
    swings: Swings | None = None,
    way_m: Floats | None = None,
) -> ThighTrack:
    """Strides and places of a thigh's orientation (n, 4), any heading.

    The swings are found in the pitch where they are not given. A stride leads ``way_m`` (m, 3), in the world of the
    orientation; where that is not given, its length follows from the swing and its direction is the thigh's mean
    heading during the swing, for only then does the foot move (step and heading).
    """
    heading, roll, pitch = hip_angles(attitude)
    first = slice(int(view.stances[0][0]), int(view.stances[1][0]))
    start = float(np.arctan2(np.sin(heading[first]).mean(), np.cos(heading[first]).mean()))
    swings = swings or swings_of(pitch, view.rate_hz)
    if way_m is None:
        way_m = lengths_of(swings.swing_rad, view.factors)[:, None] * _ahead(heading, swings)
    way_m = turn_to_left(way_m, -start)
    return ThighTrack(
        attitude=multiply(np.array([np.cos(start / 2), 0.0, 0.0, -np.sin(start / 2)]), attitude),
        heading_rad=np.pi - np.mod(np.pi - heading + start, 2.0 * np.pi),
        roll_rad=roll,
        pitch_rad=pitch,
        stride_row=swings.forward,
        swing_rad=swings.swing_rad,
        length_m=np.hypot(way_m[:, 0], way_m[:, 1]),
        place_m=np.concatenate([np.zeros((1, 3)), np.cumsum(way_m, axis=0)]),
        correction_rad=correction_rad,
    )


def _ahead(heading_rad: Floats, swings: Swings) -> Floats:
    """Unit vectors (m, 3) of the mean heading in each swing."""
    total = np.concatenate([np.zeros((1, 3)), np.cumsum(forward_of(heading_rad), axis=0)])
    mean = total[swings.forward + 1] - total[swings.back]
    unit: Floats = mean / np.maximum(np.linalg.norm(mean, axis=1), 1e-12)[:, None]
    return unit
