"""The table as text and as JSON: every character of it is what the README shows."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitlab.cli import main
from gaitlab.cli.parser import VALIDATION_SETS
from gaitlab.validation import SETS, to_json, to_text
from gaitlab.validation.model import Column, Details, Figure, Goal, Problem, Row, Table
from tests.validation import folders

NAN = float("nan")
MEAN, SD, MAE = (
    Figure("mean", -0.004, "cm", 2, signed=True),
    Figure("SD", 1.304, "cm", 2),
    Figure("MAE", 0.8004, "cm", 2),
)
TABLE = Table(
    "leg",
    "here",
    1,
    (
        Row(
            "length",
            "stride length",
            (MAE, MEAN, SD),
            7,
            "strides",
            1,
            (Goal("MAE", high=0.8), Goal("SD", high=1.4)),
        ),
        Row(
            "covered", "covered", (Figure("share", 93.0, "%", 1),), 1, "strides", 8, (Goal("share", 90, 99),)
        ),
        Row("unknown", "  unknown", (Figure("gap", NAN, "m", 3),), 0, "strides", 12, (Goal("gap", low=97),)),
        Row("aside", "aside", (Figure("count", 3.0, "", 0),), 3, "rests"),
    ),
    (Details("strides", (Column("side"), Column("error", "cm", 2)), (("left", -0.001), ("right", None))),),
    (Problem("one", "It is broken."),),
)
TEXT = """\
leg: 1 recording in here

 #  what           ours                                  n  to reach                   reached
 1  stride length  MAE 0.80 cm, +0.00 ± 1.30 cm  7 strides  MAE ≤ 0.8 cm, SD ≤ 1.4 cm  no
 8  covered        share 93.0 %                   1 stride  share 90–99 %              yes
12    unknown      gap – m                       0 strides  gap ≥ 97 m                 no
    aside          count 3                         3 rests
! one: It is broken.
"""
TRIALS = """
leg, strides

side   error [cm]
left         0.00
right           –
"""


def test_the_text_has_fixed_decimals_and_says_what_was_reached() -> None:
    assert to_text([TABLE]) == TEXT
    assert to_text([TABLE], trials=True) == TEXT + TRIALS


def test_a_goal_is_held_against_the_figure_itself_and_not_its_rounding() -> None:
    assert TABLE.row("length").reached is False  # 0.8004 cm prints as 0.80


def test_json_says_the_same_with_null_for_what_is_not_determined() -> None:
    document = json.loads(to_json([TABLE], trials=True))
    assert document["schema"] == "gaitlab.validation/1"
    (leg,) = document["sets"]
    length, covered, unknown, aside = leg["rows"]
    assert length["figures"]["MAE"] == {"value": 0.8004, "unit": "cm"}
    assert length["to_reach"] == {"MAE": {"low": None, "high": 0.8}, "SD": {"low": None, "high": 1.4}}
    assert (covered["target"], covered["reached"], covered["n"]) == (8, True, 1)
    assert unknown["figures"]["gap"]["value"] is None
    assert aside["reached"] is None
    assert leg["trials"] == {
        "strides": [{"side": "left", "error [cm]": -0.001}, {"side": "right", "error [cm]": None}]
    }
    assert leg["problems"] == [{"recording": "one", "reason": "It is broken."}]
    assert "trials" not in json.loads(to_json([TABLE]))["sets"][0]


def test_the_command_line_offers_the_sets_that_exist() -> None:
    assert (*SETS, "all", "coverage", "methods") == VALIDATION_SETS


def test_the_command_prints_a_table_or_json_and_writes_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(folders.loop(tmp_path / "loop"))
    assert main(["validate", "foot-loop", folder, "--trials"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("foot-loop: 1 recording in loop\n")
    assert "closing error of the loop" in text
    assert "foot-loop, loops" in text
    assert main(["validate", "all", str(tmp_path), "--json"]) == 0
    printed = capsys.readouterr().out
    assert json.loads(printed)["sets"][0]["set"] == "foot-loop"
    out = tmp_path / "figures.json"
    assert main(["validate", "foot-loop", folder, "--json", str(out)]) == 0
    assert json.loads(out.read_text()) == json.loads(printed)
    assert capsys.readouterr().out.endswith(f"wrote {out}\n")


def test_the_command_refuses_a_wrong_folder_and_overwrites_no_recording(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["validate", "leg-vicon", str(folders.loop(tmp_path / "loop"))]) == 1
    assert "vicon-left-leg.csv" in capsys.readouterr().err
    recording = tmp_path / "loop" / "loop.csv"
    before = recording.read_bytes()
    assert main(["validate", "foot-loop", str(tmp_path / "loop"), "--json", str(recording)]) == 1
    assert recording.read_bytes() == before
    with pytest.raises(SystemExit) as caught:
        main(["validate", "nothing", str(tmp_path)])
    assert caught.value.code == 2
