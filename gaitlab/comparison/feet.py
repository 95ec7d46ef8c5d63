"""What the methods say of one foot: its rests, steps, heading, height and places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gaitlab.comparison.inputs import Inputs
from gaitlab.comparison.model import MethodLengths, MethodPath, Value
from gaitlab.comparison.pairs import Compared, Pairs, nearest_pairs
from gaitlab.methods.closing import closing_of
from gaitlab.methods.gaitlab_foot import heading as our_heading
from gaitlab.methods.gaitlab_foot import height as our_height
from gaitlab.methods.gaitlab_foot import steps as our_steps
from gaitlab.methods.model import FootView, Method, Track
from gaitlab.motion.model import Rests
from gaitlab.recording.model import Floats, Side

DEG = float(np.degrees(1.0))
NO_PATH = "It finds fewer than two rests."
NO_REST = "It finds no rest."
NO_STEP = "It finds no step."


@dataclass(frozen=True, eq=False)
class Said:
    """What a method says of one side, its pairs with ours, and what pictures are drawn from."""

    values: tuple[Value, ...]
    pairs: Pairs | None = None
    reason: str = ""
    path: MethodPath | None = None
    lengths: MethodLengths | None = None


Timed = Callable[..., Any]
"""Calls a method's function and keeps the time."""

REST = Compared("duration of a rest", "rests", "s", 1.0, 3)
STEP = Compared("instant of a step", "steps", "ms", 1000.0, 0)
HEADING = Compared("turn in a stride", "strides", "°", DEG, 2)
HEIGHT = Compared("climb in a stride", "strides", "cm", 100.0, 2)
POSITION = Compared("stride length", "strides", "cm", 100.0, 2)


def rest(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Rests found, how many of ours they meet, and how long those between the first and the last of ours last."""
    foot = inputs.feet[side]
    found: Rests = call(method, foot)
    ours = foot.motion.rests
    seconds = (found.end - found.start) / foot.rate_hz
    our_seconds = (ours.end - ours.start) / foot.rate_hz
    first = np.searchsorted(found.end, ours.start, "right")
    there = first < len(found)
    met = np.zeros(len(ours), dtype=np.bool_)
    met[there] = found.start[first[there]] < ours.end[there]
    values = (
        Value("rests", len(found), "", 0),
        Value("of ours met", int(met.sum()), "", 0),
        Value("mean duration", float(seconds.mean()) if len(found) else np.nan, "s", 2),
    )
    met[[0, -1][: len(met)]] = False  # the standing before and after is as long as the recording
    apart = seconds[first[met]] - our_seconds[met]
    return Said(values, Pairs(apart, _instant_sd(foot)), "" if len(found) else NO_REST)


def step(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Steps of the foot, those of ours that are missing and those that ours has not, and their instants."""
    foot = inputs.feet[side]
    found, ours = np.asarray(call(method, foot)), our_steps(foot)
    within = 0.5 * float(np.median(np.diff(ours))) if len(ours) > 1 else 0.5
    a, b = nearest_pairs(found, ours, within)
    values = (
        Value("steps", len(found), "", 0),
        Value("missed of ours", len(ours) - len(b), "", 0),
        Value("not in ours", len(found) - len(a), "", 0),
    )
    return Said(values, Pairs(found[a] - ours[b], _instant_sd(foot)), "" if len(found) else NO_STEP)


def _instant_sd(foot: FootView) -> float:
    """An instant of ours is known to a sample."""
    return float(1.0 / (foot.rate_hz * np.sqrt(12.0)))


def heading(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Heading at the end, against ours; the turn in each stride."""
    foot = inputs.feet[side]
    found, ours = np.asarray(call(method, foot)), our_heading(foot)
    apart = found - ours
    walked = _walked(foot)
    field_seen = foot.motion.field
    drift = foot.motion.offsets.drift_sd_radps
    if field_seen is not None and field_seen.used:
        drift = field_seen.drift_sd_radps
    moment = foot.motion.rests.moment
    stride_s = float(np.diff(foot.time_s[moment]).mean()) if len(moment) > 1 else 0.0
    values = (
        Value("at the end", DEG * _last(found, walked), "°", 1, signed=True),
        Value("less ours", DEG * _last(apart, walked), "°", 1, signed=True),
        Value("RMS to ours", DEG * _rms(apart[walked]), "°", 1),
    )
    return Said(values, Pairs(np.diff(apart[moment]), drift * stride_s))


def height(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Height at the end, against ours; the climb in each stride."""
    foot = inputs.feet[side]
    found, ours = np.asarray(call(method, foot)), our_height(foot)
    apart, walked = found - ours, _walked(foot)
    climb = foot.motion.step_covariance_m2[:, 2, 2]
    sd = float(np.sqrt(climb.sum())) / len(climb) if len(climb) else 0.0
    values = (
        Value("at the end", _last(found, walked), "m", 2, signed=True),
        Value("RMS to ours", _rms(apart[walked]), "m", 2),
    )
    return Said(values, Pairs(np.diff(apart[foot.motion.rests.moment]), sd))


def _walked(foot: FootView) -> slice:
    """Rows from the first rest to the last."""
    moment = foot.motion.rests.moment
    return slice(int(moment[0]), int(moment[-1]) + 1) if len(moment) else slice(0, 0)


def _last(values: Floats, rows: slice) -> float:
    known = values[rows][np.isfinite(values[rows])]
    return float(known[-1]) if len(known) else np.nan


def _rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else np.nan


def position(inputs: Inputs, method: Method, side: Side, call: Timed) -> Said:
    """Path length, closing error, and distance to our path at the method's own instants; its strides against ours."""
    foot = inputs.feet[side]
    track: Track = call(method, foot)
    closing = closing_of(track)
    time_s, place = track.time_s, track.place_m[:, :2]
    if len(time_s) < 2:
        return Said((), None, NO_PATH)
    ours = _ours_at(foot, time_s)
    values = (
        Value("path", closing.path_m, "m", 2),
        Value("start to end", closing.error_m, "m", 2),
        Value("in % of the path", closing.percent, "%", 1),
        Value("RMS to ours", float(np.sqrt(np.mean(np.sum((place - ours) ** 2, axis=1)))), "m", 2),
    )
    lengths, our_lengths = (np.linalg.norm(np.diff(p, axis=0), axis=1) for p in (place, ours))
    shared = foot.motion.scale_sd * float(our_lengths.mean())
    return Said(values, Pairs(lengths - our_lengths, shared), path=MethodPath(method.name, side, place))


def _ours_at(foot: FootView, time_s: Floats) -> Floats:
    """Our places at some instants, shape (k, 2), from (0, 0) at the first."""
    at = [np.interp(time_s, foot.time_s, foot.motion.position_m[:, axis]) for axis in (0, 1)]
    places = np.stack(at, axis=1)
    return np.asarray(places - places[:1])
