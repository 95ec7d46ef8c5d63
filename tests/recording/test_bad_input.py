"""Each wrong file gets one clear message with its place, and no file gets a traceback."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording import InputFile, Placement, read_files
from gaitlab.recording import mtmanager as reader
from gaitlab.recording.file import Limits
from tests.recording.texts import ACC, EULER, GYR, MAG, MATRIX, QUATERNION, Text, mt_text

TEXT = mt_text()


def refusal(file: InputFile | Text) -> InputError:
    """The error a file gets; it must name the file and be a sentence with a hint."""
    given = file.file if isinstance(file, Text) else file
    with pytest.raises(InputError) as caught:
        read_files({Placement.LEFT_FOOT: given})
    error = caught.value
    assert error.file == given.name
    assert error.message.rstrip().endswith((".", "?"))
    assert error.hint
    return error


def place(error: InputError) -> tuple[str, int | None, str | None]:
    return error.code, error.line, error.column


@pytest.mark.parametrize("content", [b"", b"\n\n", b"   \r\n\t", b"\xef\xbb\xbf", b"\xff\xfe"])
def test_empty_file(content: bytes) -> None:
    assert refusal(InputFile("a.txt", content)).code == "empty_file"


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"\xfa\xff\x36" + bytes(range(256)) * 10, "mtb"),
        (b"%PDF-1.7\n" + bytes(range(256)), "PDF"),
        (b"PK\x03\x04" + bytes(100), "zip"),
        (b"\x1f\x8b\x08" + bytes(100), "gzip"),
        (bytes(range(256)) * 4, "binary"),
        (np.random.default_rng(0).bytes(5000), "binary"),
        (b"PacketCounter\tAcc_X\n1\t\x00\n", "binary"),
    ],
)
def test_binary_file_is_named_for_what_it_is(content: bytes, kind: str) -> None:
    error = refusal(InputFile("a.txt", content))
    assert error.code == "binary_file"
    assert kind in error.message


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        ("Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s)\n0,1,2\n", "x-io"),
        ("sensor,left_sensor,right_sensor\naxis,acc_x,acc_x\n0,1,2\n", "gaitmap"),
        (",left_sensor,left_sensor\n,acc_x,acc_y\n0.0,1,2\n", "gaitmap"),
        ('<?xml version="1.0"?>\n<mvnx version="4">', "MVNX"),
        ('{"Subject": 1}', "JSON"),
        ("<html><body>not found</body></html>", "HTML"),
        ("Dear colleague,\nplease find attached\n", "not an MT Manager export"),
    ],
)
def test_text_of_another_family(content: str, kind: str) -> None:
    error = refusal(InputFile("a.csv", content.encode()))
    assert error.code == "not_mt_manager"
    assert kind in error.message


def test_movella_dot_is_recognised_and_refused() -> None:
    content = (
        "sep=,\nDeviceTag:,Yao\nFirmwareVersion:,2.0.0\nOutputRate:,60Hz\n© Xsens Technologies B. V. 2005-2021\n\n"
        "PacketCounter,SampleTimeFine,Quat_W,Quat_X,Quat_Y,Quat_Z,FreeAcc_X,FreeAcc_Y,FreeAcc_Z,Status\n"
        "1,3343427885,1,0,0,0,0,0,0,0\n"
    )
    error = refusal(InputFile("dot.csv", content.encode()))
    assert (error.code, error.line) == ("movella_dot", 7)


def test_packet_counter_missing_names_the_line_of_the_headings() -> None:
    assert place(refusal(TEXT.without("PacketCounter"))) == ("missing_columns", 6, "PacketCounter")


@pytest.mark.parametrize(
    ("text", "missing"),
    [
        (TEXT.without("Acc_Y"), ["Acc_Y"]),
        (TEXT.without("Gyr_X", "Gyr_Z"), ["Gyr_X", "Gyr_Z"]),
        (TEXT.without(*GYR), ["Gyr_X", "Gyr_Y", "Gyr_Z"]),
        (TEXT.without(*ACC), ["Acc_X", "Acc_Y", "Acc_Z"]),
        (mt_text(MAG), ["Acc_X", "Acc_Y", "Acc_Z", "Gyr_X", "Gyr_Y", "Gyr_Z"]),
    ],
)
def test_wrong_columns_says_which_are_missing(text: Text, missing: list[str]) -> None:
    error = refusal(text)
    assert place(error) == ("missing_columns", 6, missing[0])
    assert ", ".join(missing) in error.message


def test_heading_twice() -> None:
    text = TEXT.with_column("Acc_X", ["1.0"] * 60, at=4)
    assert place(refusal(text)) == ("duplicate_column", 6, "Acc_X")


def test_headings_without_rows() -> None:
    assert place(refusal(TEXT.keep_rows([]))) == ("no_rows", 6, None)
    assert place(refusal(replace(TEXT.keep_rows([]), tail="\n  \n"))) == ("no_rows", 6, None)


@pytest.mark.parametrize("heading", ["Acc_X", "Gyr_Z", "PacketCounter"])
@pytest.mark.parametrize(
    "value", ["abc", "1.2.3", "--1", "1e", "0x10", "1 2", "=1+1", "1_000", "−1.5", "True", "12:30"]
)
@pytest.mark.parametrize("row", [0, 33, 59])
def test_text_in_a_number(row: int, value: str, heading: str) -> None:
    error = refusal(TEXT.put(row, heading, value))
    assert place(error) == ("not_a_number", TEXT.first_line + row, heading)
    assert value in error.message


def test_text_in_a_number_of_a_file_with_losses_blank_lines_and_windows_line_ends() -> None:
    text = replace(TEXT.keep_rows([*range(10), *range(14, 60)]).put(40, "Acc_Z", "?"), line_end="\r\n")
    assert place(refusal(text)) == ("not_a_number", TEXT.first_line + 40, "Acc_Z")


def test_decimal_comma_in_one_field_of_a_file_with_points() -> None:
    assert place(refusal(TEXT.put(20, "Acc_X", "1,5"))) == ("not_a_number", TEXT.first_line + 20, "Acc_X")


def test_bytes_that_are_no_text_in_a_number() -> None:
    file = TEXT.put(12, "Gyr_Y", "1.5§").file
    damaged = replace(file, content=file.content.replace("§".encode(), b"\xff\xfe"))
    assert place(refusal(damaged)) == ("not_a_number", TEXT.first_line + 12, "Gyr_Y")


@pytest.mark.parametrize("row", [0, 1, 30, 59])
@pytest.mark.parametrize("surplus", [-3, -1, 1, 2])
def test_wrong_number_of_fields(row: int, surplus: int) -> None:
    cells = [list(line) for line in TEXT.cells]
    cells[row] = cells[row][:surplus] if surplus < 0 else [*cells[row], *["1.0"] * surplus]
    error = refusal(replace(TEXT, cells=cells))
    assert place(error) == ("wrong_field_count", TEXT.first_line + row, None)


def test_one_field_too_few_and_one_too_many_do_not_cancel() -> None:
    cells = [list(line) for line in TEXT.cells]
    cells[10] = cells[10][:-1]
    cells[11] = [*cells[11], "1.0"]
    assert place(refusal(replace(TEXT, cells=cells))) == ("wrong_field_count", TEXT.first_line + 10, None)


def test_file_cut_off_in_the_middle_of_a_row() -> None:
    file = TEXT.file
    cut = replace(file, content=file.content[: file.content.rindex(b"\t")])
    assert place(refusal(cut)) == ("wrong_field_count", TEXT.first_line + 59, None)


@pytest.mark.parametrize("value", ["inf", "-Inf", "Infinity", "1e999"])
def test_infinity(value: str) -> None:
    assert place(refusal(TEXT.put(17, "Gyr_X", value))) == ("infinite", TEXT.first_line + 17, "Gyr_X")


@pytest.mark.parametrize("value", ["", "NaN"])
def test_column_without_numbers(value: str) -> None:
    text = TEXT
    for row in range(60):
        text = text.put(row, "Gyr_Y", value)
    assert place(refusal(text)) == ("empty_column", TEXT.first_line, "Gyr_Y")


def test_too_many_rows_without_numbers_names_the_first() -> None:
    text = TEXT
    for row in range(20, 27):
        text = text.put(row, "Acc_Z", "NaN")
    assert place(refusal(text)) == ("too_many_nan", TEXT.first_line + 20, "Acc_Z")


@pytest.mark.parametrize("value", ["500.5", "", "NaN", "-3", "1e300"])
def test_counter_that_is_no_whole_number(value: str) -> None:
    assert place(refusal(TEXT.put(8, "PacketCounter", value))) == (
        "counter_not_integer",
        TEXT.first_line + 8,
        "PacketCounter",
    )


def test_counter_twice() -> None:
    text = TEXT.put(9, "PacketCounter", TEXT.cells[8][0])
    assert place(refusal(text)) == ("counter_twice", TEXT.first_line + 9, "PacketCounter")


def test_counter_jumping_back() -> None:
    text = TEXT.keep_rows([*range(30), *range(20, 60)])
    assert place(refusal(text)) == ("counter_backward", TEXT.first_line + 30, "PacketCounter")


def test_counter_jumping_ahead_by_more_than_half_a_wrap() -> None:
    text = TEXT.put(59, "PacketCounter", "60000")
    assert place(refusal(text)) == ("counter_jump", TEXT.first_line + 59, "PacketCounter")


def test_counter_of_a_size_that_would_fill_the_memory() -> None:
    error = refusal(TEXT.put(59, "PacketCounter", "9000000000"))
    assert isinstance(error, TooLarge)
    assert error.code == "too_many_rows"


def test_a_few_rows_do_not_claim_millions_of_packets() -> None:
    text = TEXT
    for row in range(60):
        text = text.put(row, "PacketCounter", str(row * 30_000 % 65_536))
    assert refusal(text).code == "too_lossy"


@pytest.mark.parametrize("with_orientation", [False, True])
def test_gyroscope_in_degrees(with_orientation: bool) -> None:
    groups = (ACC, GYR, QUATERNION) if with_orientation else (ACC, GYR)
    error = refusal(mt_text(*groups, scale=dict.fromkeys(GYR, 57.29578)))
    assert place(error) == ("unit_gyr", 6, "Gyr_X")
    assert "deg/s" in error.message
    assert "rad/s" in error.hint


def test_slow_movement_in_degrees_is_betrayed_by_the_orientation() -> None:
    text = mt_text(ACC, GYR, QUATERNION, n=200)
    slow = replace(text, comments=("// Update Rate: 20.0Hz",))  # the same turns in five times the time
    gyr = [[*line[:4], *(f"{float(field) / 5:.6f}" for field in line[4:7]), *line[7:]] for line in text.cells]
    right = replace(slow, cells=gyr).read().gyr_radps
    assert right is not None
    assert np.abs(right).max() < 1
    degrees = [
        [*line[:4], *(f"{float(field) * 57.29578:.6f}" for field in line[4:7]), *line[7:]] for line in gyr
    ]
    error = refusal(replace(slow, cells=degrees))
    assert place(error) == ("unit_gyr", 2, "Gyr_X")
    assert "orientation" in error.message


def test_accelerometer_in_g() -> None:
    error = refusal(mt_text(scale=dict.fromkeys(ACC, 1 / 9.81)))
    assert place(error) == ("unit_acc", 6, "Acc_X")
    assert "like g" in error.message


def test_accelerometer_without_gravity() -> None:
    error = refusal(mt_text(scale={"Acc_Z": 0.01}))
    assert error.code == "unit_acc"
    assert "Gravity" in error.message


@pytest.mark.parametrize(
    ("heading", "unit", "code"),
    [("Gyr_Y", "deg/s", "unit_gyr"), ("Acc_X", "g", "unit_acc"), ("Roll", "rad", "unit_orientation")],
)
def test_heading_that_states_another_unit(heading: str, unit: str, code: str) -> None:
    name = f"{heading} ({unit})"
    text = replace(mt_text(ACC, GYR, EULER), rename={heading: name})
    assert place(refusal(text)) == (code, 6, name)


@pytest.mark.parametrize(("heading", "value"), [("Acc_Y", "3000"), ("Gyr_X", "-77.5")])
def test_single_value_beyond_the_sensor(heading: str, value: str) -> None:
    text = mt_text(n=400).put(300, heading, value)
    assert place(refusal(text)) == ("out_of_range", text.first_line + 300, heading)


@pytest.mark.parametrize(
    ("group", "heading", "value"),
    [
        (QUATERNION, "Quat_q0", "0.2"),
        (MATRIX, "Mat[3][3]", "-1.0"),
        (MATRIX, "Mat[2][1]", "0.9"),
        (EULER, "Yaw", "1000"),
    ],
)
def test_orientation_that_is_none(group: tuple[str, ...], heading: str, value: str) -> None:
    text = mt_text(ACC, GYR, group).put(25, heading, value)
    assert place(refusal(text)) == ("bad_orientation", text.first_line + 25, group[0])


def test_line_column_and_row_limits() -> None:
    limits = Limits(rows=50, columns=5, line_bytes=80)
    for text, tight, code in (
        (TEXT, replace(limits, columns=64, line_bytes=1000), "too_many_rows"),
        (TEXT, replace(limits, rows=100, line_bytes=1000), "too_many_columns"),
        (TEXT.put(3, "Acc_X", "1." + "0" * 100), replace(limits, columns=64), "line_too_long"),
    ):
        with pytest.raises(TooLarge) as caught:
            reader.read(text.file, tight)
        assert caught.value.code == code
        assert caught.value.file == text.name


def test_endless_line_is_refused_with_its_number() -> None:
    file = TEXT.file
    with pytest.raises(TooLarge) as caught:
        reader.read(replace(file, content=file.content + b"1" * 20_000 + b"\n"))
    assert (caught.value.code, caught.value.line) == ("line_too_long", TEXT.first_line + 60)


def test_name_with_markup_and_control_characters_stays_a_harmless_label() -> None:
    error = refusal(InputFile("<b>x</b>\r\nSet-Cookie: a\u202e.txt", b""))
    assert error.file is not None
    assert "\n" not in error.file
    assert "\r" not in error.file
    assert "\u202e" not in error.file
    assert "<b>" in error.file  # what shows it escapes it; a label is not changed silently


def test_one_sample_is_read() -> None:
    assert TEXT.keep_rows([0]).read().n_samples == 1
