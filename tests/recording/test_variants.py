"""Every way of writing an MT Manager export gives the same samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.recording import Placement, Sensor, read_files
from tests.recording.texts import (
    ACC,
    EULER,
    GYR,
    LONG_HEADER,
    MAG,
    QUATERNION,
    SHORT_HEADER,
    TEN_METRE_HEADER,
    Floats,
    motion,
    mt_text,
)

COLUMN_MAJOR = tuple(f"Mat[{row}][{column}]" for column in (1, 2, 3) for row in (1, 2, 3))
ROW_MAJOR = tuple(f"Mat[{row}][{column}]" for row in (1, 2, 3) for column in (1, 2, 3))


def expected(headings: tuple[str, ...], n: int = 60) -> Floats:
    columns = motion(n)
    return np.stack([columns[heading] for heading in headings], axis=1)


def assert_read(sensor: Sensor) -> None:
    assert sensor.acc_mps2 is not None
    assert sensor.gyr_radps is not None
    np.testing.assert_allclose(sensor.acc_mps2, expected(ACC), atol=1e-6)
    np.testing.assert_allclose(sensor.gyr_radps, expected(GYR), atol=1e-6)
    assert sensor.rate_hz == 100.0
    assert sensor.first_packet == 472


def assert_attitude(sensor: Sensor, tolerance: float = 1e-5) -> None:
    assert sensor.attitude is not None
    np.testing.assert_allclose(sensor.attitude, expected(QUATERNION), atol=tolerance)


@pytest.mark.parametrize("delimiter", [",", ";", "|", "\t", ":", " "])
def test_any_delimiter(delimiter: str) -> None:
    assert_read(replace(mt_text(), delimiter=delimiter).read())


def test_spaces_as_delimiter_hold_empty_fields_as_runs_of_spaces() -> None:
    text = mt_text()
    for heading in ("SampleTimeFine", "Year", "Month", "Day", "Second"):
        text = text.with_column(heading, [""] * 60, at=len(text.headings) - 6)
    text = replace(text, delimiter=" ")
    assert "00472      " in text.text
    assert_read(text.read())


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_any_line_end_and_encoding(line_end: str, encoding: str) -> None:
    text = replace(mt_text(ACC, GYR, QUATERNION), line_end=line_end, encoding=encoding)
    sensor = text.read()
    assert_read(sensor)
    assert_attitude(sensor)


def test_comments_in_a_western_code_page() -> None:
    text = replace(mt_text(), comments=("// © Xsens, Größe", *SHORT_HEADER), encoding="cp1252")
    assert_read(text.read())


@pytest.mark.parametrize("order", [COLUMN_MAJOR, ROW_MAJOR])
def test_matrix_is_read_by_name_not_by_place(order: tuple[str, ...]) -> None:
    sensor = mt_text(ACC, GYR, order).read()
    assert_read(sensor)
    assert_attitude(sensor)


def test_matrix_without_gyroscope() -> None:
    sensor = mt_text(ACC, COLUMN_MAJOR).read()
    assert sensor.gyr_radps is None
    assert_attitude(sensor)


def test_euler_angles() -> None:
    assert_attitude(mt_text(ACC, GYR, EULER).read())


def test_quaternion_goes_before_matrix_and_euler() -> None:
    text = mt_text(ACC, GYR, EULER, COLUMN_MAJOR, QUATERNION)
    assert_attitude(text.put(5, "Roll", "90").read())


def test_no_orientation() -> None:
    assert mt_text().read().attitude is None


@pytest.mark.parametrize("empty", ["", "NaN", "nan", "-nan(ind)", "   "])
def test_time_columns_without_numbers(empty: str) -> None:
    text = mt_text()
    for heading in ("Year", "Month", "Day", "Second", "UTC_Valid", "SampleTimeFine"):
        text = text.with_column(heading, [empty] * 60)
    assert_read(text.read())


@pytest.mark.parametrize("empty", ["", "NaN"])
def test_time_stamp_missing_now_and_then(empty: str) -> None:
    stamps = [str(1000 + 10_000 * row) if row % 7 else empty for row in range(60)]
    assert_read(mt_text().with_column("SampleTimeFine", stamps).read())


def test_time_stamp_zero_throughout() -> None:
    assert_read(mt_text().with_column("SampleTimeFine", ["0"] * 60).read())


@pytest.mark.parametrize("delimiter", [";", "\t", "|", " "])
def test_decimal_comma(delimiter: str) -> None:
    text = mt_text(ACC, GYR, QUATERNION)
    commas = [[field.replace(".", ",") for field in line] for line in text.cells]
    sensor = replace(text, cells=commas, delimiter=delimiter).read()
    assert_read(sensor)
    assert_attitude(sensor)


def test_long_header_with_device_and_no_rate() -> None:
    sensor = replace(mt_text(), comments=LONG_HEADER, name="a.txt").read()
    assert_read(sensor)
    assert sensor.device == "00B42D4B"


def test_device_from_the_file_name() -> None:
    assert replace(mt_text(), name="MT_012005D6_009-001_00B421E6.txt").read().device == "00B421E6"


def test_no_header_at_all() -> None:
    assert_read(replace(mt_text(), comments=()).read())


def test_ten_metre_set_counts_in_floats() -> None:
    text = mt_text(ACC, GYR, MAG)
    floats = [[f"{int(line[0])}.0", *line[1:]] for line in text.cells]
    sensor = replace(text, cells=floats, comments=TEN_METRE_HEADER).read()
    assert_read(sensor)
    assert sensor.mag is not None
    np.testing.assert_allclose(sensor.mag, expected(MAG), atol=1e-6)


def test_thirty_nine_columns_with_high_rate_columns_empty() -> None:
    text = mt_text(ACC, ("FreeAcc_E", "FreeAcc_N", "FreeAcc_U"), GYR, MAG, EULER, ("Pressure",))
    for heading in ("AccHR_X", "AccHR_Y", "AccHR_Z", "GyrHR_X", "GyrHR_Y", "GyrHR_Z"):
        text = text.with_column(heading, [""] * 60, at=5)
    for heading in ("VelInc_X", "VelInc_Y", "VelInc_Z", "OriInc_q0", "OriInc_q1", "OriInc_q2", "OriInc_q3"):
        text = text.with_column(heading, ["0.1"] * 60, at=9)
    sensor = text.with_column("StatusWord", ["0x1F"] * 60).read()
    assert_read(sensor)
    assert_attitude(sensor)
    assert sensor.free_acc_mps2 is not None
    assert sensor.pressure_pa is not None
    np.testing.assert_allclose(
        sensor.free_acc_mps2, expected(("FreeAcc_E", "FreeAcc_N", "FreeAcc_U")), atol=1e-6
    )
    np.testing.assert_allclose(sensor.pressure_pa, 101_325.0)


def test_free_acceleration_by_x_y_z() -> None:
    text = mt_text(ACC, GYR, ("FreeAcc_E", "FreeAcc_N", "FreeAcc_U"))
    named = replace(
        text, rename={"FreeAcc_E": "FreeAcc_X", "FreeAcc_N": "FreeAcc_Y", "FreeAcc_U": "FreeAcc_Z"}
    )
    free_acc = named.read().free_acc_mps2
    assert free_acc is not None
    np.testing.assert_allclose(free_acc, expected(("FreeAcc_E", "FreeAcc_N", "FreeAcc_U")), atol=1e-6)


def test_free_acceleration_alone_is_enough_to_read() -> None:
    sensor = mt_text(("FreeAcc_E", "FreeAcc_N", "FreeAcc_U"), QUATERNION).read()
    assert sensor.acc_mps2 is None
    assert sensor.free_acc_mps2 is not None


@pytest.mark.parametrize("unit", [" (in {})", " ({})", " [{}]"])
def test_units_inside_headings_with_semicolons_and_a_trailing_one(unit: str) -> None:
    text = mt_text(ACC, GYR, EULER).with_column("StatusWord", ["ok"] * 60).with_column("Latitude", [""] * 60)
    units = {**dict.fromkeys(ACC, "m/s2"), **dict.fromkeys(GYR, "rad/s"), **dict.fromkeys(EULER, "deg")}
    rename = {heading: heading + unit.format(name) for heading, name in units.items()}
    text = text.with_column("", [""] * 60, at=len(text.headings))
    sensor = replace(text, delimiter=";", rename=rename).read()
    assert_read(sensor)
    assert_attitude(sensor)


def test_delimiter_at_the_end_of_the_rows_only() -> None:
    text = mt_text()
    assert_read(replace(text, cells=[[*line, ""] for line in text.cells]).read())


def test_delimiter_at_the_end_of_the_headings_only() -> None:
    text = mt_text()
    assert_read(replace(text, headings=[*text.headings, ""]).read())


@pytest.mark.parametrize("tail", ["\n", "\n\n\n", "   \n", "\t\n\n"])
def test_blank_lines_at_the_end(tail: str) -> None:
    assert_read(replace(mt_text(), tail=tail).read())


def test_no_line_end_after_the_last_row() -> None:
    file = mt_text().file
    cut = replace(file, content=file.content.rstrip(b"\n"))
    assert_read(read_files({Placement.LEFT_FOOT: cut}).sensors[Placement.LEFT_FOOT])


def test_blank_lines_between_rows_do_not_shift_the_line_of_an_error() -> None:
    text = mt_text().put(30, "Acc_Y", "oops")
    lines = text.text.split("\n")
    lines.insert(text.first_line + 9, "")
    lines.insert(text.first_line + 19, "  ")
    file = replace(text.file, content="\n".join(lines).encode())
    with pytest.raises(InputError) as caught:
        read_files({Placement.LEFT_FOOT: file})
    assert (caught.value.code, caught.value.line, caught.value.column) == (
        "not_a_number",
        text.first_line + 32,
        "Acc_Y",
    )


def test_quoted_fields() -> None:
    text = mt_text()
    quoted = [[f'"{field}"' for field in line] for line in text.cells]
    assert_read(replace(text, cells=quoted, headings=[f'"{heading}"' for heading in text.headings]).read())


def test_headings_in_lower_case() -> None:
    text = mt_text(ACC, GYR, QUATERNION)
    assert_attitude(replace(text, rename={heading: heading.lower() for heading in text.headings}).read())


def test_a_comment_that_speaks_of_the_packet_counter_is_not_the_header() -> None:
    assert_read(replace(mt_text(), comments=(*SHORT_HEADER, "// PacketCounter wraps at 65535")).read())


def test_orientation_told_north_east_down_is_turned_up() -> None:
    text = mt_text(ACC, GYR, QUATERNION)
    up = text.read().attitude
    assert up is not None
    down = np.stack([up[:, 1], up[:, 0], -up[:, 3], up[:, 2]], axis=1)  # turned by π about the first axis
    cells = [
        [*line[:7], *(f"{value:.6f}" for value in quaternion)]
        for line, quaternion in zip(text.cells, down, strict=True)
    ]
    sensor = replace(text, cells=cells, comments=(*SHORT_HEADER, "// Coordinate system: NED")).read()
    assert sensor.attitude is not None
    x, y = sensor.attitude[:, 1], sensor.attitude[:, 2]
    np.testing.assert_allclose(1 - 2 * (x * x + y * y), 1.0, atol=1e-6)


def test_quaternions_of_changing_sign_become_continuous() -> None:
    text = mt_text(ACC, GYR, QUATERNION)
    signs = np.where(np.random.default_rng(3).random(60) < 0.5, -1.0, 1.0)
    signs[0] = 1.0
    cells = [
        [*line[:7], *(f"{sign * float(field):.6f}" for field in line[7:])]
        for line, sign in zip(text.cells, signs, strict=True)
    ]
    assert_attitude(replace(text, cells=cells).read())


def test_same_samples_from_all_delimiters_bit_for_bit() -> None:
    sensors = [replace(mt_text(), delimiter=delimiter).read() for delimiter in ",;\t| "]
    for sensor in sensors[1:]:
        assert sensor.acc_mps2 is not None
        assert sensors[0].acc_mps2 is not None
        assert np.array_equal(sensor.acc_mps2, sensors[0].acc_mps2)
