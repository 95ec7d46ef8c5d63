"""gaitlab's own answers to what is asked of a foot, under the same signatures as the published ones."""

from __future__ import annotations

import numpy as np

from gaitlab.methods.heading import foot_heading
from gaitlab.methods.model import FootView, Method, Need, Question, Track
from gaitlab.motion.model import Rests
from gaitlab.recording.model import Floats

_BOTH = (Need.ACCELEROMETER, Need.GYROSCOPE)


def rests(foot: FootView) -> Rests:
    """One rest in every gait cycle, found against the recording's own swings (``gaitlab.motion.rest``)."""
    return foot.motion.rests


def steps(foot: FootView) -> Floats:
    """Times of the steps, shape (m,), seconds: where each rest but the first begins."""
    return foot.time_s[foot.motion.rests.start[1:]]


def heading(foot: FootView) -> Floats:
    """Heading of each row, radians, positive to the left, 0 at the first rest, shape (n,)."""
    return foot_heading(foot.motion)


def height(foot: FootView) -> Floats:
    """Height of each row over the first rest, metres, shape (n,): of the smoother (``gaitlab.motion.path``)."""
    up = foot.motion.position_m[:, 2]
    moment = foot.motion.rests.moment
    return np.asarray(up - up[moment[0] if len(moment) else 0])


def position(foot: FootView) -> Track:
    """Places at the quietest moment of each rest, by the smoother (``gaitlab.motion.path``)."""
    place = foot.motion.rest_position_m
    return Track(foot.time_s[foot.motion.rests.moment], place - place[:1])


METHODS = (
    Method(
        "gaitlab",
        Question.REST,
        "One rest in every gait cycle",
        "gaitlab, gaitlab/motion/rest.py",
        _BOTH,
        (),
        (),
        rests,
    ),
    Method(
        "gaitlab",
        Question.STEP,
        "Where a rest of the gait cycle begins",
        "gaitlab, gaitlab/motion/rest.py",
        _BOTH,
        (),
        (),
        steps,
    ),
    Method(
        "gaitlab",
        Question.HEADING,
        "Gyroscope made level at every rest; the magnetometer where its field agrees",
        "gaitlab, gaitlab/motion/foot.py and magnetometer.py",
        _BOTH,
        (),
        (),
        heading,
    ),
    Method(
        "gaitlab",
        Question.HEIGHT,
        "Smoother from rest to rest, one floor where it is level",
        "gaitlab, gaitlab/motion/path.py",
        _BOTH,
        (),
        (),
        height,
    ),
    Method(
        "gaitlab",
        Question.POSITION,
        "Smoother from rest to rest",
        "gaitlab, gaitlab/motion/path.py",
        _BOTH,
        (),
        (),
        position,
    ),
)
