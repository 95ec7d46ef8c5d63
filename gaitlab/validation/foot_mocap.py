"""Shoes under cameras: stride length against the heel marker; and a staircase without cameras.

mad-lab-fau/gaitmap example data: one file holds both feet, so it is no family of sensor files; it is read here and
laid on the packet clock like any other recording.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gaitlab.analysis import Analysis, analyze
from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Placement, Recording, Side
from gaitlab.recording.model import Bools, Floats, Sensor
from gaitlab.recording.quality import clock_findings
from gaitlab.recording.rates import Rate
from gaitlab.recording.reading import to_sensor
from gaitlab.recording.samples import Rates, Samples
from gaitlab.recording.saturation import PARAMS as SATURATION
from gaitlab.validation.folder import files_in, folders_in, not_this_set, read_csv, read_file
from gaitlab.validation.model import Problem, Table
from gaitlab.validation.optical import StrideCheck, check_strides
from gaitlab.validation.truth import OpticalPath

NAME = "foot-mocap"
WANTED = "imu*.csv with mocap_left.csv or mocap_right.csv, or stair*.csv"
RATE_HZ = 204.8
OPTICAL_RATE_HZ = 100.0
SAME_DURATION_S = 1.0
"""The cameras run as long as the sensors; this far apart two files are of one walk."""
HEEL = ("FCC", "HEE", "HEEL")
"""Names of the heel marker after the side's letter; FCC is the calcaneus."""
_SENSOR = re.compile(r"(left|right)_sensor")
_MOCAP = re.compile(r"mocap.*(left|right).*\.csv", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class FootCheck:
    """One foot of one recording.

    Attributes
    ----------
    strides : StrideCheck
        Between our rests.
    saturated, marked : ndarray of bool
        A sample in the stride stood at the accelerometer's end of range; the analysis counts it as such.
    reference_m : ndarray (k, 2)
        Ours and the optical length between the instants of the published strides; empty where there are none.
    """

    recording: str
    side: Side
    strides: StrideCheck
    saturated: Bools
    marked: Bools
    reference_m: Floats


@dataclass(frozen=True, eq=False)
class StairCheck:
    """Heights of one foot on a staircase: at its rests, in metres above the first."""

    recording: str
    side: Side
    height_m: Floats


def fits(folder: Path) -> bool:
    """Whether a folder holds such recordings."""
    names = [path.name.lower() for path in files_in(folder)]
    walk = any(_is_imu(name) for name in names) and any(map(_MOCAP.fullmatch, names))
    return walk or any(map(_is_stair, names))


def _is_imu(name: str) -> bool:
    return name.lower().startswith("imu") and name.lower().endswith(".csv")


def _is_stair(name: str) -> bool:
    return name.lower().startswith("stair") and name.lower().endswith(".csv")


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
    feet: dict[Placement, Sensor] = {}
    findings = []
    for name in names:
        placement = Placement.foot(Side(name.split("_")[0]))
        acc, gyr = (
            np.stack([_column(file, values, column, name, f"{kind}_{axis}") for axis in "xyz"], axis=1)
            for kind in ("acc", "gyr")
        )
        samples = plain_samples(file, np.arange(len(values)), rate, acc, np.deg2rad(gyr))
        feet[placement] = to_sensor(placement, samples, rate)
        found = clock_findings(samples, feet[placement])
        findings += [replace(finding, placement=placement) for finding in found]
    return Recording(feet, tuple(findings))


def _column(
    file: InputFile, values: Floats, column: Mapping[tuple[str, str], int], sensor: str, axis: str
) -> Floats:
    if (sensor, axis) not in column:
        raise InputError("bad_heading", f"There is no column {axis} of {sensor}.", "", file=file.name)
    one: Floats = values[:, column[sensor, axis]]
    if not np.isfinite(one).all():
        raise InputError("not_a_number", "A value is missing.", "", file=file.name, column=axis)
    return one


def plain_samples(
    file: InputFile, packet: np.ndarray, rate: Rate, acc_mps2: Floats, gyr_radps: Floats
) -> Samples:
    """Samples of a file that no reader of ``gaitlab.recording`` knows."""
    return Samples(
        file,
        "table of a public data set",
        packet.astype(np.int64),
        None,
        Rates(header_hz=rate.hz),
        acc_mps2=acc_mps2,
        gyr_radps=gyr_radps,
    )


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


def check_foot(name: str, analysis: Analysis, side: Side, heel: OpticalPath, spans_s: Floats) -> FootCheck:
    """One foot against its heel marker."""
    foot = analysis.gait.feet[side]
    strides = check_strides(foot, heel)
    sensor = analysis.recording.sensors[Placement.foot(side)]
    assert sensor.acc_mps2 is not None
    time_s = foot.motion.time_s
    clipped: Bools = np.any(np.abs(sensor.acc_mps2) >= SATURATION.acc_mps2, axis=1)
    saturated = _any_within(clipped, time_s, strides.start_s, strides.end_s)
    marked = _any_within(sensor.saturated, time_s, strides.start_s, strides.end_s)
    path = OpticalPath(time_s, foot.motion.position_m)
    reference = np.stack(
        [one.horizontal_length(spans_s[:, 0], spans_s[:, 1]) for one in (path, heel)], axis=1
    )
    reference = reference[np.isfinite(reference).all(axis=1)]
    return FootCheck(name, side, strides, saturated, marked, reference)


def _any_within(rows: Bools, time_s: Floats, start_s: Floats, end_s: Floats) -> Bools:
    total = np.concatenate([[0], np.cumsum(rows)])
    low, high = np.searchsorted(time_s, start_s), np.searchsorted(time_s, end_s)
    return np.asarray(total[high] > total[low])


def _mocap_of(imu: Path, duration_s: float, files: list[Path]) -> list[tuple[Side, Path]]:
    """The optical files that run as long as a recording."""
    found = []
    for path in files:
        match = _MOCAP.fullmatch(path.name)
        if match is None or path.parent != imu.parent:
            continue
        frames = sum(1 for line in read_file(path).content.splitlines() if line.strip()) - 1
        if abs(frames / OPTICAL_RATE_HZ - duration_s) <= SAME_DURATION_S:
            found.append((Side(match[1].lower()), path))
    return found


def check_walk(imu: Path, files: list[Path]) -> tuple[list[FootCheck], list[Problem]]:
    """Each foot of one walk that has an optical file."""
    recording = read_feet(imu)
    sensor = next(iter(recording.sensors.values()))
    optical = _mocap_of(imu, sensor.n_samples / sensor.rate_hz, files)
    if not optical:
        raise InputError("no_truth", "No optical file beside it runs as long.", "", file=imu.name)
    analysis = analyze(recording)
    feet, problems = [], []
    for side, path in optical:
        try:
            if side not in analysis.gait.feet:
                raise InputError(
                    "no_foot", f"There is no sensor of the {side} foot for it.", "", file=path.name
                )
            events = path.with_name(path.name.lower().replace("mocap", "stride_events"))
            spans = read_strides(events) if events in files else np.zeros((0, 2))
            feet.append(check_foot(imu.stem, analysis, side, read_heel(path, side), spans))
        except InputError as error:
            problems.append(Problem(f"{imu.stem}: {path.name}", str(error)))
    return feet, problems


def check_stairs(path: Path) -> list[StairCheck]:
    """Heights of both feet of a staircase."""
    feet = analyze(read_feet(path)).gait.feet
    places = {side: foot.motion.rest_position_m[:, 2] for side, foot in feet.items()}
    return [StairCheck(path.stem, side, height - height[0]) for side, height in places.items() if len(height)]


def validate(folder: Path) -> Table:
    """Row 2."""
    from gaitlab.validation.foot_mocap_rows import details_of, rows_of

    homes = [one for one in folders_in(folder) if fits(one)]
    if not homes:
        raise not_this_set(NAME, folder, WANTED)
    feet: list[FootCheck] = []
    stairs: list[StairCheck] = []
    problems: list[Problem] = []
    n = 0
    for home in homes:
        files = files_in(home)
        for path in files:
            try:
                if _is_imu(path.name):
                    n += 1
                    found, failed = check_walk(path, files)
                    feet += found
                    problems += failed
                elif _is_stair(path.name):
                    n += 1
                    stairs += check_stairs(path)
            except InputError as error:
                problems.append(Problem(path.stem, str(error)))
    return Table(NAME, folder.name, n, rows_of(feet, stairs), details_of(feet, stairs), tuple(problems))
