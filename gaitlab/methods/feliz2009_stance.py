"""Stance by angular rate and the correction of the velocity, after Feliz et al. 2009.

Feliz, Zalama, Gómez, "Pedestrian tracking using inertial sensors", Journal of Physical Agents 3 (2009) 35–42, §II.B.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.heading import foot_heading
from gaitlab.methods.model import FootView, Method, Need, Question, Track
from gaitlab.methods.still import free_acceleration, majority, rests_where, samples, size
from gaitlab.motion.integration import position_of, velocity_of
from gaitlab.motion.model import Rests
from gaitlab.motion.passages import leaving
from gaitlab.recording.model import Bools, Floats

PAPER = "Feliz et al. 2009"


@dataclass(frozen=True)
class StanceParams:
    """Constants of the stance.

    Attributes
    ----------
    still_radps : float
        τ of eq. 2.
    half_window_s : float
        The filter of fig. 6 asks the samples so far to either side: flips shorter than this vanish. Without it half of the
        stances of ``mtw-10m-walk`` fall apart (51 %), with it 0.3 %.
    most_radps2 : float
        A sample whose angular acceleration about the horizontal axes is larger is no stop: the foot's rate passes through
        zero. In the stances there it is 12 rad/s² on average (95 %: 22).
    """

    still_radps: float = constant(1.0, "rad/s", f"{PAPER}, §II.B, eq. 2: τ")
    half_window_s: float = constant(0.1, "s", "ours: the paper describes the filter without numbers")
    most_radps2: float = constant(50.0, "rad/s²", "ours: the paper describes the filter without numbers")


def moving(foot: FootView, params: StanceParams | None = None) -> Bools:
    """S of eq. 1–2 after the filter of fig. 6, shape (n,): true where the foot moves."""
    p = params or StanceParams()
    raw = size(foot.gyr_radps) > p.still_radps
    pitch_roll = foot.motion.rate_radps[:, :2]
    second = pitch_roll[min(1, len(pitch_roll) - 1)]  # the first sample bends as the second does
    bend = np.diff(pitch_roll, axis=0, prepend=second[None]) * foot.rate_hz
    turning = np.hypot(bend[:, 0], bend[:, 1]) > p.most_radps2
    return majority(raw | turning, samples(p.half_window_s, foot.rate_hz))


def rests(foot: FootView, params: StanceParams | None = None) -> Rests:
    """Stances, eq. 1–3: rows ``[i_down, i_end + 1)`` of each."""
    return rests_where(~moving(foot, params))


def correct(raw_velocity_mps: Floats, stances: Rests, *, letter: bool = False) -> Floats:
    """Velocity corrected by eq. 4–6, shape (n, 3).

    Each step's velocity counts from the end of the stance before it, where it is reset. Its mean µ over the stance that
    follows is removed there, and a ramp from 0 to µ over the swing before. Rows before the first stance take the first
    µ, rows after the last keep counting from its end.

    Parameters
    ----------
    raw_velocity_mps : ndarray (n, 3)
        Integral of the free acceleration, world.
    letter : bool
        Eq. 4 as printed divides the sum over N samples by N − 1: µ comes out too large by 1/(N − 1), 3 % for a stance
        of 0.3 s. A stance of one sample, where that is no number, is divided by 1.
    """
    if not len(stances):
        return raw_velocity_mps.copy()
    down, last = stances.start, leaving(stances)
    reset = raw_velocity_mps[np.concatenate([down[:1], last[:-1]])]
    running = np.concatenate([np.zeros((1, 3)), np.cumsum(raw_velocity_mps, axis=0)])
    n = (last - down + 1)[:, None]
    mean = (running[last + 1] - running[down]) / n - reset
    error = reset + (mean * n / np.maximum(n - 1, 1) if letter else mean)
    # knots of what is removed: level over the stance, then from its last row, where the next step is reset, ramping on
    rows = np.stack([down, np.maximum(last - 1, down), last], axis=1).ravel()
    level = np.stack([error, error, raw_velocity_mps[last]], axis=1).reshape(-1, 3)
    rows, first = np.unique(rows, return_index=True)  # a stance of one or two rows: its own µ holds
    removed = np.stack(
        [np.interp(np.arange(len(running) - 1), rows, level[first, k]) for k in range(3)], axis=1
    )
    return np.asarray(raw_velocity_mps - removed)


def path(
    foot: FootView, stances: Rests, heading_rad: Floats | None = None, *, letter: bool = False
) -> Floats:
    """Place of each row, shape (n, 3), over that in the middle of the first stance.

    ``heading_rad`` (n,): another heading than the orientation's own, by compass for example (§II.C).
    """
    raw = foot.motion.raw_velocity_mps
    if heading_rad is not None:
        away = heading_rad - foot_heading(foot.motion)
        c, s = np.cos(away), np.sin(away)
        x, y, z = free_acceleration(foot.motion).T
        raw = velocity_of(np.stack([c * x - s * y, s * x + c * y, z], axis=1), foot.rate_hz)
    place = position_of(correct(raw, stances, letter=letter), foot.rate_hz)
    origin = stances.moment[0] if len(stances) else 0
    return np.asarray(place - place[origin])


def position(
    foot: FootView,
    params: StanceParams | None = None,
    heading_rad: Floats | None = None,
    *,
    letter: bool = False,
) -> Track:
    """Places in the middle of each stance: double integration with the correction of eq. 4–6."""
    stances = rests(foot, params)
    place = path(foot, stances, heading_rad, letter=letter)
    return Track(foot.time_s[stances.moment], place[stances.moment])


def height(foot: FootView, params: StanceParams | None = None) -> Floats:
    """Height of each row over the first stance, metres, shape (n,): the vertical of the same (§III.B).

    Below 1 rad/s a foot still rolls, and the mean of its velocity there is not zero: on the flat it sinks or climbs by up to
    4 cm a stride, 0.25 m at the end of 20 m (median of ``mtw-10m-walk``).
    """
    return path(foot, rests(foot, params))[:, 2]


_FILTER = (
    "The paper describes the filter of fig. 6 without a formula: a majority of the samples within 0.1 s, where one whose"
    " angular acceleration about the horizontal axes is large counts as moving."
)
_AXES = "Pitch and roll axes are the horizontal ones of the world, so that the mounting does not matter."
_ORIENTATION = "The orientation is gaitlab's, where the paper takes the device's."
_EQ_4 = "Eq. 4 divides by the number of samples that it sums; as printed, by one fewer, it is letter=True."
METHODS = (
    Method(
        "feliz2009",
        Question.REST,
        "Angular rate below 1 rad/s without short flips",
        f"{PAPER}, §II.B, eq. 1–3, fig. 6",
        (Need.GYROSCOPE,),
        constants_of(StanceParams),
        (_FILTER, _AXES),
        rests,
    ),
    Method(
        "feliz2009",
        Question.POSITION,
        "Mean velocity of each stance removed, ramp over the swing before",
        f"{PAPER}, §II.B, eq. 4–6",
        (Need.ACCELEROMETER, Need.GYROSCOPE),
        constants_of(StanceParams),
        (_EQ_4, _ORIENTATION, _FILTER, _AXES),
        position,
    ),
    Method(
        "feliz2009_inertial",
        Question.HEIGHT,
        "Double integration of the vertical acceleration",
        f"{PAPER}, §III.B, eq. 4–6",
        (Need.ACCELEROMETER, Need.GYROSCOPE),
        constants_of(StanceParams),
        (_EQ_4, _ORIENTATION, _FILTER, _AXES),
        height,
    ),
)
