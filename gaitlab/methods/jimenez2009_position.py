"""The three positions of Jiménez et al. 2009: INS with ZUPT, and a stride length along the heading of the stance.

Jiménez, Seco, Prieto, Guevara, "A comparison of Pedestrian Dead-Reckoning algorithms using a low-cost MEMS IMU", WISP
2009, §IV and §V. Closing errors there: mostly below 5 % of 100 to 320 m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.heading import foot_heading
from gaitlab.methods.jimenez2009_steps import PAPER, AccelerationParams, Stances, stances
from gaitlab.methods.model import FootView, Method, Need, Question, Track
from gaitlab.methods.still import filtered, size
from gaitlab.motion.quaternions import rotate
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class WeinbergParams:
    """Constants of eq. 4.

    Attributes
    ----------
    k : float
        Metres for each fourth root of m/s².
    calibration : float
        Factor on k, which "has to be selected experimentally or calibrated". With the paper's k alone, for another device
        on the instep, the strides of ``mtw-10m-walk`` come out at 53 % of those by ZUPT. Found on seven of its eight people
        the factor errs by −18 % to +7 % on the eighth.
    cut_hz, order : float
        Low pass for the size of the acceleration, forward and backward.
    """

    k: float = constant(0.364, "m/(m/s²)^¼", f"{PAPER}, fig. 5")
    calibration: float = constant(1.9, "", "ours: mtw-10m-walk, sensors on the back of the foot")
    cut_hz: float = constant(3.0, "Hz", f"{PAPER}, §IV.A step 2")
    order: int = constant(4, "", f"{PAPER}, §IV.A step 2")
    power: float = constant(0.25, "", f"{PAPER}, eq. 4")


def drift_free_velocity(foot: FootView, at: Stances) -> Floats:
    """Velocity with the mean around each stance removed, linearly between stances, shape (n, 3); steps 1–3."""
    raw = foot.motion.raw_velocity_mps
    running = np.concatenate([np.zeros((1, 3)), np.cumsum(raw, axis=0)])
    low = np.maximum(at.row - at.half_window, 0)
    high = np.minimum(at.row + at.half_window + 1, len(raw))
    mean = (running[high] - running[low]) / (high - low)[:, None]
    rows = np.arange(len(raw))
    return np.asarray(raw - np.stack([np.interp(rows, at.row, mean[:, k]) for k in range(3)], axis=1))


def increments(foot: FootView, at: Stances, *, letter: bool = False) -> Floats:
    """ΔP of each stride, metres, world, shape (k − 1, 3); eq. 5.

    ``letter``: the sum of eq. 5 includes both its ends, so that the sample of each stance counts in two strides.
    """
    if len(at.row) < 2:
        return np.zeros((0, 3))
    velocity = drift_free_velocity(foot, at)
    running = np.cumsum(velocity, axis=0)
    moved = running[at.row[1:]] - running[at.row[:-1]]
    return np.asarray((moved + velocity[at.row[:-1]] if letter else moved) / foot.rate_hz)


def zupt_lengths(foot: FootView, at: Stances) -> Floats:
    """Horizontal length of each stride, metres, shape (k − 1,); eq. 6."""
    return np.asarray(np.hypot(*increments(foot, at)[:, :2].T))


def weinberg_lengths(foot: FootView, at: Stances, params: WeinbergParams | None = None) -> Floats:
    """Length of the stride that ends at each stance but the first, metres, shape (k − 1,); eq. 4."""
    p = params or WeinbergParams()
    smooth = filtered(size(foot.acc_mps2), "low", p.cut_hz, p.order, foot.rate_hz)
    around = np.arange(-at.half_window, at.half_window + 1)
    window = smooth[np.clip(at.row[1:, None] + around, 0, len(smooth) - 1)]
    return np.asarray(p.k * p.calibration * (window.max(axis=1) - window.min(axis=1)) ** p.power)


def axis_headings(foot: FootView, at: Stances) -> Floats:
    """Heading of the sensor's x axis in each stance, radians, positive to the left, shape (k,); eq. 7 with atan2."""
    axis = rotate(foot.motion.attitude[at.row], np.broadcast_to([1.0, 0.0, 0.0], (len(at.row), 3)))
    return np.asarray(np.arctan2(axis[:, 1], axis[:, 0]))


def along_headings(length_m: Floats, heading_rad: Floats) -> Floats:
    """Places from (0, 0, 0) by strides along headings, shapes (k − 1,), result (k, 3); eq. 8."""
    step = np.stack(
        [length_m * np.cos(heading_rad), length_m * np.sin(heading_rad), np.zeros(len(length_m))], axis=1
    )
    return np.concatenate([np.zeros((1, 3)), np.cumsum(step, axis=0)])


def zupt(foot: FootView, params: AccelerationParams | None = None, *, letter: bool = False) -> Track:
    """INS-ZUPT: the increments of eq. 5, added up (eq. 9)."""
    at = stances(foot, params)
    moved = increments(foot, at, letter=letter)
    place = np.concatenate([np.zeros((1, 3)), np.cumsum(moved, axis=0)])
    return Track(foot.time_s[at.row], place[: len(at.row)])


def sl_zupt(foot: FootView, params: AccelerationParams | None = None, *, letter: bool = False) -> Track:
    """Lengths of eq. 6 along the heading of each stance (eq. 7–8)."""
    at = stances(foot, params)
    return _dead_reckoning(foot, at, zupt_lengths(foot, at), letter)


def sl_weinberg(
    foot: FootView,
    params: AccelerationParams | None = None,
    weinberg: WeinbergParams | None = None,
    *,
    letter: bool = False,
) -> Track:
    """Lengths of eq. 4 along the heading of each stance (eq. 7–8)."""
    at = stances(foot, params)
    return _dead_reckoning(foot, at, weinberg_lengths(foot, at, weinberg), letter)


def _dead_reckoning(foot: FootView, at: Stances, length_m: Floats, letter: bool) -> Track:
    """``letter``: the heading is that of the sensor's x axis, as if it pointed where the foot does."""
    if not len(at.row):
        return Track(np.zeros(0), np.zeros((0, 3)))
    if letter:
        heading = axis_headings(foot, at)[1:]
    else:
        heading = foot_heading(foot.motion)[at.row[1:]]
        moved = increments(foot, at)
        # the paper leaves the constant angle between sensor and foot in; it turns the whole track
        forward = np.sum((moved[:, 0] + 1j * moved[:, 1]) * np.exp(-1j * heading) * length_m)
        heading = heading + np.angle(forward)
    return Track(foot.time_s[at.row], along_headings(length_m, heading))


_ORIENTATION = "The orientation is gaitlab's, without a magnetometer, where the paper takes the device's."
_BEGIN = "The walk begins with the last window of stillness before the first swing; the paper does not say with which."
_ANGLE = (
    "The constant angle between the sensor and the foot, which the paper leaves in, is taken from the increments of eq. 5,"
    " and headings are turns since the first rest: the sensor's x axis may stand upright. Eq. 7 as printed is letter=True."
)
_ENDS = "Eq. 5 counts the sample of each stance in two strides; here in one; as printed it is letter=True."
_NEEDS = (Need.ACCELEROMETER, Need.GYROSCOPE)
METHODS = (
    Method(
        "jimenez2009_zupt",
        Question.POSITION,
        "Mean velocity around each stance removed, linearly between stances",
        f"{PAPER}, §IV.B steps 1–5, eq. 5, 9",
        _NEEDS,
        constants_of(AccelerationParams),
        (_ENDS, _ORIENTATION, _BEGIN),
        zupt,
    ),
    Method(
        "jimenez2009_sl_zupt",
        Question.POSITION,
        "Stride length by ZUPT along the heading of the stance",
        f"{PAPER}, §IV.B, §V.A, eq. 5–8",
        _NEEDS,
        constants_of(AccelerationParams),
        (_ANGLE, _ORIENTATION, _BEGIN),
        sl_zupt,
    ),
    Method(
        "jimenez2009_sl_weinberg",
        Question.POSITION,
        "Stride length by Weinberg along the heading of the stance",
        f"{PAPER}, §IV.A, §V.A, eq. 4, 7–8",
        _NEEDS,
        constants_of(AccelerationParams, WeinbergParams),
        (
            (
                "K is 1.9 times that of fig. 5, which gives 53 % of the strides of mtw-10m-walk; the paper's alone is"
                " WeinbergParams(calibration=1.0)."
            ),
            "The low pass runs forward and backward, so that it does not delay.",
            _ANGLE,
            _ORIENTATION,
            _BEGIN,
        ),
        sl_weinberg,
    ),
)
