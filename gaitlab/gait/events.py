"""Foot off and initial contact, from how the foot moves in each swing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.gait.sole import FootSwings, middle_of
from gaitlab.motion.model import FootMotion, Indices
from gaitlab.motion.windows import Windows, refined
from gaitlab.recording.model import Bools, Floats


@dataclass(frozen=True)
class EventParams:
    """How events are read off the movement; shares are of each swing's own peaks.

    The delays are medians against the hand-checked events of ``mtw-10m-walk``, mid-walk (1,182 swings); leaving any
    one of the 8 people out moves none of them by more than 3.5 ms.

    Attributes
    ----------
    roll_off_share : float
        The push ends when the foot's pitching forward has fallen to this share of its peak.
    toe_moves_share : float
        The toe begins to move at this share of its own peak speed.
    toe_gone_share : float
        It has left when it reaches this share of the sensor's peak speed.
    heel_stops_share : float
        The heel has come down when its speed falls below this share of the sensor's peak speed.
    impact_share : float
        The impact is when this share of the landing's squared jerk is past.
    roll_off_late_s, toe_gone_late_s : float
        How much later than foot off each is.
    slap_share : float
        A slap slower than this share of the foot's median one is none: the foot landed flat.
    slap_late_s, slap_peak_late_s, heel_late_s, fall_late_s, impact_late_s : float
        How much later than initial contact each witness of it is.
    agreement_s : float
        A witness of initial contact farther than this from the median of all is not heard.
    spot_share : float
        A foot whose sensor never exceeds this share of a typical swing's peak speed turned on the spot.
    event_bias_sd_s : float
        What is common to all events of one kind of one foot: 7.2 and 8.1 ms there. Within a foot 5.9 ms are left.
    """

    roll_off_share: float = 0.5
    toe_moves_share: float = 0.1
    toe_gone_share: float = 0.4
    heel_stops_share: float = 0.15
    impact_share: float = 0.25
    roll_off_late_s: float = 0.006
    toe_gone_late_s: float = 0.011
    slap_share: float = 0.2
    slap_late_s: float = 0.029
    slap_peak_late_s: float = 0.024
    heel_late_s: float = 0.012
    fall_late_s: float = 0.002
    impact_late_s: float = 0.007
    agreement_s: float = 0.04
    spot_share: float = 0.07
    event_bias_sd_s: float = 0.008


@dataclass(frozen=True, eq=False)
class FootEvents:
    """Events of each swing, in seconds on the recording's clock, shape (k − 1,) for k rests.

    ``on_the_spot`` is true where the foot turned without leaving its place: the times are those of the turning.
    ``lateral``: the foot's own lateral axis, see ``FootSwings``; zero where it made no swing.
    """

    foot_off_s: Floats
    initial_contact_s: Floats
    on_the_spot: Bools
    lateral: Floats


def find_events(foot: FootMotion, params: EventParams | None = None) -> FootEvents:
    """Find foot off and initial contact in each swing (the movement from one rest to the next).

    Foot off: the end of the push, when the foot's pitching forward has fallen to half its peak; but not before the toe
    begins to move, nor after it is gone. A foot that is lifted flat has no push: there the toe alone decides.

    Initial contact: five witnesses after the fastest moment, each with its delay taken off: the slap of the forefoot
    (its peak, and the centre of the squared pitching forward, which counts twice), the heel's coming to a stop, the
    fastest fall, and the impact (a quarter of the squared jerk). The mean of those that agree with the median stands.
    Where the foot lands flat the heel speaks for slap and fall: the one is not there, the other is too early.

    Ours; no template of a population and no axis of the sensor enters. Times lie between samples.
    """
    p = params or EventParams()
    if len(foot.rests) < 2:
        return FootEvents(np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.bool_), np.zeros(3))
    swings = FootSwings.of(foot)
    off = _foot_off(swings, foot.rate_hz, p)
    contact = np.maximum(_contact(swings, foot, p), off)
    top = swings.speed_mps[swings.peak]
    typical = middle_of(top[top >= 0.3 * top.max()])
    start_s = float(foot.time_s[0])
    return FootEvents(
        start_s + off / foot.rate_hz,
        start_s + contact / foot.rate_hz,
        top < p.spot_share * typical,
        swings.lateral,
    )


def _foot_off(swings: FootSwings, rate_hz: float, p: EventParams) -> Floats:
    """Row of foot off in each swing, shape (m,)."""
    start, top = swings.whole.start, swings.speed_mps[swings.peak]
    fastest = swings.whole.highest(swings.toe_mps)
    lifting = Windows(start, fastest + 1)
    moves = lifting.first_above(swings.toe_mps, p.toe_moves_share * swings.toe_mps[fastest])
    moves = np.where(np.isnan(moves), start, moves)
    gone = lifting.first_above(swings.toe_mps, p.toe_gone_share * top) - p.toe_gone_late_s * rate_hz
    gone = np.where(np.isnan(gone), moves, gone)
    push = swings.pitch_radps[swings.push]
    rolled = Windows(swings.push, swings.whole.end).first_below(swings.pitch_radps, p.roll_off_share * push)
    rolled = np.where((push > 0.0) & np.isfinite(rolled), rolled - 0.5 - p.roll_off_late_s * rate_hz, moves)
    return np.asarray(np.sort([moves, rolled, gone], axis=0)[1])


def _contact(swings: FootSwings, foot: FootMotion, p: EventParams) -> Floats:
    """Row of initial contact in each swing, shape (m,)."""
    after, top = swings.after, swings.speed_mps[swings.peak]
    rising = foot.velocity_mps[:, 2]
    lowest = after.highest(-rising)
    fall = refined(rising, lowest)
    slap = after.centre(np.maximum(swings.pitch_radps, 0.0) ** 2) - 0.5
    heel = after.first_below(swings.heel_mps, p.heel_stops_share * top)
    landing = Windows(swings.peak, lowest + 1).highest(foot.position_m[:, 2])
    impact = _share_past(foot.acceleration_mps2, landing, swings.whole.end - 1, p.impact_share)
    height = swings.pitch_radps[swings.slap]
    flat = height < p.slap_share * middle_of(height)
    peak = refined(swings.pitch_radps, swings.slap) - 0.5
    heard = [(slap, p.slap_late_s), (slap, p.slap_late_s), (peak, p.slap_peak_late_s), (fall, p.fall_late_s)]
    heel = np.where(np.isnan(heel), impact, heel) - p.heel_late_s * foot.rate_hz
    witnesses = [np.where(flat | np.isnan(row), heel, row - late * foot.rate_hz) for row, late in heard]
    return _agreed(
        np.stack([*witnesses, heel, impact - p.impact_late_s * foot.rate_hz]), p.agreement_s * foot.rate_hz
    )


def _agreed(witnesses: Floats, agreement: float) -> Floats:
    """Mean of the witnesses, shape (w, m), that differ from their median by no more than ``agreement``."""
    middle = np.sort(witnesses, axis=0)[len(witnesses) // 2]
    heard = np.abs(witnesses - middle) <= agreement
    return np.asarray(np.sum(witnesses * heard, axis=0) / np.sum(heard, axis=0))


def _share_past(acceleration: Floats, start: Indices, last: Indices, share: float) -> Floats:
    """Row, between two samples, at which this share of the squared jerk from ``start`` to ``last`` is past."""
    jerk = np.diff(np.ascontiguousarray(acceleration.T))
    past = np.concatenate([[0.0], np.cumsum(jerk[0] ** 2 + jerk[1] ** 2 + jerk[2] ** 2)])
    sought = past[start] + share * (past[last] - past[start])
    return np.asarray(np.interp(sought, past, np.arange(len(past)))) - 0.5
