"""Shoes laid on their heel markers, and the heights of feet on stairs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitlab.analysis import Analysis, analyze
from gaitlab.errors import InputError
from gaitlab.recording import Placement, Recording, Side
from gaitlab.recording.model import Bools, Floats
from gaitlab.recording.saturation import PARAMS as SATURATION
from gaitlab.validation.foot_mocap_files import read_feet, read_heel, read_strides, strides_file
from gaitlab.validation.model import Problem
from gaitlab.validation.optical import StrideCheck, check_strides
from gaitlab.validation.truth import OpticalPath


@dataclass(frozen=True, eq=False)
class FootCheck:
    """One foot of one recording.

    Attributes
    ----------
    strides : StrideCheck
        Between our rests.
    saturated : ndarray of bool
        A sample in the stride stood at the accelerometer's end of range.
    reference_m : ndarray (k, 2)
        Ours and the optical length between the instants of the published strides; empty where there are none.
    """

    recording: str
    side: Side
    strides: StrideCheck
    saturated: Bools
    reference_m: Floats


@dataclass(frozen=True, eq=False)
class StairCheck:
    """Heights of one foot on a staircase: at its rests, in metres above the first."""

    recording: str
    side: Side
    height_m: Floats


def check_foot(name: str, analysis: Analysis, side: Side, heel: OpticalPath, spans_s: Floats) -> FootCheck:
    """One foot against its heel marker."""
    foot = analysis.gait.feet[side]
    strides = check_strides(foot, heel)
    sensor = analysis.recording.sensors[Placement.foot(side)]
    assert sensor.acc_mps2 is not None
    time_s = foot.motion.time_s
    clipped: Bools = np.any(np.abs(sensor.acc_mps2) >= SATURATION.acc_mps2, axis=1)
    saturated = _any_within(clipped, time_s, strides.start_s, strides.end_s)
    path = OpticalPath(time_s, foot.motion.position_m)
    reference = np.stack(
        [one.horizontal_length(spans_s[:, 0], spans_s[:, 1]) for one in (path, heel)], axis=1
    )
    reference = reference[np.isfinite(reference).all(axis=1)]
    return FootCheck(name, side, strides, saturated, reference)


def _any_within(rows: Bools, time_s: Floats, start_s: Floats, end_s: Floats) -> Bools:
    total = np.concatenate([[0], np.cumsum(rows)])
    low, high = np.searchsorted(time_s, start_s), np.searchsorted(time_s, end_s)
    return np.asarray(total[high] > total[low])


def check_walk(
    imu: Path, recording: Recording, heels: list[tuple[Side, Path]], files: list[Path]
) -> tuple[list[FootCheck], list[Problem]]:
    """Each foot of one walk that has an optical file."""
    if not heels:
        raise InputError("no_truth", "There is no optical file for it.", "", file=imu.name)
    analysis = analyze(recording)
    feet, problems = [], []
    for side, path in heels:
        try:
            if side not in analysis.gait.feet:
                raise InputError("no_foot", f"The {side} foot was not recorded.", "", file=path.name)
            published = strides_file(path, files)
            spans = read_strides(published) if published else np.zeros((0, 2))
            feet.append(check_foot(imu.stem, analysis, side, read_heel(path, side), spans))
        except InputError as error:
            problems.append(Problem(f"{imu.stem}: {path.name}", str(error)))
    return feet, problems


def check_stairs(path: Path) -> list[StairCheck]:
    """Heights of both feet of a staircase."""
    feet = analyze(read_feet(path)).gait.feet
    places = {side: foot.motion.rest_position_m[:, 2] for side, foot in feet.items()}
    return [StairCheck(path.stem, side, height - height[0]) for side, height in places.items() if len(height)]
