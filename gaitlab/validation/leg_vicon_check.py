"""The recordings of a leg under cameras: which sensor is where, optical joints, strides and knees laid on them.

Sy et al., gait-tech/gaittoolbox: MT Manager text of each sensor, ``vicon-left-leg.csv`` (``-right-``) with the joint
centres at rows of those files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.errors import InputError
from gaitlab.motion.orientation import OrientationSource
from gaitlab.recording import Placement, Recording, Side, read_recording
from gaitlab.recording.file import clean_name
from gaitlab.recording.intake import PLACEMENT_FILE
from gaitlab.recording.mtmanager import device_in_name
from gaitlab.validation.folder import files_in, read_csv, read_file, read_json
from gaitlab.validation.knee_path import KneeCheck, check_knee
from gaitlab.validation.model import Problem
from gaitlab.validation.optical import StrideCheck, check_strides
from gaitlab.validation.truth import OpticalPath

DEVICES = {
    "00B40C55": "left_foot",
    "00B40C48": "right_foot",
    "00B40BA5": "left_shank",
    "00B40C35": "right_shank",
    "00B40C45": "left_thigh",
    "00B40C3C": "right_thigh",
}
"""Where the sensors of this set were worn; those above the ankles and on the pelvis are not used."""
SEGMENTS = ("shank", "thigh")
METHODS = ("gaitlab", "ikizoglu2018")
_OPTICAL = re.compile(r".*vicon.*\.csv", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class LegCheck:
    """One side of one recording: its strides, those with the device's orientation, its knee by segment and method."""

    recording: str
    side: Side
    strides: StrideCheck
    device_strides: StrideCheck | None
    knees: Mapping[tuple[str, str], KneeCheck]
    problems: tuple[Problem, ...] = field(default=())


def optical_files(folder: Path) -> list[Path]:
    """The files of the cameras."""
    return [path for path in files_in(folder) if _OPTICAL.fullmatch(path.name)]


def sensors_of(folder: Path) -> dict[str, Path]:
    """Files by place (``left_thigh``): of a ``placement.json``, else by device."""
    files = {path.name: path for path in files_in(folder)}
    if PLACEMENT_FILE in files:
        return _placed(read_json(files[PLACEMENT_FILE]), files)
    sensors: dict[str, Path] = {}
    for name, path in files.items():
        place = DEVICES.get(device_in_name(name) or "")
        if place is None or path.suffix.lower() != ".txt":
            continue
        if place in sensors:
            raise InputError(
                "placement_twice",
                f"Two files are of the {place.replace('_', ' ')}: {sensors[place].name} and {name}.",
                "Put each recording into a folder of its own.",
                file=name,
            )
        sensors[place] = path
    return sensors


def _placed(table: Mapping[str, object], files: Mapping[str, Path]) -> dict[str, Path]:
    sensors = {}
    for place, name in table.items():
        if not isinstance(name, str) or name not in files:
            message = f"It names a file for {clean_name(place)} that is not there."
            raise InputError("placement_file", message, "", file=PLACEMENT_FILE)
        sensors[place.replace("knee", "shank")] = files[name]
    return sensors


def read_optical(path: Path, recording: Recording, side: Side) -> dict[str, OpticalPath]:
    """Optical points of one side by name (``KNEE``, ``MIDFOOT``); none where the file has not this side.

    The file's ``row`` counts the rows of the sensor files, so the received samples; where samples were lost, the clock
    knows better.
    """
    headings, values = read_csv(read_file(path))
    names = headings[0]
    letter = side.value[0].upper()
    if f"{letter}FEO_1" not in names or "row" not in names:
        return {}

    def point(name: str) -> np.ndarray:
        wanted = [f"{letter}{name}_{axis}" for axis in (1, 2, 3)]
        missing = [one for one in wanted if one not in names]
        if missing:
            raise InputError("bad_truth", f"It has no column {missing[0]}.", "", file=path.name)
        return values[:, [names.index(one) for one in wanted]]

    placement = Placement.foot(side)
    sensor = recording.sensors[placement]
    rows = values[:, names.index("row")]
    received = np.flatnonzero(sensor.received)
    inside = (rows >= 0) & (rows < len(received))
    time_s = recording.time_s(placement)[received[rows[inside].astype(np.intp)]]
    middle = 0.5 * (point("TIO") + point("TOE"))
    return {
        "KNEE": OpticalPath(time_s, point("FEO")[inside]),
        "MIDFOOT": OpticalPath(time_s, middle[inside]),
    }


def check_leg(folder: Path, optical_file: Path, side: Side) -> LegCheck | None:
    """One side of a recording against its cameras; None where the file has not this side."""
    sensors = sensors_of(folder)
    if f"{side}_foot" not in sensors:
        return None
    plain = _analysed(sensors, None)
    optical = read_optical(optical_file, plain.recording, side)
    if not optical:
        return None
    problems: list[Problem] = []
    strides = check_strides(plain.gait.feet[side], optical["MIDFOOT"])
    device = None
    try:
        settings = Settings(orientation=OrientationSource.DEVICE)
        device = check_strides(_analysed(sensors, None, settings).gait.feet[side], optical["MIDFOOT"])
    except InputError as error:
        problems.append(Problem(f"{folder.name}: device's orientation", str(error)))
    knees: dict[tuple[str, str], KneeCheck] = {}
    for segment in SEGMENTS:
        if f"{side}_{segment}" not in sensors:
            problems.append(Problem(folder.name, f"There is no sensor on the {side} {segment}."))
            continue
        try:
            knees |= _knees(sensors, side, segment, optical["KNEE"])
        except InputError as error:
            problems.append(Problem(f"{folder.name}: {side} {segment}", str(error)))
    return LegCheck(folder.name, side, strides, device, knees, tuple(problems))


def _analysed(sensors: Mapping[str, Path], segment: str | None, settings: Settings | None = None) -> Analysis:
    """The analysis of both feet, with the sensors of one segment taken as the knees'."""
    files = {Placement.foot(side): sensors.get(f"{side}_foot") for side in Side}
    files |= {Placement.knee(side): sensors.get(f"{side}_{segment}") for side in Side}
    placements = {placement: path for placement, path in files.items() if path is not None}
    return analyze(read_recording(placements=placements), settings)


def _knees(
    sensors: Mapping[str, Path], side: Side, segment: str, optical: OpticalPath
) -> dict[tuple[str, str], KneeCheck]:
    """A segment's sensor as the knee, by each method; gait cycles are those of the first method for all."""
    checks: dict[tuple[str, str], KneeCheck] = {}
    cycles = None
    for method in METHODS:
        knee = _analysed(sensors, segment, Settings(method=method)).gait.knees[side].motion
        if cycles is None:
            cycles = (knee.cycle_start, knee.cycle_end)
        check = check_knee(knee, *cycles, optical)
        if check is None:
            raise InputError("no_cycle", "No whole gait cycle lies within sight of the cameras.")
        checks[segment, method] = check
    return checks
