"""The doctor says what a file is, and what each finding means for the result."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from gaitlab.errors import InputError
from gaitlab.recording import InputFile
from gaitlab.recording.doctor import FileReport, describe, examine, to_dict
from tests.recording.texts import ACC, GYR, LONG_HEADER, QUATERNION, mt_text


def test_healthy_file() -> None:
    report = examine(mt_text(ACC, GYR, QUATERNION).file)
    assert report.problem is None
    assert report.clock is not None
    assert report.losses is not None
    assert (report.clock.rate_hz, report.clock.rate_origin) == (100.0, "header")
    assert (report.clock.first_packet, report.clock.last_packet, report.clock.n_wraps) == (472, 531, 0)
    assert (report.n_samples, report.losses.n_lost, report.n_saturated) == (60, 0, 0)
    assert {quantity.name for quantity in report.quantities if quantity.present} == {
        "accelerometer",
        "gyroscope",
        "orientation",
    }
    assert all(quantity.meaning for quantity in report.quantities if not quantity.present)
    text = describe(report)
    assert "100 Hz, from the header" in text
    assert "quaternions" in text
    assert "none lost" in text


def test_gaps_wrap_and_saturation() -> None:
    text = (
        mt_text(n=200, first_packet=65_500)
        .put(120, "Acc_Z", "159.9")
        .keep_rows([*range(50), *range(58, 150), *range(151, 200)])
    )
    report = examine(text.file)
    assert report.clock is not None
    assert report.losses is not None
    assert report.clock.n_wraps == 1
    assert [(gap.start_packet, gap.n_lost) for gap in report.losses.gaps] == [(65_550, 8), (65_650, 1)]
    assert report.losses.longest_s == pytest.approx(0.08)
    assert report.losses.share == pytest.approx(9 / 200)
    assert report.n_saturated == 1
    text_out = describe(report)
    assert "65550 (8), 65650 (1)" in text_out
    assert "wrapped" in text_out
    assert "less certain" in text_out


def test_assumed_and_given_rate_are_said() -> None:
    file = replace(mt_text(), comments=LONG_HEADER).file
    assumed = describe(examine(file))
    assert "ASSUMED" in assumed
    assert "00B42D4B" in assumed
    given = examine(file, rate_hz=60.0)
    assert given.clock is not None
    assert (given.clock.rate_hz, given.clock.rate_origin) == (60.0, "user")


def test_wrong_file_gets_its_reason_instead_of_an_exception() -> None:
    report = examine(mt_text().put(7, "Acc_X", "oops").file)
    assert report.problem is not None
    assert (report.problem.code, report.problem.line, report.problem.column) == ("not_a_number", 14, "Acc_X")
    text = describe(report)
    assert "Cannot be used: “oops” is not a number." in text
    assert "line 14, column Acc_X" in text
    assert "What to do:" in text


@pytest.mark.parametrize("content", [b"", b"\x00\x01\x02", b"PK\x03\x04", b"hello"])
def test_any_content_is_diagnosed(content: bytes) -> None:
    assert examine(InputFile("x", content)).problem is not None


def test_impossible_rate_is_the_callers_mistake() -> None:
    with pytest.raises(InputError):
        examine(mt_text().file, rate_hz=-1)


def test_report_is_plain_data() -> None:
    for file in (mt_text(ACC, GYR, QUATERNION).keep_rows([0, 1, 5, 6]).file, InputFile("x", b"")):
        data = json.loads(json.dumps(to_dict(examine(file))))
        assert data["name"] == file.name
        assert data["sha256"] == file.sha256


def test_every_public_recording_is_described(data_dir: Path) -> None:
    for path in sorted(data_dir.rglob("*")):
        if path.suffix in {".txt", ".csv", ".json"}:
            report = examine(InputFile(path.name, path.read_bytes()))
            sensor = path.suffix == ".txt"
            assert (report.problem is None) is sensor, path.name
            assert len(describe(report).splitlines()) >= 3


def test_a_file_that_tells_nothing_of_a_walk_is_readable_but_said_so() -> None:
    short = examine(mt_text(n=60).file)
    assert "too_short" in codes(short)
    stuck = mt_text(ACC, GYR, n=400)
    for row in range(100, 251):
        for heading in (*ACC, *GYR):
            stuck = stuck.put(row, heading, "9.81" if heading == "Acc_Z" else "0.125")
    found = examine(stuck.file)
    assert codes(found) == {"sensor_stuck"}
    assert "for 1.5 s from 1.0 s" in describe(found)
    still = mt_text(ACC, GYR, n=400)
    for row in range(400):
        for heading in GYR:
            still = still.put(row, heading, "0.0")
    assert codes(examine(still.file)) == {"gyr_zero"}
    assert codes(examine(mt_text(ACC, GYR, n=400).file)) == set()


def codes(report: FileReport) -> set[str]:
    assert report.problem is None
    return {finding.code for finding in report.findings}


def test_an_impossible_rate_in_the_header_is_said() -> None:
    report = examine(replace(mt_text(n=200), comments=("Acquisition frequency: 0 Hz",)).file)
    assert "rate is 0 Hz" in describe(report)
    assert report.clock is not None
    assert report.clock.rate_origin == "assumed"


def test_one_gap_is_one_gap() -> None:
    text = describe(examine(mt_text(n=200).keep_rows([*range(50), *range(60, 200)]).file))
    assert "in 1 gap, the longest" in text
    assert "1 gaps" not in text
