"""Folders in the form of the public sets, out of simulated walks whose truth is known exactly."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np

from gaitlab.recording.model import Floats, Placement, Sensor, Side
from gaitlab.simulation import Simulation
from tests.recordings import mt_manager_text
from tests.walks import out_and_back


@cache
def walk() -> Simulation:
    """Ten metres and back with perfect sensors on feet and knees."""
    return out_and_back(None)


@cache
def text_of(placement: Placement) -> str:
    """A sensor of the walk as MT Manager writes it."""
    return mt_manager_text(walk().recording.sensors[placement])


def ten_metres(folder: Path, *names: str) -> Path:
    """Trials of ten metres and back with their true events."""
    folder.mkdir(parents=True, exist_ok=True)
    packets = {
        side: np.round(
            100.0 * np.stack([foot.foot_off_s, foot.initial_contact_s], axis=1)
            + walk().recording.first_packet
        ).astype(int)
        for side, foot in walk().truth.feet.items()
    }
    everything = np.concatenate(list(packets.values()))
    turn = walk().truth.turns[0]
    truth = {
        "TrialBoundaries": [int(everything.min()), int(everything.max())],
        "UTurnBoundaries": [round(100.0 * turn.start_s), round(100.0 * turn.end_s)],
        "LeftFootEvents": packets[Side.LEFT].tolist(),
        "RightFootEvents": packets[Side.RIGHT].tolist(),
    }
    for name in names:
        (folder / f"{name}_lf.txt").write_text(text_of(Placement.LEFT_FOOT))
        (folder / f"{name}_rf.txt").write_text(text_of(Placement.RIGHT_FOOT))
        (folder / f"{name}.json").write_text(json.dumps(truth))
    return folder


DEVICES = {
    Placement.LEFT_FOOT: "00B40C55",
    Placement.RIGHT_FOOT: "00B40C48",
    Placement.LEFT_KNEE: "00B40BA5",
    Placement.RIGHT_KNEE: "00B40C35",
}


def leg(folder: Path, side: Side = Side.LEFT, *, devices: bool = True) -> Path:
    """Sensors by their device and one leg's joints; the mid-foot of the cameras is where the foot's sensor is."""
    folder.mkdir(parents=True, exist_ok=True)
    names = {
        placement: f"S01-Walk-000_{device}.txt" if devices else f"sensor-{number}.txt"
        for number, (placement, device) in enumerate(DEVICES.items())
    }
    for placement, name in names.items():
        (folder / name).write_text(text_of(placement))
    if not devices:
        (folder / "placement.json").write_text(json.dumps({p.value: name for p, name in names.items()}))
    truth = walk().truth
    foot, knee = truth.feet[side].position_m, truth.knees[side].joint_m
    letter = side.value[0].upper()
    heads = [f"{letter}{joint}_{axis}" for joint in ("FEO", "TIO", "TOE") for axis in (1, 2, 3)]
    rows = np.column_stack([np.arange(len(foot)), knee, foot, foot])[200:-100]
    _write(folder / f"vicon-{side}-leg.csv", [["row", *heads]], rows)
    return folder


def shoes(folder: Path, name: str = "imu_sample.csv", optical: str = "mocap_left.csv") -> Path:
    """Both feet in one file, the left heel marker and the true strides of the left foot."""
    folder.mkdir(parents=True, exist_ok=True)
    left, right = (walk().recording.sensors[Placement.foot(side)] for side in Side)
    n = min(left.n_samples, right.n_samples)
    columns = [np.arange(n) / 100.0]
    heads: list[list[str]] = [["sensor"], ["axis"]]
    for name_of, sensor in (("left_sensor", left), ("right_sensor", right)):
        for kind, values in zip(("acc", "gyr"), _published(sensor), strict=True):
            columns += list(values[:n].T)
            heads[0] += [name_of] * 3
            heads[1] += [f"{kind}_{axis}" for axis in "xyz"]
    _write(folder / name, heads, np.stack(columns, axis=1))
    heel = 1000.0 * walk().truth.feet[Side.LEFT].position_m
    rows = np.column_stack([np.arange(len(heel)), heel])
    _write(folder / optical, [["sample", "L_FCC_x", "L_FCC_y", "L_FCC_z"]], rows)
    return folder


def _published(sensor: Sensor) -> tuple[Floats, Floats]:
    """Accelerometer in m/s² and gyroscope in deg/s."""
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    return sensor.acc_mps2, np.rad2deg(sensor.gyr_radps)


def loop(folder: Path, name: str = "loop.csv") -> Path:
    """One foot whose times are those of reception: some rows twice, some lost."""
    folder.mkdir(parents=True, exist_ok=True)
    acc, gyr = _published(walk().recording.sensors[Placement.LEFT_FOOT])
    rows = np.column_stack([np.arange(len(acc)) / 100.0, gyr, acc / 9.80665])
    keep = np.ones(len(rows), dtype=bool)
    keep[500::97] = False
    twice = np.sort(np.concatenate([np.flatnonzero(keep), np.flatnonzero(keep)[3::113]]))
    heads = [
        "Time (s)",
        *(f"Gyroscope {a} (deg/s)" for a in "XYZ"),
        *(f"Accelerometer {a} (g)" for a in "XYZ"),
    ]
    _write(folder / name, [heads], rows[twice])
    return folder


def _write(path: Path, heads: list[list[str]], rows: Floats) -> None:
    lines = [",".join(head) for head in heads]
    lines += [",".join(f"{value:.6f}" for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")
