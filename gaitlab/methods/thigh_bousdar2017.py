"""The thigh navigation system, and the same with the posture of the leg fed back to its filter.

Bousdar Ahmed and Metzger 2017, §II-C, eq. 3–6, fig. 6. The system itself is their reference [12] (Munoz Diaz 2015),
which we do not have: an unscented filter for the thigh's orientation and a step length from the swing of its pitch are
all that the paper says of it; what is assumed stands in ``unscented`` and ``thigh_model``.

Measured on the two thighs of ``mtw-leg-vicon``: with sensors as good as an MTw the corrections do not help (tilt against
the optical thigh 4.6° RMS without and 4.8° with, strides 10.5 and 10.6 cm), for what leaves the zone there is the turn
and how the sensor is taken to sit, which standing with the feet apart decides, not the filter. With an offset of the
gyroscope that walks by 0.04 rad/s/√s, drawn 16 times, they do (tilt against VQF 18.5° and 12.7°, strides 28 and 20 cm);
the heading they do not mend (45° and 51° off on the way back).
"""

from __future__ import annotations

import numpy as np

from gaitlab.methods import unscented
from gaitlab.methods.constants import constants_of
from gaitlab.methods.leg_model import hip_angles
from gaitlab.methods.model import Method, Need, Question
from gaitlab.methods.posture_bousdar2017 import ZONE, ComfortZone, corrections, extremes
from gaitlab.methods.thigh_model import (
    StrideParams,
    SwingFactors,
    ThighTrack,
    ThighView,
    mounting,
    no_track,
    track_of,
)
from gaitlab.methods.unscented import UnscentedParams
from gaitlab.motion.quaternions import multiply
from gaitlab.recording.model import Floats

NOT_DETERMINABLE = (
    "The thigh needs a second of standing and two rests of its foot to tell how its sensor sits."
)


def correction_turn(roll_rad: float, pitch_rad: float) -> Floats:
    """Δ of eq. 5 as a quaternion (4,): the pitch's correction about y, then the roll's about x."""
    half = 0.5 * np.array([roll_rad, pitch_rad])
    (cr, cp), (sr, sp) = np.cos(half), np.sin(half)
    return np.array([cp * cr, cp * sr, sp * cr, -sp * sr])


def track(view: ThighView) -> ThighTrack:
    """The thigh navigation system without any knowledge of the leg."""
    return _track(view, None)


def track_corrected(view: ThighView, zone: ComfortZone = ZONE) -> ThighTrack:
    """The same, corrected after each stance that leaves the comfort zone."""
    return _track(view, zone)


def _track(view: ThighView, zone: ComfortZone | None) -> ThighTrack:
    mount = mounting(view)
    if mount is None:
        return no_track(view, NOT_DETERMINABLE)
    attitude, given = filtered(view, mount, zone)
    return track_of(view, attitude, given)


def filtered(view: ThighView, mount: Floats, zone: ComfortZone | None) -> tuple[Floats, Floats]:
    """Orientation of the thigh (n, 4), and what was given to the filter after each stance (k, 2), roll and pitch.

    The control of a stance goes into the prediction of the first block after it, so that only what comes later
    changes, as in the paper.
    """
    blocks = unscented.blocks_of(view.acc_mps2, view.gyr_radps, view.rate_hz)
    belief = unscented.first_belief(blocks)
    thigh = multiply(blocks.integral, mount)
    start, end = view.stances
    given = np.zeros((len(start), 2))
    turns = np.empty((len(blocks.seconds), 4))
    done = 0
    for k in range(len(start) if zone is not None else 0):
        until = int(np.searchsorted(blocks.edge, end[k]))
        turns[done:until], belief = unscented.run(blocks, belief, done, until)
        done = until
        if zone is None or until == len(turns):
            break
        rows = np.arange(start[k], end[k])
        block = np.searchsorted(blocks.edge, rows, side="right") - 1
        hip = np.stack(hip_angles(multiply(turns[block], thigh[rows]))[1:], axis=1)
        low, high = extremes(hip, np.zeros(1, dtype=np.intp), np.full(1, len(rows), dtype=np.intp))
        given[k] = corrections(low, high, zone)[0]
        at = thigh[blocks.edge[until] - 1]
        belief = unscented.controlled(belief, at, correction_turn(given[k, 0], given[k, 1]))
    turns[done:], _ = unscented.run(blocks, belief, done, len(turns))
    return multiply(unscented.attitudes(blocks, turns), mount), given


_PARAMS = (UnscentedParams, StrideParams, SwingFactors)
_NEEDS = (Need.THIGH, Need.ACCELEROMETER, Need.GYROSCOPE)
_DEVIATIONS = (
    (
        "The system of reference [12] is not at hand; the filter's noise, its measurement, the step detector and the"
        " factors of the step length are assumed, each said where it is."
    ),
    (
        "The orientation is a quaternion with an error in world axes instead of Euler angles, which are singular in a"
        " sitting person."
    ),
    "How the sensor sits on the thigh is found from standing and walking instead of being aligned by hand.",
    "A length is that of a stride of this leg, not of a step.",
)

METHODS = (
    Method(
        name="bousdar2017_thigh",
        question=Question.THIGH,
        title="Thigh navigation: unscented filter, stride from the swing of the pitch",
        reference="Bousdar Ahmed and Metzger 2017, §II-B, §III-B, with its reference [12] (Munoz Diaz 2015)",
        needs=_NEEDS,
        constants=constants_of(*_PARAMS),
        deviations=_DEVIATIONS,
        run=track,
    ),
    Method(
        name="bousdar2017_thigh_corrected",
        question=Question.THIGH,
        title="The same, corrected where the leg leaves the comfort zone",
        reference="Bousdar Ahmed and Metzger 2017, §II-C, eq. 3–6, fig. 6",
        needs=_NEEDS,
        constants=constants_of(*_PARAMS, ComfortZone),
        deviations=(
            *_DEVIATIONS,
            "Roll and pitch are the model's own angles; the paper's Euler angles are the same to second order.",
        ),
        run=track_corrected,
    ),
)
