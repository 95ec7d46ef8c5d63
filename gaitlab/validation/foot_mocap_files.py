"""The files of shoes under cameras.

mad-lab-fau/gaitmap example data: one file holds both feet, so it is no family of sensor files; it is read here and
laid on the packet clock like any other recording.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Placement, Recording, Side
from gaitlab.recording.model import Floats
from gaitlab.recording.rates import Rate, check_rate
from gaitlab.validation.folder import read_csv, read_file
from gaitlab.validation.plain import recording_of, samples_of
from gaitlab.validation.truth import OpticalPath

RATE_HZ = 204.8
OPTICAL_RATE_HZ = 100.0
HEEL = ("FCC", "HEE", "HEEL")
"""Names of the heel marker after the side's letter; FCC is the calcaneus."""
MOCAP = re.compile(r"mocap.*(left|right).*\.csv", re.IGNORECASE)
_SENSOR = re.compile(r"(left|right)_sensor")
_NO_NAMES = {"imu", "mocap", "left", "right"}


def is_imu(path: Path) -> bool:
    """A walk of two feet."""
    return path.name.lower().startswith("imu") and path.suffix.lower() == ".csv"


def is_stair(path: Path) -> bool:
    """A staircase."""
    return path.name.lower().startswith("stair") and path.suffix.lower() == ".csv"


def heels_of(files: list[Path], durations_s: Mapping[Path, float]) -> dict[Path, list[tuple[Side, Path]]]:
    """For each walk the optical files that belong to it.

    ``mocap_x_left.csv`` belongs to ``imu_x.csv``, ``mocap_left.csv`` to any walk beside it; of several, to the one whose
    duration is the nearest.
    """
    found: dict[Path, list[tuple[Side, Path]]] = {path: [] for path in durations_s}
    for path in files:
        match = MOCAP.fullmatch(path.name)
        walks = [walk for walk in durations_s if _words(path) <= _words(walk)]
        if match is None or not walks:
            continue
        frames = sum(1 for line in read_file(path).content.splitlines() if line.strip()) - 1
        nearest = min(walks, key=lambda walk: abs(durations_s[walk] - frames / OPTICAL_RATE_HZ))
        found[nearest].append((Side(match[1].lower()), path))
    return found


def _words(path: Path) -> set[str]:
    return set(path.stem.lower().split("_")) - _NO_NAMES


def strides_file(mocap: Path, files: list[Path]) -> Path | None:
    """The published strides beside an optical file."""
    wanted = re.sub("mocap", "stride_events", mocap.name, count=1, flags=re.IGNORECASE).lower()
    return next((path for path in files if path.name.lower() == wanted), None)


def read_feet(path: Path) -> Recording:
    """Both feet of one file: a heading of sensors over one of axes; acc m/s², gyr deg/s; the first column samples or
    seconds.

    Raises
    ------
    InputError
        Where a column is missing.
    """
    file = read_file(path)
    (sensors, axes), values = read_csv(file, 2)
    column = {pair: k for k, pair in enumerate(zip(sensors, axes, strict=False))}
    names = [name for name in dict.fromkeys(sensors) if _SENSOR.fullmatch(name)]
    if not names:
        raise InputError(
            "bad_heading",
            "Its first line names neither left_sensor nor right_sensor.",
            "Use the file as it was published.",
            file=file.name,
        )
    step = float(np.median(np.diff(values[:, 0]))) if len(values) > 1 else 1.0
    rate = Rate(1.0 / step if 0.0 < step < 0.5 else RATE_HZ, "header")
    check_rate(rate.hz)
    feet = {}
    for name in names:
        acc, gyr = (
            np.stack([_column(file, values, column, name, f"{kind}_{axis}") for axis in "xyz"], axis=1)
            for kind in ("acc", "gyr")
        )
        placement = Placement.foot(Side(name.split("_")[0]))
        feet[placement] = samples_of(file, np.arange(len(values)), rate, acc, np.deg2rad(gyr))
    return recording_of(feet, rate)


def _column(
    file: InputFile, values: Floats, column: Mapping[tuple[str, str], int], sensor: str, axis: str
) -> Floats:
    if (sensor, axis) not in column:
        raise InputError("bad_heading", f"There is no column {axis} of {sensor}.", "", file=file.name)
    one: Floats = values[:, column[sensor, axis]]
    if not np.isfinite(one).all():
        raise InputError("not_a_number", "A value is missing.", "", file=file.name, column=axis)
    return one


def read_heel(path: Path, side: Side) -> OpticalPath:
    """The heel marker of one side: mm at 100 Hz, from the sensors' first sample on."""
    file = read_file(path)
    headings, values = read_csv(file)
    names = [name.upper() for name in headings[0]]
    letter = side.value[0].upper()
    for marker in HEEL:
        wanted = [f"{letter}_{marker}_{axis}" for axis in "XYZ"]
        if all(name in names for name in wanted):
            point = values[:, [names.index(name) for name in wanted]] / 1000.0
            return OpticalPath(np.arange(len(values)) / OPTICAL_RATE_HZ, point)
    shown = ", ".join(headings[0][:10])
    raise InputError(
        "bad_truth", f"There is no marker {letter}_{HEEL[0]} of the heel among {shown}.", "", file=file.name
    )


def read_strides(path: Path) -> Floats:
    """Start and end of the published strides in seconds, shape (k, 2)."""
    file = read_file(path)
    lines = file.content.decode("utf-8-sig", errors="replace").splitlines()
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    if "start" not in names or "end" not in names:
        raise InputError("bad_truth", "It has no columns start and end.", "", file=file.name)
    wanted = (names.index("start"), names.index("end"))
    try:
        spans = np.loadtxt(lines[1:], delimiter=",", usecols=wanted, ndmin=2)
    except ValueError:
        raise InputError("bad_truth", "A start or an end is no number.", "", file=file.name) from None
    return np.asarray(spans / RATE_HZ)
