"""The public recordings: every file of every family is read, or refused by name."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Placement, read_files, read_recording
from gaitlab.recording.attitude import up_component
from gaitlab.recording.doctor import examine

LEFT_FOOT, RIGHT_FOOT = Placement.LEFT_FOOT, Placement.RIGHT_FOOT
DEVICES = {
    LEFT_FOOT: "00B40C55",
    RIGHT_FOOT: "00B40C48",
    Placement.LEFT_KNEE: "00B40BA5",
    Placement.RIGHT_KNEE: "00B40C35",
}


def trials(data_dir: Path) -> list[str]:
    return sorted(path.stem for path in (data_dir / "mtw-10m-walk").glob("*.json"))


def file(path: Path) -> InputFile:
    return InputFile(path.name, path.read_bytes())


def test_all_ten_metre_walks_are_read_onto_their_packet_clock(data_dir: Path) -> None:
    names = trials(data_dir)
    assert len(names) == 46
    for name in names:
        paths = [data_dir / "mtw-10m-walk" / f"{name}_{side}.txt" for side in ("lf", "rf")]
        recording = read_recording(*paths)
        assert list(recording.sensors) == [LEFT_FOOT, RIGHT_FOOT]
        assert recording.rate_hz == 100.0
        for path, sensor in zip(paths, recording.sensors.values(), strict=True):
            table = np.loadtxt(path, skiprows=2)  # an independent parser
            packet = table[:, 0].astype(int)
            assert (sensor.first_packet, sensor.n_samples) == (packet[0], packet[-1] - packet[0] + 1)
            assert np.array_equal(np.flatnonzero(sensor.received), packet - packet[0])
            for values, columns in (
                (sensor.acc_mps2, slice(1, 4)),
                (sensor.gyr_radps, slice(4, 7)),
                (sensor.mag, slice(7, 10)),
            ):
                assert values is not None
                assert np.array_equal(values[sensor.received], table[:, columns])
            assert sensor.n_saturated == 0


def test_hand_checked_events_lie_within_the_recorded_packets(data_dir: Path) -> None:
    folder = data_dir / "mtw-10m-walk"
    for name in trials(data_dir):
        truth = json.loads((folder / f"{name}.json").read_text())
        recording = read_recording(folder / f"{name}_lf.txt", folder / f"{name}_rf.txt")
        for placement, key in ((LEFT_FOOT, "LeftFootEvents"), (RIGHT_FOOT, "RightFootEvents")):
            sensor = recording.sensors[placement]
            events = np.array(truth[key])
            assert sensor.first_packet <= events.min()
            assert events.max() < sensor.first_packet + sensor.n_samples


def test_lost_share_is_as_the_data_sheet_says(data_dir: Path) -> None:
    shares = [
        report.losses.share
        for path in sorted((data_dir / "mtw-10m-walk").glob("*_?f.txt"))
        if (report := examine(file(path))).losses is not None
    ]
    assert len(shares) == 92
    assert 0.4 < np.mean(np.array(shares) > 0.01) < 0.7
    assert 0.15 < max(shares) < 0.25


def test_whole_folder_of_walks_is_refused_with_the_way_out(data_dir: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_recording(data_dir / "mtw-10m-walk")
    assert caught.value.code == "placement_twice"
    assert "1-1_lf.txt" in caught.value.message
    assert "--left-foot" in caught.value.hint


def test_one_walk_out_of_the_folder_by_name(data_dir: Path) -> None:
    folder = data_dir / "mtw-10m-walk"
    chosen = {LEFT_FOOT: folder / "8-5_lf.txt", RIGHT_FOOT: folder / "8-5_rf.txt"}
    for paths in ((), (folder,)):
        recording = read_recording(*paths, placements=chosen)
        assert [sensor.source.name for sensor in recording.sensors.values()] == ["8-5_lf.txt", "8-5_rf.txt"]


def test_leg_recording_with_device_orientation(data_dir: Path) -> None:
    folder = data_dir / "mtw-leg-vicon"
    recording = read_recording(
        placements={placement: next(folder.glob(f"*{device}.txt")) for placement, device in DEVICES.items()}
    )
    assert recording.findings == ()
    assert recording.first_packet == 27_626
    for placement, sensor in recording.sensors.items():
        assert sensor.device == DEVICES[placement]
        assert (sensor.n_samples, sensor.n_lost, sensor.n_saturated) == (2503, 0, 0)
        assert sensor.attitude is not None
        assert sensor.acc_mps2 is not None
        standing = slice(0, 500)
        up = up_component(sensor.attitude[standing], sensor.acc_mps2[standing])
        np.testing.assert_allclose(
            np.linalg.norm(sensor.acc_mps2[standing], axis=1).mean(), up.mean(), rtol=0.02
        )


def test_leg_folder_cannot_be_placed_by_itself(data_dir: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_recording(data_dir / "mtw-leg-vicon")
    assert caught.value.code == "placement_unknown"
    assert "00B40B91" in caught.value.message
    assert "vicon" not in caught.value.message
    assert "placement.json" in caught.value.hint


def test_files_with_matrices_and_empty_time_columns(data_dir: Path) -> None:
    folder = data_dir / "formats"
    recording = read_recording(
        placements={
            LEFT_FOOT: folder / "MT_012005D6_009-001_00B421E6.txt",
            RIGHT_FOOT: folder / "MT_012005D6_009-001_00B4227C.txt",
        }
    )
    assert recording.rate_hz == 100.0
    assert [sensor.n_samples for sensor in recording.sensors.values()] == [2432, 2474]
    for sensor in recording.sensors.values():
        assert (sensor.first_packet, sensor.n_lost) == (472, 0)
        assert sensor.gyr_radps is None
        assert sensor.attitude is not None
        assert sensor.acc_mps2 is not None
        assert up_component(sensor.attitude, sensor.acc_mps2).mean() == pytest.approx(9.8, abs=0.1)


@pytest.mark.parametrize(
    ("path", "code", "what"),
    [
        ("formats/LTibia_20210820_202113_811.csv", "movella_dot", "Movella DOT"),
        ("foot-mocap/imu_sample.csv", "not_mt_manager", "gaitmap"),
        ("foot-mocap/stair_up.csv", "not_mt_manager", "gaitmap"),
        ("foot-loop/short_walk.csv", "not_mt_manager", "x-io"),
        ("foot-mocap/mocap_left.csv", "not_mt_manager", "not an MT Manager export"),
        ("mtw-10m-walk/1-1.json", "not_mt_manager", "JSON"),
    ],
)
def test_other_families_are_refused_by_name(data_dir: Path, path: str, code: str, what: str) -> None:
    with pytest.raises(InputError) as caught:
        read_files({LEFT_FOOT: file(data_dir / path)})
    assert caught.value.code == code
    assert what in caught.value.message


def test_real_walk_in_degrees_is_refused_on_every_trial(data_dir: Path) -> None:
    for name in trials(data_dir)[::9]:
        lines = (data_dir / "mtw-10m-walk" / f"{name}_lf.txt").read_text().splitlines()
        changed = lines[:2]
        for line in lines[2:]:
            fields = line.split("\t")
            fields[4:7] = [f"{float(value) * 57.29578:.5f}" for value in fields[4:7]]
            changed.append("\t".join(fields))
        with pytest.raises(InputError) as caught:
            read_files({LEFT_FOOT: InputFile("degrees.txt", "\n".join(changed).encode())})
        assert (caught.value.code, caught.value.line, caught.value.column) == ("unit_gyr", 2, "Gyr_X")
