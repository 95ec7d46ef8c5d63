"""``gaitlab methods``."""

from __future__ import annotations

import json

import pytest

from gaitlab.cli import main
from gaitlab.methods.catalogue import catalogue


def test_the_list_names_every_method_with_its_reference(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for method in catalogue().values():
        row = next(line for line in lines if line.split()[:1] == [method.name] and method.title in line)
        assert method.reference in row
        assert all(need in row for need in method.needs)
    assert {method.question.value for method in catalogue().values()} <= set(lines)


def test_a_method_is_shown_with_its_constants_and_deviations(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods", "jimenez2009_acceleration"]) == 0
    printed = capsys.readouterr().out
    assert "swing_mps2 = 2 m/s²  (Jiménez et al. 2009, §III.C step 3: T1)" in printed
    assert "as printed" in printed


def test_a_name_with_several_answers_shows_them_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods", "ikizoglu2018"]) == 0
    printed = capsys.readouterr().out
    assert all(f"ikizoglu2018: {question}" in printed for question in ("rest detection", "position", "knee"))


def test_json_holds_everything(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods", "--json"]) == 0
    methods = json.loads(capsys.readouterr().out)["methods"]
    assert len(methods) == len(catalogue())
    acceleration = next(one for one in methods if one["name"] == "jimenez2009_acceleration")
    assert acceleration["constants"][1] == {
        "name": "swing_mps2",
        "value": 2.0,
        "unit": "m/s²",
        "source": "Jiménez et al. 2009, §III.C step 3: T1",
    }
    assert main(["methods", "feliz2009", "--json"]) == 0
    assert {one["question"] for one in json.loads(capsys.readouterr().out)["methods"]} == {
        "rest detection",
        "position",
    }


def test_an_unknown_name_is_a_message(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods", "dead_reckoning"]) == 1
    printed = capsys.readouterr()
    assert "no method 'dead_reckoning'" in printed.err
    assert "jimenez2009_zupt" in printed.err
