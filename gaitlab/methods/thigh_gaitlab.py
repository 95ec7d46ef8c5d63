"""Our own path of a thigh, tied to its foot by the leg between, as a method beside the paper's."""

from __future__ import annotations

import itertools

import numpy as np

from gaitlab.methods.leg_model import hip_angles
from gaitlab.methods.model import Method, Need, Question
from gaitlab.methods.thigh_bousdar2017 import NOT_DETERMINABLE
from gaitlab.methods.thigh_model import ThighTrack, ThighView, mounting, no_track, swings_between, track_of
from gaitlab.motion.quaternions import multiply


def track(view: ThighView) -> ThighTrack:
    """Orientation by VQF; a stride from every rest of the foot to the next, by the path of ``motion.knee``.

    A stride's row is that at which the thigh is farthest forward in between.
    """
    mount = mounting(view)
    if mount is None:
        return no_track(view, NOT_DETERMINABLE)
    attitude = multiply(view.motion.attitude, mount)
    moment = view.foot.rests.moment + view.shift
    moment = moment[(moment >= 0) & (moment < len(attitude))]
    pitch = hip_angles(attitude)[2]
    spans = itertools.pairwise(moment)
    forward = np.array([a + 1 + np.argmin(pitch[a + 1 : b + 1]) for a, b in spans], dtype=np.intp)
    way = np.diff(view.motion.position_m[moment], axis=0)
    none_given = np.zeros((len(view.stances[0]), 2))
    return track_of(view, attitude, none_given, swings_between(pitch, moment[:-1], forward), way)


METHOD = Method(
    name="gaitlab_thigh",
    question=Question.THIGH,
    title="Path of the thigh tied to its foot by thigh and shank",
    reference="gaitlab.motion.knee, gaitlab.motion.thigh; orientation: Laidig and Seel 2023",
    needs=(Need.THIGH, Need.ACCELEROMETER, Need.GYROSCOPE),
    constants=(),
    deviations=(),
    run=track,
)
