"""``gaitlab compare`` as its users call it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitlab.cli import main
from gaitlab.simulation.mtmanager import write_mtmanager
from tests.walks import out_and_back


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("walk")
    write_mtmanager(out_and_back(), path)
    return path


def test_every_question_is_printed_with_what_is_missing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", str(folder), "--known-length", "20.7", "--height", "1.8", "--sex", "f"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    for word in ("rest detection", "jimenez2009_zupt", "Missing: sensor on the thigh.", "walk of 20.7 m"):
        assert word in printed.out


def test_json_holds_the_methods_asked_for_and_ours(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(folder), "--methods", "weinberg, feliz2009_gyroscope", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["schema"] == "gaitlab.comparison/1"
    names = {key: [one["method"] for one in found] for key, found in document["questions"].items()}
    assert names == {"step length": ["gaitlab", "weinberg"], "heading": ["gaitlab", "feliz2009_gyroscope"]}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--methods", "nothing"], "There is no method 'nothing'"),
        (["--methods", " , "], "--methods names none"),
        (["--known-length", "1e9"], "known length"),
        (["--height", "175"], "height"),
    ],
)
def test_what_cannot_be_used_is_one_message_and_status_1(
    folder: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:
    assert main(["compare", str(folder), *options]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert said in printed.err


@pytest.mark.parametrize(
    "options", [[], ["x", "--cohort"], ["x", "--cohort", "--known-length", "5", "--methods", "kim"]]
)
def test_wrong_usage_is_status_2(options: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["compare", *options])
    assert ended.value.code == 2


def test_a_cohort_of_recordings_is_laid_beside_the_known_length(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["compare", str(folder), str(folder), str(tmp_path), "--known-length", "20.7", "--cohort"]
    assert main(arguments) == 0
    text = capsys.readouterr().out
    assert "3 recordings of 20.7 m" in text
    assert f"! {tmp_path.name}: " in text
    assert main([*arguments, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["methods"]
    ours = next(r for r in rows if (r["question"], r["method"]) == ("position", "gaitlab"))
    assert ours["n"] == 4
    assert abs(ours["error_percent"]) < 2.0
