"""Foot off and initial contact, from how the foot moves in each swing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import FootMotion
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class EventParams:
    """How events are read off the movement.

    Attributes
    ----------
    off_speed_share : float
        Foot off is when the foot's speed first passes this share of the swing's peak: of the shares from 0.1 to 0.5
        the one that agrees best with the hand-checked events of ``mtw-10m-walk``.
    event_sd_s : float
        Standard deviation of both events against the same hand-checked ones, tenth part trimmed.
    event_bias_sd_s : float
        What may be common to all events of one kind in a recording.
    """

    off_speed_share: float = 0.3
    event_sd_s: float = 0.02
    event_bias_sd_s: float = 0.01


@dataclass(frozen=True, eq=False)
class FootEvents:
    """Events of each swing, in seconds on the recording's clock, shape (k − 1,) for k rests."""

    foot_off_s: Floats
    initial_contact_s: Floats


def find_events(foot: FootMotion, params: EventParams | None = None) -> FootEvents:
    """Find foot off and initial contact in each swing (the movement from one rest to the next).

    Foot off: the speed of the foot first passes 30 % of the swing's peak.

    Initial contact: the median of three witnesses after the peak of forward speed: the end of the fastest descent
    (minimum of vertical velocity), the fastest slap of the forefoot to the ground (maximum of the angular rate that
    lowers the toes) and the largest jerk. One of them may fail (a flat landing has no slap, a soft one no jerk),
    the median stands.

    Ours; no template of a population and no axis of the sensor enters. Where a foot only turns on the spot the
    direction of its toes is taken for the direction of movement.
    """
    p = params or EventParams()
    rests = foot.rests
    off, contact = np.zeros(max(len(rests) - 1, 0)), np.zeros(max(len(rests) - 1, 0))
    speed = np.linalg.norm(foot.velocity_mps, axis=1)
    jerk = np.zeros(foot.n_samples)
    jerk[1:] = np.linalg.norm(np.diff(foot.acceleration_mps2, axis=0), axis=1)
    for k in range(len(rests) - 1):
        start, end = int(rests.moment[k]), int(rests.moment[k + 1]) + 1
        step = foot.position_m[end - 1] - foot.position_m[start]
        forward = _unit(step[:2])
        to_left = np.array([-forward[1], forward[0], 0.0])
        fast = speed[start:end]
        peak = int(np.argmax(foot.velocity_mps[start:end, :2] @ forward))
        top = max(float(fast.max()), 1e-9)
        off_row = start + int(np.argmax(fast > p.off_speed_share * top))
        after = slice(start + peak, end)
        witnesses = (
            np.argmin(foot.velocity_mps[after, 2]),
            np.argmax(foot.rate_radps[after] @ to_left),
            np.argmax(jerk[after]),
        )
        contact_row = start + peak + int(np.median(witnesses))
        off[k] = foot.time_s[off_row]
        contact[k] = foot.time_s[max(contact_row, off_row)]
    return FootEvents(off, contact)


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 1e-6 else np.array([1.0, 0.0])
