"""One foot on a loop that ends where it began.

xioTechnologies/Gait-Tracking: ``Time (s)``, gyroscope in deg/s, accelerometer in g. The times are those of reception:
some samples are there twice and some are missing, so each time is laid on a regular clock, like a packet counter.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.errors import InputError
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.recording import InputFile, Placement, Recording
from gaitlab.recording.model import Floats
from gaitlab.recording.rates import Rate, check_rate
from gaitlab.validation.folder import files_in, folders_in, not_this_set, read_csv, read_file
from gaitlab.validation.model import Column, Details, Goal, KnownSet, Problem, Row, Table
from gaitlab.validation.plain import recording_of, samples_of
from gaitlab.validation.statistics import M, figure

NAME = "foot-loop"
WANTED = "a CSV file with the columns Time (s), Gyroscope X (deg/s) …, Accelerometer X (g) …"
COLUMNS = (
    "Time (s)",
    *(f"Gyroscope {axis} (deg/s)" for axis in "XYZ"),
    *(f"Accelerometer {axis} (g)" for axis in "XYZ"),
)
REGULAR_SHARE = 0.95
"""At least so many steps of time have to be whole multiples of the sampling interval, within a quarter of it."""


@dataclass(frozen=True)
class Loop:
    """From the first rest of a loop to its last, in metres, and how far the foot went between."""

    recording: str
    horizontal_m: float
    closing_m: float
    path_m: float
    rests: int


def loops_in(folder: Path) -> list[Path]:
    """The loops of a folder."""
    return [path for path in files_in(folder) if path.suffix.lower() == ".csv" and _is_loop(path)]


def _is_loop(path: Path) -> bool:
    with path.open("rb") as file:
        return b"Time (s)" in (head := file.readline(1024)) and b"(deg/s)" in head


def fits(folder: Path) -> bool:
    """Whether a folder holds such a recording."""
    return bool(loops_in(folder))


def read_loop(path: Path) -> Recording:
    """One foot; which one does not matter, it is called the left."""
    file = read_file(path)
    headings, values = read_csv(file)
    missing = [name for name in COLUMNS if name not in headings[0]]
    if missing:
        raise InputError("bad_heading", f"There is no column {missing[0]}.", "", file=file.name)
    values = values[:, [headings[0].index(name) for name in COLUMNS]]
    if not np.isfinite(values).all():
        raise InputError("not_a_number", "A value is missing.", "", file=file.name)
    packet, rate_hz = regular_clock(values[:, 0], file)
    first = np.flatnonzero(np.diff(packet, prepend=packet[0] - 1) > 0)
    rate = Rate(rate_hz, "stamps")
    gyr, acc = np.deg2rad(values[first, 1:4]), values[first, 4:7] * STANDARD_GRAVITY_MPS2
    samples = samples_of(file, packet[first], rate, acc, gyr)
    return recording_of({Placement.LEFT_FOOT: samples}, rate)


def regular_clock(time_s: Floats, file: InputFile) -> tuple[np.ndarray, float]:
    """Number of sampling intervals since the first time, shape (n,), and their rate in Hz."""
    step = np.diff(time_s)
    forward = step[step > 0]
    if len(forward) < 2 or step.min() < 0:
        raise InputError("bad_time", "Its times do not run forward.", "", file=file.name)
    multiple = step / float(np.median(forward))
    whole = np.round(multiple)
    if np.mean(np.abs(multiple - whole) <= 0.25) < REGULAR_SHARE:
        raise InputError("bad_time", "Its times are not those of a regular clock.", "", file=file.name)
    packet = np.concatenate([[0], np.cumsum(whole)]).astype(np.int64)
    rate_hz = float(packet[-1] / (time_s[-1] - time_s[0]))
    check_rate(rate_hz)
    return packet, rate_hz


def check_loop(path: Path) -> Loop:
    """Closing of one loop."""
    (foot,) = analyze(read_loop(path)).gait.feet.values()
    places = foot.motion.rest_position_m
    if len(places) < 2:
        raise InputError("no_stride", "The foot makes no stride.", "", file=path.name)
    closing = places[-1] - places[0]
    return Loop(
        path.stem,
        float(np.linalg.norm(closing[:2])),
        float(np.linalg.norm(closing)),
        float(foot.length_m.sum()),
        len(places),
    )


def validate(folder: Path) -> Table:
    """Row 10."""
    paths = [path for home in folders_in(folder) for path in loops_in(home)]
    if not paths:
        raise not_this_set(NAME, folder, WANTED)
    loops: list[Loop] = []
    problems: list[Problem] = []
    for path in paths:
        try:
            loops.append(check_loop(path))
        except InputError as error:
            problems.append(Problem(path.stem, str(error)))
    return Table(NAME, folder.name, len(paths), _rows(loops), (_details(loops),), tuple(problems))


def _rows(loops: list[Loop]) -> tuple[Row, ...]:
    return tuple(_row(loop) for loop in loops)


def _row(loop: Loop) -> Row:
    figures = (
        figure("3D", loop.closing_m, M),
        figure("horizontal", loop.horizontal_m, M),
        figure("path", loop.path_m, M),
    )
    what = f"closing error of the loop, {loop.recording}"
    return Row(f"loop_{loop.recording}", what, figures, loop.rests, "rests", 10, (Goal("3D", high=0.1),))


def _details(loops: list[Loop]) -> Details:
    columns = (
        Column("recording"),
        Column("3D", "m", 3),
        Column("horizontal", "m", 3),
        Column("path", "m", 2),
        Column("rests", "", 0),
    )
    rows = ((one.recording, one.closing_m, one.horizontal_m, one.path_m, one.rests) for one in loops)
    return Details("loops", columns, tuple(rows))


SET = KnownSet(NAME, WANTED, fits, validate)
