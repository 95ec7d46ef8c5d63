"""Shoes under cameras: stride length against the heel marker; and staircases without cameras."""

from __future__ import annotations

from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording import Recording
from gaitlab.validation.folder import files_in, folders_in, not_this_set
from gaitlab.validation.foot_mocap_check import FootCheck, StairCheck, check_stairs, check_walk
from gaitlab.validation.foot_mocap_files import MOCAP, heels_of, is_imu, is_stair, read_feet
from gaitlab.validation.foot_mocap_rows import details_of, rows_of
from gaitlab.validation.model import KnownSet, Problem, Table

NAME = "foot-mocap"
WANTED = "imu*.csv with mocap_left.csv or mocap_right.csv, or stair*.csv"


def fits(folder: Path) -> bool:
    """Whether a folder holds such recordings."""
    files = files_in(folder)
    walk = any(map(is_imu, files)) and any(MOCAP.fullmatch(path.name) for path in files)
    return walk or any(map(is_stair, files))


def validate(folder: Path) -> Table:
    """Row 2 and the stairs, of the folder and the folders directly in it."""
    homes = [one for one in folders_in(folder) if fits(one)]
    if not homes:
        raise not_this_set(NAME, folder, WANTED)
    feet: list[FootCheck] = []
    stairs: list[StairCheck] = []
    problems: list[Problem] = []
    n = 0
    for home in homes:
        files = files_in(home)
        n += sum(is_imu(path) or is_stair(path) for path in files)
        walks = _read(files, problems)
        durations = {path: _duration_s(recording) for path, recording in walks.items()}
        heels = heels_of(files, durations)
        for path, recording in walks.items():
            try:
                found, failed = check_walk(path, recording, heels[path], files)
                feet += found
                problems += failed
            except InputError as error:
                problems.append(Problem(path.stem, str(error)))
        for path in filter(is_stair, files):
            try:
                stairs += check_stairs(path)
            except InputError as error:
                problems.append(Problem(path.stem, str(error)))
    return Table(NAME, folder.name, n, rows_of(feet, stairs), details_of(feet, stairs), tuple(problems))


def _read(files: list[Path], problems: list[Problem]) -> dict[Path, Recording]:
    walks = {}
    for path in filter(is_imu, files):
        try:
            walks[path] = read_feet(path)
        except InputError as error:
            problems.append(Problem(path.stem, str(error)))
    return walks


def _duration_s(recording: Recording) -> float:
    return max(sensor.n_samples / sensor.rate_hz for sensor in recording.sensors.values())


SET = KnownSet(NAME, WANTED, fits, validate)
