"""From a recording to its result: the table of contents of the method."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitlab import quality
from gaitlab.errors import InputError
from gaitlab.gait import course as walking
from gaitlab.gait import lengths, timing, variability
from gaitlab.gait import timed_walk as timed_course
from gaitlab.gait.foot_angle import foot_angles
from gaitlab.gait.knees import knee_gait, knee_parameters
from gaitlab.gait.model import Gait
from gaitlab.gait.strides import find_steps, foot_gait
from gaitlab.motion.course import Course, find_course
from gaitlab.motion.foot import track_foot
from gaitlab.motion.frame import Frame, to_common_frame
from gaitlab.motion.knee import track_knee
from gaitlab.motion.model import FootMotion, KneeMotion
from gaitlab.motion.together import with_one_heading
from gaitlab.outcome import result_of
from gaitlab.recording.model import Placement, Recording, Side
from gaitlab.result import Result
from gaitlab.series import SensorSeries, Series
from gaitlab.settings import METHODS, Settings

__all__ = ["METHODS", "Analysis", "Settings", "analyze"]


@dataclass(frozen=True, eq=False)
class Analysis:
    """An analysed recording: the result, the series behind it, and the movement for whoever wants more."""

    recording: Recording
    gait: Gait
    result: Result
    series: Series


def analyze(recording: Recording, settings: Settings | None = None) -> Analysis:
    """Reconstruct how each foot and knee moved and measure the gait.

    Raises
    ------
    InputError
        Where the recording cannot be analysed at all: no foot, too short, neither gyroscope nor orientation, foot
        and knee swapped, unknown method. Poor data is not an error: it gives "not determinable" with the reason.
    """
    settings = settings or Settings()
    _check(recording, settings)
    frame, knees, course = _reconstruct(recording, settings)
    quality.check_placements(frame.feet, knees)
    gait = _measure(recording, settings, frame, knees, course)
    result = result_of(recording, settings, gait)
    return Analysis(recording, gait, result, _series(gait))


def _check(recording: Recording, settings: Settings) -> None:
    if settings.method not in METHODS:
        raise InputError(
            "unknown_method", f"There is no method {settings.method!r}.", f"Choose {' or '.join(METHODS)}."
        )
    if settings.course_m is not None and not 1.0 <= settings.course_m <= 1000.0:
        raise InputError(
            "course_length", "The course must be between 1 m and 1000 m long.", "Give its length in metres."
        )
    if settings.way_m is not None and not 0.5 <= settings.way_m <= 10000.0:
        raise InputError(
            "known_way", "The known way must be between 0.5 m and 10 km long.", "Give its length in metres."
        )
    if not any(placement.is_foot for placement in recording.sensors):
        raise InputError(
            "no_foot",
            "The recording has no foot sensor.",
            "Add the file of at least one foot, or correct the placement.",
        )
    quality.check_length(recording)


def _reconstruct(recording: Recording, settings: Settings) -> tuple[Frame, dict[Side, KneeMotion], Course]:
    """Foot paths, knee paths and the course, in one world frame."""
    motions = {
        placement.side: track_foot(
            sensor, recording.time_s(placement), settings.method, settings.orientation, settings.anchor
        )
        for placement, sensor in recording.sensors.items()
        if placement.is_foot
    }
    course = find_course(motions)
    motions = with_one_heading(motions, course)
    frame = to_common_frame(motions, course)
    knees = {}
    for placement, sensor in recording.sensors.items():
        side = placement.side
        if placement.is_foot or side not in motions:
            continue
        shift = _knee_shift(recording, side)
        time_s = recording.time_s(placement)
        knee = track_knee(sensor, time_s, motions[side], shift, settings.method, settings.orientation)
        turned = knee.turned(frame.yaw_rad[side])
        knees[side] = turned.moved(_above_foot(turned, frame.feet[side], shift))
    return frame, knees, course


def _knee_shift(recording: Recording, side: Side) -> int:
    """Knee row = foot row + shift."""
    foot, knee = recording.sensors[Placement.foot(side)], recording.sensors[Placement.knee(side)]
    return foot.first_packet - knee.first_packet


def _above_foot(knee: KneeMotion, foot: FootMotion, shift: int) -> np.ndarray:
    """Shift that puts the knee above its foot at the foot's first rest; its height counts from where it is then."""
    row = int(foot.rests.moment[0]) if len(foot.rests) else 0
    there = foot.position_m[row] * np.array([1.0, 1.0, 0.0])
    here = knee.position_m[min(max(row + shift, 0), knee.n_samples - 1)]
    difference: np.ndarray = there - here
    return difference


def _measure(
    recording: Recording,
    settings: Settings,
    frame: Frame,
    knee_motions: Mapping[Side, KneeMotion],
    course: Course,
) -> Gait:
    feet = {side: foot_gait(motion, course) for side, motion in frame.feet.items()}
    knees = {
        side: knee_gait(motion, feet[side], _knee_shift(recording, side))
        for side, motion in knee_motions.items()
    }
    steps = find_steps(feet)
    timed = timed_course.time_course(feet, course, settings.course_m)
    spreads = variability.spreads_of(feet)
    parameters = (
        *timed_course.timed_walk(timed),
        *walking.speeds(feet),
        *lengths.traversed_distance(feet),
        *lengths.stride_length(feet),
        *lengths.step_length(feet, steps, frame.stood_together),
        *lengths.step_width(feet, steps, frame.stood_together),
        *foot_angles(feet),
        *timing.times_and_phases(feet, steps),
        timing.stop_duration(feet, course),
        *variability.variability(spreads),
        *walking.turns(feet, course),
        walking.path_deviation(feet, course, frame.stood_together),
        *walking.start_to_end(feet),
        *knee_parameters(knees),
    )
    findings = quality.merged(recording.findings, quality.findings(recording, settings, feet, knees))
    marked = quality.with_reserve(parameters, findings)
    return Gait(feet, knees, course, timed, marked, findings, spreads)


def _series(gait: Gait) -> dict[Placement, SensorSeries]:
    series = {}
    for side, foot in gait.feet.items():
        rest = foot.motion.rests.mask(foot.motion.n_samples)
        series[Placement.foot(side)] = _one_series(foot.motion, rest)
        if side in gait.knees:
            knee = gait.knees[side].motion
            rows = np.round((knee.time_s - foot.motion.time_s[0]) * knee.rate_hz).astype(np.intp)
            inside = (rows >= 0) & (rows < len(rest))
            foot_rests = np.zeros(knee.n_samples, dtype=np.bool_)
            foot_rests[inside] = rest[rows[inside]]
            series[Placement.knee(side)] = _one_series(knee, foot_rests)
    return {placement: series[placement] for placement in Placement if placement in series}


def _one_series(motion: FootMotion | KneeMotion, rest: np.ndarray) -> SensorSeries:
    return SensorSeries(
        motion.time_s,
        ~motion.received,
        rest,
        motion.acceleration_mps2,
        motion.velocity_mps,
        motion.position_m,
        motion.raw_velocity_mps,
        motion.raw_position_m,
    )
