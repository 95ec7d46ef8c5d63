"""Simulated recordings as text files of MT Manager, in the variants seen in the field."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from gaitlab.recording.model import Floats, Placement, Sensor
from gaitlab.simulation.simulate import Simulation


@dataclass(frozen=True)
class FileStyle:
    """How a file is written. A channel that the simulation does not have is left out.

    Attributes
    ----------
    header : "short" or "long"
        Four or five comment lines (MT Manager 4.6), or a dozen with the device's number (2019 to 2022).
    orientation : "quaternion", "matrix", "euler" or None
    gyroscope, magnetometer, free_acceleration, pressure : bool
        Channels to write.
    times : "none", "empty", "nan" or "stamp"
        No time columns; all of them, empty; all, NaN; SampleTimeFine alone, in microseconds.
    update_rate : bool
        Whether the comments state the rate.
    free_axes : str
        The three letters after ``FreeAcc_``.
    delimiter, newline, encoding : str
        ``utf-8-sig`` and ``utf-16`` write a byte order mark.
    decimal_comma : bool
        0,125 in place of 0.125; the delimiter must then be another character.
    counter_digits : int
        Packet counters are padded with zeros to this width.
    trailing_delimiter : bool
        Whether each line ends with one delimiter more.
    name : str
        File name; may hold ``{placement}``, ``{device}`` and ``{number}`` (of the sensor, from 0).
    """

    header: Literal["short", "long"] = "long"
    orientation: Literal["quaternion", "matrix", "euler"] | None = "quaternion"
    gyroscope: bool = True
    magnetometer: bool = True
    free_acceleration: bool = True
    pressure: bool = True
    times: Literal["none", "empty", "nan", "stamp"] = "empty"
    update_rate: bool = True
    free_axes: str = "XYZ"
    delimiter: str = "\t"
    newline: str = "\r\n"
    encoding: str = "utf-8"
    decimal_comma: bool = False
    counter_digits: int = 5
    trailing_delimiter: bool = False
    name: str = "MT_012005D6_009-001_{device}.txt"


#: Variants seen in the field, by name.
STYLES: Mapping[str, FileStyle] = MappingProxyType(
    {
        "4.6": FileStyle(header="short", orientation="matrix"),
        "2022": FileStyle(delimiter=",", newline="\n", times="nan", counter_digits=1),
        "clinical": FileStyle(orientation="euler", times="stamp", free_axes="ENU", update_rate=False),
        "raw": FileStyle(header="short", orientation=None, times="none", name="walk_{placement}.txt"),
        "semicolon": FileStyle(
            delimiter=";", decimal_comma=True, trailing_delimiter=True, encoding="utf-8-sig", times="none"
        ),
        "utf-16": FileStyle(encoding="utf-16", times="none"),
    }
)

_UTC = [f"UTC_{part}" for part in ("Nano", "Year", "Month", "Day", "Hour", "Minute", "Second", "Valid")]
_TIMES = ["SampleTimeFine", "Year", "Month", "Day", "Second", *_UTC]
_MATRIX = [f"Mat[{row}][{column}]" for column in (1, 2, 3) for row in (1, 2, 3)]


def write_mtmanager(
    simulation: Simulation,
    folder: Path | str,
    *,
    style: FileStyle | str = "2022",
    placement_json: bool = True,
) -> list[Path]:
    """Write one text file for each sensor; lost packets are missing rows, counters wrap at 65536.

    Parameters
    ----------
    folder : Path or str
        Made where it is missing; files of the same name are overwritten.
    style : FileStyle or str
        How to write, or the name of one of ``STYLES``.
    placement_json : bool
        Whether to write ``placement.json`` too, which says which file belongs where.

    Returns
    -------
    list of Path
        The sensors' files in the order of ``Placement``.
    """
    style = STYLES[style] if isinstance(style, str) else style
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths: dict[Placement, Path] = {}
    for number, (placement, sensor) in enumerate(simulation.recording.sensors.items()):
        name = style.name.format(placement=placement, device=sensor.device, number=number)
        paths[placement] = folder / name
        paths[placement].write_bytes(mtmanager_text(sensor, style).encode(style.encoding))
    if placement_json:
        names = {str(placement): path.name for placement, path in paths.items()}
        (folder / "placement.json").write_text(json.dumps(names, indent=1) + "\n", encoding="utf-8")
    return list(paths.values())


def mtmanager_text(sensor: Sensor, style: FileStyle) -> str:
    """The text of one sensor's file."""
    rows = np.flatnonzero(sensor.received)
    packet = sensor.first_packet + rows
    names, columns = _channels(sensor, rows, style)
    times, filling = _times(style)
    field = [f"%0{style.counter_digits}d", *filling, *["%.6f"] * len(names)]
    lead = [packet % 65536]
    if style.times == "stamp":
        lead.append(np.round(packet * 1e6 / sensor.rate_hz).astype(np.int64) % 2**32)
    end = style.delimiter if style.trailing_delimiter else ""
    pattern = style.delimiter.join(field) + end
    values = zip(*(column.tolist() for column in (*lead, *columns)), strict=True)
    lines = [pattern % row for row in values]
    if style.decimal_comma:
        lines = [line.replace(".", ",") for line in lines]
    head = style.delimiter.join(["PacketCounter", *times, *names]) + end
    return style.newline.join([*_comments(sensor, style), head, *lines, ""])


def _times(style: FileStyle) -> tuple[list[str], list[str]]:
    """Headings of the time columns, and what stands in each."""
    if style.times == "none":
        return [], []
    if style.times == "stamp":
        return _TIMES[:1], ["%d"]
    return _TIMES, ["NaN" if style.times == "nan" else ""] * len(_TIMES)


def _channels(
    sensor: Sensor, rows: NDArray[np.int_], style: FileStyle
) -> tuple[list[str], list[NDArray[np.float64]]]:
    """Headings and columns of the channels."""
    pressure = None if sensor.pressure_pa is None else sensor.pressure_pa[:, None]
    wanted: list[tuple[bool, Floats | None, list[str]]] = [
        (True, sensor.acc_mps2, ["Acc_X", "Acc_Y", "Acc_Z"]),
        (style.free_acceleration, sensor.free_acc_mps2, [f"FreeAcc_{axis}" for axis in style.free_axes]),
        (style.gyroscope, sensor.gyr_radps, ["Gyr_X", "Gyr_Y", "Gyr_Z"]),
        (style.magnetometer, sensor.mag, ["Mag_X", "Mag_Y", "Mag_Z"]),
        (style.pressure, pressure, ["Pressure"]),
        (style.orientation is not None, *_orientation(sensor, style)),
    ]
    names: list[str] = []
    columns: list[NDArray[np.float64]] = []
    for write, values, headings in wanted:
        if write and values is not None:
            names += headings
            columns += list(values[rows].T)
    return names, columns


def _orientation(sensor: Sensor, style: FileStyle) -> tuple[Floats | None, list[str]]:
    if sensor.attitude is None:
        return None, []
    if style.orientation == "matrix":
        matrix = Rotation.from_quat(sensor.attitude, scalar_first=True).as_matrix()
        return matrix.transpose(0, 2, 1).reshape(-1, 9), _MATRIX
    if style.orientation == "euler":
        angles = Rotation.from_quat(sensor.attitude, scalar_first=True).as_euler("ZYX", degrees=True)
        return angles[:, ::-1], ["Roll", "Pitch", "Yaw"]
    return sensor.attitude, [f"Quat_q{k}" for k in range(4)]


def _comments(sensor: Sensor, style: FileStyle) -> list[str]:
    rate = f"Update Rate: {sensor.rate_hz:.1f}Hz"
    if style.header == "short":
        lines = ["Start Time: Unknown", rate, "Filter Profile: human (46.1)", "Firmware Version: 4.0.2"]
        return [f"// {line}" for line in lines if style.update_rate or line != rate]
    lines = [
        "General information: ",
        " MT Manager version: 2022.2.0 ",
        " XDA version: 2022.2.0 build 7381 rev 124627 built on 2023-07-19",
        "Device information: ",
        f" DeviceId: {sensor.device}",
        " ProductCode: MTW2-3A7G6",
        " Firmware Version: 4.4.0",
        " Hardware Version: 1.1.0",
        "Device settings: ",
        f" {rate}",
        " Filter Profile: human(46.1)",
        " Option Flags: Orientation Smoother Disabled",
        "Coordinate system: ENU",
    ]
    return [f"// {line}" for line in lines if style.update_rate or line != f" {rate}"]
