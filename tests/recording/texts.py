"""MT Manager texts built for tests: a sensor that turns left and right about the vertical, 100 times a second."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording import Finding, InputFile, Placement, Recording, Sensor, read_files

Floats = NDArray[np.float64]

SHORT_HEADER = (
    "// Start Time: Unknown",
    "// Update Rate: 100.0Hz",
    "// Filter Profile: human (46.1)",
    "// Option Flags: AHS Disabled ICC Disabled ",
    "// Firmware Version: 4.0.2",
)
LONG_HEADER = (
    "// General information: ",
    "//  MT Manager version: 2022.2.0 ",
    "//  XDA version: 2022.2.0 build 7381 rev 124627 built on 2023-07-19",
    "// Device information: ",
    "//  DeviceId: 00B42D4B",
    "//  ProductCode: MTW2-3A7G6",
    "//  Firmware Version: 4.4.0",
    "//  Hardware Version: 1.1.0",
    "// Device settings: ",
    "//  Filter Profile: human(46.1)",
    "//  Option Flags: Orientation Smoother Disabled, Position/Velocity Smoother Disabled",
    "// Coordinate system: ENU",
)
TEN_METRE_HEADER = ("Acquisition frequency: 100 Hz",)
ACC = ("Acc_X", "Acc_Y", "Acc_Z")
GYR = ("Gyr_X", "Gyr_Y", "Gyr_Z")
MAG = ("Mag_X", "Mag_Y", "Mag_Z")
QUATERNION = ("Quat_q0", "Quat_q1", "Quat_q2", "Quat_q3")
EULER = ("Roll", "Pitch", "Yaw")
MATRIX = tuple(f"Mat[{row}][{column}]" for row in (1, 2, 3) for column in (1, 2, 3))


def motion(n: int = 60, rate_hz: float = 100.0) -> dict[str, Floats]:
    """Columns by heading, all consistent with each other; rows are 1/rate apart."""
    t_s = np.arange(n) / rate_hz
    yaw_rad = np.sin(np.pi * t_s)
    noise = np.random.default_rng(1).normal(0, 0.05, (n, 6))
    zero = np.zeros(n)
    columns = {
        "Acc_X": noise[:, 0],
        "Acc_Y": noise[:, 1],
        "Acc_Z": 9.81 + noise[:, 2],
        "Gyr_X": 0.01 * noise[:, 3],
        "Gyr_Y": 0.01 * noise[:, 4],
        "Gyr_Z": np.pi * np.cos(np.pi * t_s),
        "Mag_X": np.cos(yaw_rad),
        "Mag_Y": -np.sin(yaw_rad),
        "Mag_Z": zero - 0.5,
        "Quat_q0": np.cos(yaw_rad / 2),
        "Quat_q1": zero,
        "Quat_q2": zero,
        "Quat_q3": np.sin(yaw_rad / 2),
        "Roll": zero,
        "Pitch": zero,
        "Yaw": np.rad2deg(yaw_rad),
        "FreeAcc_E": noise[:, 0],
        "FreeAcc_N": noise[:, 1],
        "FreeAcc_U": noise[:, 2],
        "Pressure": 101_325.0 + zero,
    }
    cos, sin = np.cos(yaw_rad), np.sin(yaw_rad)
    matrix = [[cos, -sin, zero], [sin, cos, zero], [zero, zero, zero + 1]]
    for row in range(3):
        for column in range(3):
            columns[f"Mat[{row + 1}][{column + 1}]"] = matrix[row][column]
    return columns


@dataclass
class Text:
    """An MT Manager text that can be written in any variant; ``cells`` are the fields of its rows."""

    headings: list[str]
    cells: list[list[str]]
    comments: Sequence[str] = SHORT_HEADER
    delimiter: str = "\t"
    line_end: str = "\n"
    encoding: str = "utf-8"
    name: str = "walk_left_foot.txt"
    tail: str = ""
    rename: Mapping[str, str] = field(default_factory=dict)

    @property
    def first_line(self) -> int:
        """Line of the first row, counted from 1."""
        return len(self.comments) + 2

    def put(self, row: int, heading: str, value: str) -> Text:
        """The same text with one field changed."""
        cells = [list(line) for line in self.cells]
        cells[row][self.headings.index(heading)] = value
        return replace(self, cells=cells)

    def with_column(self, heading: str, values: Iterable[str], at: int = 1) -> Text:
        """The same text with one more column."""
        cells = [[*line[:at], value, *line[at:]] for line, value in zip(self.cells, values, strict=True)]
        return replace(self, headings=[*self.headings[:at], heading, *self.headings[at:]], cells=cells)

    def without(self, *headings: str) -> Text:
        """The same text without these columns."""
        kept = [place for place, heading in enumerate(self.headings) if heading not in headings]
        return replace(
            self,
            headings=[self.headings[place] for place in kept],
            cells=[[line[place] for place in kept] for line in self.cells],
        )

    def keep_rows(self, rows: Iterable[int]) -> Text:
        """The same text with only these rows."""
        return replace(self, cells=[self.cells[row] for row in rows])

    @property
    def text(self) -> str:
        headings = [self.rename.get(heading, heading) for heading in self.headings]
        lines = [*self.comments, self.delimiter.join(headings), *map(self.delimiter.join, self.cells)]
        return self.line_end.join(lines) + self.line_end + self.tail

    @property
    def file(self) -> InputFile:
        return InputFile(self.name, self.text.encode(self.encoding))

    def read(self, rate_hz: float | None = None) -> Sensor:
        """The only sensor of a recording of this file."""
        return read_files({Placement.LEFT_FOOT: self.file}, rate_hz).sensors[Placement.LEFT_FOOT]


def mt_text(
    *groups: Sequence[str],
    n: int = 60,
    first_packet: int = 472,
    digits: int = 6,
    scale: Mapping[str, float] | None = None,
) -> Text:
    """A text with the packet counter and these groups of columns, of :func:`motion`."""
    columns = motion(n)
    headings = [heading for group in (groups or (ACC, GYR)) for heading in group]
    factors = scale or {}
    cells = [
        [f"{(first_packet + row) % 65536:05d}"]
        + [f"{columns[heading][row] * factors.get(heading, 1.0):.{digits}f}" for heading in headings]
        for row in range(n)
    ]
    return Text(["PacketCounter", *headings], cells)


def read_two(left: Text, right: Text, rate_hz: float | None = None) -> Recording:
    """A recording of two feet."""
    files = {
        Placement.LEFT_FOOT: replace(left, name="left.txt").file,
        Placement.RIGHT_FOOT: replace(right, name="right.txt").file,
    }
    return read_files(files, rate_hz)


def codes(findings: tuple[Finding, ...]) -> list[str]:
    """The codes of findings, in order."""
    return [finding.code for finding in findings]
