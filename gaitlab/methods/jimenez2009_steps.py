"""Step detection of Jiménez et al. 2009: by acceleration, by angular rate, by magnetic field.

Jiménez, Seco, Prieto, Guevara, "A comparison of Pedestrian Dead-Reckoning algorithms using a low-cost MEMS IMU", WISP
2009, §III, table III: 0.1 %, 0.2 % and 0.94 % of 955 steps missed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.model import FootView, Method, Need, Question
from gaitlab.methods.still import filtered, majority, rests_where, samples, size, stretches
from gaitlab.motion.model import Indices, Rests
from gaitlab.motion.moving import moving_mean
from gaitlab.recording.model import Bools, Floats

PAPER = "Jiménez et al. 2009"


@dataclass(frozen=True)
class AccelerationParams:
    """Constants of the detector by acceleration.

    Attributes
    ----------
    half_window_s : float
        w: the variance is that of w samples on either side, and stillness is looked for w samples ahead.
    swing_mps2, stance_mps2 : float
        T1 and T2, for the local standard deviation of the size of the acceleration.
    reading : str
        Of condition 1 of step 4: ``falling`` (its words, "from high to low") or ``rising`` (its formula,
        B1ᵢ₋₁ < B1ᵢ).
    mean_of : str
        Of eq. 2: ``window`` takes each sample's deviation from the mean of the window whose variance it is;
        ``sample``, as printed, from the mean about that sample.
    """

    half_window_s: float = constant(0.15, "s", f"{PAPER}, eq. 2: w = 15 samples at 100 Hz")
    swing_mps2: float = constant(2.0, "m/s²", f"{PAPER}, §III.C step 3: T1")
    stance_mps2: float = constant(1.0, "m/s²", f"{PAPER}, §III.C step 3: T2")
    reading: Literal["falling", "rising"] = "falling"
    mean_of: Literal["window", "sample"] = "window"


@dataclass(frozen=True)
class GyroscopeParams:
    """Constants of the detector by angular rate.

    Attributes
    ----------
    still_radps : float
        Below it the foot does not move.
    half_window_s : float
        The median filter looks so far to either side. At 0.05 s, 4.3 % of the short stances of ``mtw-10m-walk`` show
        two steps, at 0.15 s 0.5 %.
    """

    still_radps: float = constant(1.0, "rad/s", f"{PAPER}, §III.D")
    half_window_s: float = constant(
        0.15, "s", "ours: the paper gives the median filter no width; w of its eq. 2"
    )


@dataclass(frozen=True)
class MagnetometerParams:
    """Constants of the detector by magnetic field; the paper gives none.

    Tuned on ``mtw-10m-walk``; below 2 Hz the constant part of a stance remains, above 5 Hz a swing breaks up.

    Attributes
    ----------
    cut_hz, order : float
        High pass, forward and backward.
    still_share, swing_quantile : float
        Still: less than this share of this quantile of the recording.
    least_share : float
        A field whose swings change it by less than this share of its size shows no steps.
    half_window_s : float
        As in ``GyroscopeParams``.
    """

    cut_hz: float = constant(3.0, "Hz", "ours: the paper names no cut")
    order: int = constant(2, "", "ours: the paper names no order")
    still_share: float = constant(0.2, "", "ours: 1 rad/s has no meaning for a field")
    swing_quantile: float = constant(0.9, "", "ours")
    least_share: float = constant(0.03, "", "ours: noise of a standing MTw is 0.003")
    half_window_s: float = constant(0.15, "s", "as for the gyroscope")


def spread(signal: Floats, half_window: int, mean_of: Literal["window", "sample"]) -> Floats:
    """Local standard deviation, shape (n,), eq. 2; beyond the ends the first and the last sample are held."""
    width = 2 * half_window + 1
    mean = moving_mean(signal, width)
    if mean_of == "sample":
        variance = moving_mean((signal - mean) ** 2, width)
    else:
        centred = signal - signal.mean()  # digits would be lost on 100 m²/s⁴ of gravity
        variance = moving_mean(centred**2, width) - moving_mean(centred, width) ** 2
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def acceleration_steps(foot: FootView, params: AccelerationParams | None = None) -> tuple[Indices, Bools]:
    """Rows in which a swing ends and a stance begins, eq. 1–3; and where B1 stands, shape (n,): the swings."""
    p = params or AccelerationParams()
    w = samples(p.half_window_s, foot.rate_hz)
    deviation = spread(size(foot.acc_mps2), w, p.mean_of)
    swing, stance = deviation > p.swing_mps2, deviation < p.stance_mps2
    before, here = swing[:-1], swing[1:]
    turned = before & ~here if p.reading == "falling" else ~before & here
    row = np.flatnonzero(turned) + 1
    ahead = np.concatenate([[0], np.cumsum(stance)])
    soon = ahead[np.minimum(row + w + 1, len(stance))] > ahead[row]
    return row[soon], swing


def by_acceleration(foot: FootView, params: AccelerationParams | None = None) -> Floats:
    """Times of the steps, shape (m,), seconds: where a swing ends (§III.C, eq. 1–3).

    The text of step 4 contradicts itself: "from high to low (B1ᵢ₋₁ < B1ᵢ)". By its formula no step of ``mtw-10m-walk`` is
    found: where a swing begins no stance is near. In eq. 2 as printed each sample is compared with the mean about itself;
    its deviation then spreads over twice the window, and 20 % of the steps are missed instead of 1.2 %. Both letters can
    be chosen in ``params``.
    """
    return foot.time_s[acceleration_steps(foot, params)[0]]


def _still_by_gyroscope(foot: FootView, params: GyroscopeParams | None) -> Bools:
    p = params or GyroscopeParams()
    return ~majority(size(foot.gyr_radps) > p.still_radps, samples(p.half_window_s, foot.rate_hz))


def by_gyroscope(foot: FootView, params: GyroscopeParams | None = None) -> Floats:
    """Times of the steps, shape (m,), seconds: where the angular rate, median-filtered, comes to rest (§III.D)."""
    return _comes_to_rest(foot, _still_by_gyroscope(foot, params))


def by_magnetometer(foot: FootView, params: MagnetometerParams | None = None) -> Floats:
    """Times of the steps, shape (m,), seconds: where the magnetic field in the sensor's axes stops changing (§III.D)."""
    p = params or MagnetometerParams()
    assert foot.mag is not None
    change = size(filtered(foot.mag, "high", p.cut_hz, p.order, foot.rate_hz))
    typical = float(np.quantile(change, p.swing_quantile))
    if not typical > p.least_share * float(size(foot.mag).mean()):
        return np.zeros(0)
    moving = majority(change > p.still_share * typical, samples(p.half_window_s, foot.rate_hz))
    return _comes_to_rest(foot, ~moving)


def _comes_to_rest(foot: FootView, still: Bools) -> Floats:
    start, _ = stretches(still)
    return foot.time_s[start[start > 0]]


def rests(foot: FootView, params: GyroscopeParams | None = None) -> Rests:
    """Rests: wherever the median-filtered angular rate stays below 1 rad/s."""
    return rests_where(_still_by_gyroscope(foot, params))


@dataclass(frozen=True, eq=False)
class Stances:
    """Stances as the positions of the paper need them.

    Attributes
    ----------
    row : ndarray (k,)
        i₍ₖ₎, the instant of each; the first is the stance that the walk began from, where it shows.
    half_window : int
        w.
    """

    row: Indices
    half_window: int


def stances(foot: FootView, params: AccelerationParams | None = None) -> Stances:
    """The instants of stance that the paper's positions rest on: its steps by acceleration (§III.E).

    The paper does not say where a walk begins: with the last window of stillness before the first swing. A recording that
    begins in a swing begins with its first step.
    """
    p = params or AccelerationParams()
    row, swing = acceleration_steps(foot, p)
    w = samples(p.half_window_s, foot.rate_hz)
    if swing[0]:
        return Stances(row, w)
    first = int(np.argmax(swing)) - 1 - w if swing.any() else 0
    return Stances(np.concatenate([[max(first, 0)], row]).astype(np.intp), w)


_MEDIAN = "The median filter is as wide as the window of eq. 2, since the paper gives it no width."
METHODS = (
    Method(
        "jimenez2009_acceleration",
        Question.STEP,
        "Where the local scatter of the acceleration falls",
        f"{PAPER}, §III.C, eq. 1–3, step 4",
        (Need.ACCELEROMETER,),
        constants_of(AccelerationParams),
        (
            (
                "A step is where B1 falls, as the words of step 4 say; its formula B1ᵢ₋₁ < B1ᵢ, which finds no step, is"
                " AccelerationParams(reading='rising')."
            ),
            (
                "Eq. 2 is taken as the variance within the window; as printed, each sample against the mean about itself, it"
                " misses 20 % of the steps of mtw-10m-walk; that is AccelerationParams(mean_of='sample')."
            ),
            "Windows last as long at any rate.",
        ),
        by_acceleration,
    ),
    Method(
        "jimenez2009_gyroscope",
        Question.STEP,
        "Where the angular rate comes to rest",
        f"{PAPER}, §III.D",
        (Need.GYROSCOPE,),
        constants_of(GyroscopeParams),
        (_MEDIAN,),
        by_gyroscope,
    ),
    Method(
        "jimenez2009_magnetometer",
        Question.STEP,
        "Where the magnetic field stops changing",
        f"{PAPER}, §III.D",
        (Need.MAGNETOMETER,),
        constants_of(MagnetometerParams),
        (
            (
                "The paper gives neither the high pass nor the threshold: the threshold is a share of the recording's own"
                " swings."
            ),
            _MEDIAN,
        ),
        by_magnetometer,
    ),
    Method(
        "jimenez2009_rest",
        Question.REST,
        "Angular rate below 1 rad/s, median-filtered",
        f"{PAPER}, §III.D",
        (Need.GYROSCOPE,),
        constants_of(GyroscopeParams),
        (
            "The paper looks for steps only: a rest is the stretch in which its detector says that the foot is still.",
            _MEDIAN,
        ),
        rests,
    ),
)
