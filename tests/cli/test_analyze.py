"""``gaitlab analyze`` and ``doctor`` as their users call them: output, files and exit status."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitlab.cli import main
from gaitlab.result import Result
from gaitlab.simulation.mtmanager import write_mtmanager
from tests.walks import out_and_back

HEADER = "t_s,lost,rest,ax_mps2,ay_mps2,az_mps2,vx_mps,vy_mps,vz_mps,px_m,py_m,pz_m"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("walk")
    write_mtmanager(out_and_back(), path)
    return path


def test_a_folder_is_analysed_and_its_parameters_are_printed(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["analyze", str(folder), "--course", "7.62"]) == 0
    printed = capsys.readouterr()
    assert "Stride length [m]" in printed.out
    assert "Time over the course [s]" in printed.out
    assert printed.err == ""


def test_a_dash_writes_the_result_and_nothing_else_to_standard_output(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["analyze", str(folder), "--out", "-"]) == 0
    result = Result.model_validate_json(capsys.readouterr().out)
    assert set(result.sensors) == {"left_foot", "right_foot", "left_knee", "right_knee"}


def test_result_series_and_reports_are_written(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "result.json"
    reports = [tmp_path / "r.html", tmp_path / "r.pdf"]
    options = ["--out", str(out), "--series", str(tmp_path / "series")]
    options += [word for path in reports for word in ("--report", str(path))]
    assert main(["analyze", str(folder), *options]) == 0
    assert json.loads(out.read_text())["schema"] == "gaitlab.result/1"
    for placement in ("left_foot", "right_foot", "left_knee", "right_knee"):
        assert (tmp_path / "series" / f"{placement}.csv").read_text().splitlines()[0] == HEADER
    assert reports[0].read_text().lower().lstrip().startswith("<!doctype html>")
    assert reports[1].read_bytes().startswith(b"%PDF-")


def test_files_named_by_option_take_that_place(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = json.loads((folder / "placement.json").read_text())
    foot = str(folder / names["left_foot"])
    assert main(["analyze", "--left-foot", foot, "--out", "-"]) == 0
    assert set(json.loads(capsys.readouterr().out)["sensors"]) == {"left_foot"}


@pytest.mark.parametrize(
    "content",
    [b"", b"\x00\x01\x02\xff" * 200, b"a,b\n1,2\n", b"PacketCounter\tAcc_X\n1\tx\n"],
    ids=["empty", "binary", "wrong columns", "text in a number"],
)
def test_a_wrong_file_is_one_message_on_standard_error_and_exit_1(
    content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "walk_lf.txt"
    bad.write_bytes(content)
    out = tmp_path / "result.json"
    assert main(["analyze", "--left-foot", str(bad), "--out", str(out)]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith("gaitlab: walk_lf.txt")
    assert printed.err.count("\n") == 1
    assert "Traceback" not in printed.err
    assert not out.exists()


def test_wrong_usage_is_exit_2(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (
        ["analyze"],
        ["analyze", str(folder), "--method", "x"],
        ["analyze", str(folder), "--rate", "-1"],
        [],
    ):
        with pytest.raises(SystemExit) as stopped:
            main(words)
        assert stopped.value.code == 2
    assert "usage:" in capsys.readouterr().err


def test_a_place_that_cannot_be_written_is_said(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert main(["analyze", str(folder), "--out", str(tmp_path / "file" / "result.json")]) == 1
    assert "cannot be written" in capsys.readouterr().err


def test_the_doctor_tells_what_a_file_is_and_fails_for_one_that_is_none(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = folder / json.loads((folder / "placement.json").read_text())["right_foot"]
    assert main(["doctor", str(file)]) == 0
    assert "100" in capsys.readouterr().out
    bad = tmp_path / "bad.txt"
    bad.write_bytes(b"\x00" * 50)
    assert main(["doctor", str(file), str(bad), "--json"]) == 1
    reports = json.loads(capsys.readouterr().out)
    assert reports[0]["problem"] is None
    assert reports[1]["problem"]["code"]


def test_every_trial_of_the_real_walks_is_exit_0(data_dir: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in sorted((data_dir / "mtw-10m-walk").glob("*-1.json")):
        feet = [str(path.with_name(f"{path.stem}_{suffix}.txt")) for suffix in ("lf", "rf")]
        assert main(["analyze", *feet, "--out", "-"]) == 0, path.stem
        assert json.loads(capsys.readouterr().out)["feet"]["left"]["distance_m"] > 15


def test_one_path_for_two_outputs_is_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "r.html")
    assert main(["analyze", str(folder), "--out", out, "--report", out]) == 1
    assert "two outputs" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_demo_that_cannot_be_written_is_a_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert main(["demo", "--dir", str(tmp_path / "file")]) == 1
    printed = capsys.readouterr()
    assert "cannot be written" in printed.err
    assert printed.err.count("\n") == 1
