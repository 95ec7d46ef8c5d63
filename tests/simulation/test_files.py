"""What is written is read back as it was."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gaitlab.recording import Placement, read_recording
from gaitlab.simulation import (
    STYLES,
    TYPICAL_MTW,
    FileStyle,
    Plan,
    Simulation,
    Stand,
    Walk,
    simulate,
    write_mtmanager,
)

PRINTED = 5.1e-7


@pytest.fixture(scope="module")
def walk() -> Simulation:
    errors = replace(TYPICAL_MTW, lost_share=0.1, first_packet=65300)
    plan = Plan((Stand(2.0), Walk(2.0), Stand(1.0)))
    return simulate(plan, errors, magnetometer=True, pressure=True, free_acceleration=True)


@pytest.mark.parametrize("style", STYLES)
def test_every_variant_is_read_back_to_the_printed_digits(
    style: str, walk: Simulation, tmp_path: Path
) -> None:
    paths = write_mtmanager(walk, tmp_path, style=style)
    assert len(paths) == 4
    read = read_recording(tmp_path, rate_hz=None if STYLES[style].update_rate else 100.0)
    assert read.first_packet % 65536 == walk.recording.first_packet % 65536
    for placement, sensor in walk.recording.sensors.items():
        back = read.sensors[placement]
        assert back.rate_hz == sensor.rate_hz
        assert back.first_packet - read.first_packet == sensor.first_packet - walk.recording.first_packet
        np.testing.assert_array_equal(back.received, sensor.received)
        for name in ("acc_mps2", "gyr_radps", "mag", "pressure_pa"):
            np.testing.assert_allclose(getattr(back, name), getattr(sensor, name), atol=PRINTED)
        assert back.free_acc_mps2 is not None
        assert sensor.free_acc_mps2 is not None
        kept = sensor.received
        np.testing.assert_allclose(back.free_acc_mps2[kept], sensor.free_acc_mps2[kept], atol=PRINTED)
        if STYLES[style].orientation is None:
            assert back.attitude is None
            continue
        assert back.attitude is not None
        assert sensor.attitude is not None
        cosine = np.abs(np.sum(back.attitude[kept] * sensor.attitude[kept], axis=1))
        assert cosine.min() > 1.0 - 1e-10
        assert back.device == sensor.device


def test_lost_packets_are_missing_rows_and_the_counter_wraps(walk: Simulation, tmp_path: Path) -> None:
    path = write_mtmanager(walk, tmp_path, style="raw")[0]
    lines = path.read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("PacketCounter"))
    counters = [int(line.split("\t")[0]) for line in lines[head + 1 :]]
    sensor = walk.recording.sensors[Placement.LEFT_FOOT]
    rows = np.flatnonzero(sensor.received)
    assert counters == [(65300 + int(row)) % 65536 for row in rows]
    assert min(counters) < 50 < 65000 < max(counters)
    assert len(counters) < sensor.n_samples


def test_placement_json_names_each_file(walk: Simulation, tmp_path: Path) -> None:
    paths = write_mtmanager(walk, tmp_path)
    told = json.loads((tmp_path / "placement.json").read_text())
    assert told == {str(p): path.name for p, path in zip(walk.recording.sensors, paths, strict=True)}


def test_without_placement_json_the_names_tell_the_placement(walk: Simulation, tmp_path: Path) -> None:
    style = FileStyle(name="trial_{placement}_{device}.txt")
    write_mtmanager(walk, tmp_path, style=style, placement_json=False)
    assert not (tmp_path / "placement.json").exists()
    assert set(read_recording(tmp_path).sensors) == set(Placement)


def test_channels_that_were_not_simulated_are_left_out(tmp_path: Path) -> None:
    plain = simulate(Plan((Stand(1.0),)), knees=False, orientation=False)
    path = write_mtmanager(plain, tmp_path, style=FileStyle(times="none", newline="\n"))[0]
    header = next(line for line in path.read_text().splitlines() if line.startswith("PacketCounter"))
    assert header.split("\t") == ["PacketCounter", "Acc_X", "Acc_Y", "Acc_Z", "Gyr_X", "Gyr_Y", "Gyr_Z"]


def test_styles_differ_in_bytes_as_they_say(walk: Simulation, tmp_path: Path) -> None:
    written = {name: write_mtmanager(walk, tmp_path / name, style=name)[0].read_bytes() for name in STYLES}
    assert written["utf-16"][:2] in (b"\xff\xfe", b"\xfe\xff")
    assert written["semicolon"].startswith(b"\xef\xbb\xbf")
    assert b"0,0" in written["semicolon"]
    assert b"Mat[1][1]\tMat[2][1]\tMat[3][1]\tMat[1][2]" in written["4.6"]
    assert b"\r\n" in written["4.6"]
    assert b"\r" not in written["2022"]
    assert b"FreeAcc_E" in written["clinical"]
    assert b"Update Rate" not in written["clinical"]
    assert b",NaN,NaN," in written["2022"]
    assert b"DeviceId: 00B4" in written["2022"]
    assert b"DeviceId" not in written["4.6"]
