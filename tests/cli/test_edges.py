"""The command line at its edges: no argument may end in a traceback, and no output may be lost in silence."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from gaitlab.cli import main
from tests.recording.texts import ACC, GYR, mt_text


def failure(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(words) == 1
    printed = capsys.readouterr()
    assert printed.err.startswith("gaitlab: ")
    assert printed.err.count("\n") == 1
    return printed.err


@pytest.mark.parametrize("command", ["analyze", "doctor"])
def test_a_path_that_is_too_long_or_a_pipe_is_a_message(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "cannot be read" in failure([command, "x" * 5000], capsys)
    os.mkfifo(tmp_path / "pipe")
    assert "not a file" in failure([command, str(tmp_path / "pipe")], capsys)


def test_a_missing_file_is_named_as_it_was_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    missing = str(tmp_path / "walks" / "1" / "lf.txt")
    assert missing in failure(["analyze", missing], capsys)
    assert missing in failure(["analyze", "--left-foot", missing], capsys)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["analyze", ""], "the path is empty"),
        (["analyze", "--left-foot", ""], "the path is empty"),
        (["analyze", "x", "--out", ""], "the path is empty"),
        (["analyze", "x", "--series", ""], "the path is empty"),
        (["doctor", ""], "the path is empty"),
        (["demo", "--dir", ""], "the path is empty"),
        (["analyze", "x", "--rate", "abc"], "abc is not a number above zero"),
        (["demo", "--port", "abc"], "abc is not a port"),
        (["serve", "--port", "9" * 5000], "is not a port"),
        (["token", "add", "a@b.c", "--name", "x", "--days", "abc"], "abc is not a number of days"),
    ],
)
def test_wrong_usage_is_said_in_plain_words(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(words)
    assert stopped.value.code == 2
    assert said in capsys.readouterr().err


def test_the_doctor_looks_into_zips_and_folders(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    walk = mt_text(ACC, GYR, n=200).file
    folder = tmp_path / "walk"
    folder.mkdir()
    (folder / "a_lf.txt").write_bytes(walk.content)
    (folder / "placement.json").write_text('{"left_foot": "a_lf.txt"}')
    with zipfile.ZipFile(tmp_path / "walk.zip", "w") as packed:
        packed.write(folder / "a_lf.txt", "walk/a_lf.txt")
        packed.write(folder / "placement.json", "walk/placement.json")
    assert main(["doctor", str(folder), str(tmp_path / "walk.zip"), "--json"]) == 0
    assert [report["name"] for report in json.loads(capsys.readouterr().out)] == ["a_lf.txt", "walk/a_lf.txt"]
    (tmp_path / "broken.zip").write_bytes(b"PK\x03\x04")
    assert main(["doctor", str(folder), str(tmp_path / "broken.zip"), "--json"]) == 1
    reports = json.loads(capsys.readouterr().out)
    assert [report["problem"] and report["problem"]["code"] for report in reports] == [None, "zip_broken"]


def test_an_empty_folder_and_an_empty_zip_are_said_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "none").mkdir()
    assert str(tmp_path / "none") in failure(["doctor", str(tmp_path / "none")], capsys)
    with zipfile.ZipFile(tmp_path / "none.zip", "w"):
        pass
    assert "none.zip" in failure(["analyze", str(tmp_path / "none.zip")], capsys)


@pytest.mark.parametrize(
    "words", [["--help"], ["doctor", "walk_lf.txt"], ["doctor", "walk_lf.txt", "--json"]]
)
def test_a_reader_that_stops_reading_causes_no_traceback(words: list[str], tmp_path: Path) -> None:
    (tmp_path / "walk_lf.txt").write_bytes(mt_text(ACC, GYR, n=200).file.content)
    reading, writing = os.pipe()
    os.close(reading)
    try:
        run = subprocess.run(
            [sys.executable, "-m", "gaitlab.cli", *words],
            stdout=writing, stderr=subprocess.PIPE, cwd=tmp_path, check=False,
        )  # fmt: skip
    finally:
        os.close(writing)
    assert run.stderr == b""
    assert run.returncode in (0, 1)


def test_an_output_that_is_full_is_one_message(tmp_path: Path) -> None:
    (tmp_path / "walk_lf.txt").write_bytes(mt_text(ACC, GYR, n=200).file.content)
    resource = pytest.importorskip("resource")
    with (tmp_path / "out").open("wb") as out:
        run = subprocess.run(
            [sys.executable, "-m", "gaitlab.cli", "doctor", "walk_lf.txt"],
            stdout=out, stderr=subprocess.PIPE, cwd=tmp_path, check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16)),
        )  # fmt: skip
    assert run.returncode == 1
    assert run.stderr.startswith(b"gaitlab: standard output cannot be used")
    assert run.stderr.count(b"\n") == 1


def test_a_result_for_a_closed_standard_output_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["analyze", str(tmp_path), "--out", "-"]) == 1
    assert "Standard output is closed" in capsys.readouterr().err
