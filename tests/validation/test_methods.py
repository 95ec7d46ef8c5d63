"""Every method laid beside its paper's figures: simulated sets with exact truth, and the public ones."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from gaitlab.cli import main
from gaitlab.errors import InputError
from gaitlab.methods.catalogue import of
from gaitlab.methods.model import Question, Track
from gaitlab.recording.model import Side
from gaitlab.validation.methods import methods_tables
from gaitlab.validation.methods_feet import steps_in, steps_table
from gaitlab.validation.methods_model import PaperTable, tables_json, tables_markdown, tables_text
from gaitlab.validation.methods_walks import LabelledFoot, labelled_feet, trial_part
from gaitlab.validation.model import Column, Problem
from gaitlab.validation.ten_metres_trials import Labels
from tests.validation import folders

SWINGS = np.array([[1.0, 1.4], [2.0, 2.4], [3.0, 3.4], [9.0, 9.4]])
LABELS = Labels({Side.LEFT: SWINGS}, (1.0, 3.5), (np.nan, np.nan))


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two people's trials, a leg, shoes and a loop, all of one simulated walk."""
    home = tmp_path_factory.mktemp("sets")
    folders.ten_metres(home / "ten", "1-1", "2-1")
    folders.leg(home / "leg")
    folders.shoes(home / "shoes")
    folders.loop(home / "loop")
    (home / "ten" / "3-1_lf.txt").write_text("nothing of use\n")
    (home / "ten" / "3-1.json").write_text("{}")
    return home


@cache
def tables(home: Path) -> tuple[dict[str, PaperTable], list[Problem]]:
    found, problems = methods_tables(home)
    return {table.key: table for table in found}, problems


def numbers(table: PaperTable, name: str, column: str) -> float:
    value = table.cell(name, column)
    assert isinstance(value, (int, float))
    return float(value)


def test_each_method_has_its_row_and_what_is_broken_is_said(simulated: Path) -> None:
    found, problems = tables(simulated)
    assert list(found) == ["steps", "closing", "headings", "known_length", "length_classes", "thigh"]
    wanted = {
        "steps": Question.STEP,
        "closing": Question.POSITION,
        "headings": Question.HEADING,
        "length_classes": Question.LENGTH,
        "thigh": Question.THIGH,
    }
    for key, question in wanted.items():
        assert [row[0] for row in found[key].rows] == [method.name for method in of(question)]
    assert [one.recording for one in problems] == ["3-1"]
    assert all(len(row) == len(table.columns) for table in found.values() for row in table.rows)


def test_perfect_sensors_lose_hardly_a_step_and_no_metre(simulated: Path) -> None:
    found, _ = tables(simulated)
    for name, most in (("gaitlab", 0), ("jimenez2009_gyroscope", 0), ("jimenez2009_acceleration", 2)):
        assert (
            numbers(found["steps"], name, "missed") <= most
        )  # of 70; the last step, feet together, is a small one
    for name in ("gaitlab", "jimenez2009_zupt", "feliz2009"):
        row = next(row for row in found["known_length"].rows if row[:2] == (name, "position"))
        assert float(row[2]) == pytest.approx(10.3, abs=0.4)  # type: ignore[arg-type]
    assert numbers(found["length_classes"], "gaitlab", "RMSE") < 0.02
    assert numbers(found["length_classes"], "weinberg", "RMSE") < 0.1


def test_factors_come_from_other_people_alone(simulated: Path, tmp_path: Path) -> None:
    """With one person there is nobody to learn from; with the same walk by another name the length is met."""
    found, _ = tables(simulated)
    row = next(row for row in found["known_length"].rows if row[0] == "weinberg")
    assert float(row[2]) == pytest.approx(10.0, abs=1e-6)  # type: ignore[arg-type]
    alone, _ = tables(folders.ten_metres(tmp_path, "1-1", "1-2"))
    row = next(row for row in alone["known_length"].rows if row[0] == "weinberg")
    assert row[5] == 0


def test_steps_are_counted_from_mid_swing_to_mid_swing_within_the_trial(simulated: Path) -> None:
    feet, _ = labelled_feet(simulated / "ten")
    foot: LabelledFoot = replace(feet[0], side=Side.LEFT, labels=LABELS)
    assert steps_in(np.array([1.5, 2.5, 3.5]), foot).tolist() == [1, 1, 1]
    assert steps_in(np.array([1.1, 1.5, 2.15, 3.5, 3.7, 9.5]), foot).tolist() == [2, 0, 2]
    assert steps_in(np.array([6.0]), foot).tolist() == [0, 0, 0]


def test_a_detector_that_hears_nothing_misses_all(simulated: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    deaf = replace(of(Question.STEP)[0], run=lambda _: np.zeros(0))
    monkeypatch.setattr("gaitlab.validation.methods_feet.of", lambda _: (deaf,))
    feet, _ = labelled_feet(simulated / "ten")
    (row,) = steps_table(feet).rows
    assert row[1] == row[2] > 30


def test_the_trials_part_of_a_track_ends_with_the_swing_that_ends_it() -> None:
    time = np.array([0.2, 0.8, 1.6, 2.6, 3.6, 9.6])
    track = Track(time, np.column_stack([time, time, time]))
    part = trial_part(track, LABELS, Side.LEFT)
    assert part is not None
    assert part.time_s.tolist() == [0.8, 1.6, 2.6, 3.6]
    assert part.place_m[0].tolist() == [0.0, 0.0, 0.0]
    assert trial_part(Track(time[:1], track.place_m[:1]), LABELS, Side.LEFT) is None
    assert trial_part(Track(time[:0], track.place_m[:0]), LABELS, Side.LEFT) is None


def test_a_page_text_and_json_hold_the_same_numbers() -> None:
    columns = (Column("method"), Column("error", "m", 2), Column("paper"))
    table = PaperTable("t", "A title", "A note.", columns, (("one", 1.234, "2 m"), ("two", float("nan"), "")))
    problems = [Problem("walk", "It is broken.")]
    page = tables_markdown([table], problems, "gaitlab validate methods DIR --markdown")
    assert "| one | 1.23 | 2 m |" in page
    assert "| two | – |  |" in page
    assert "`gaitlab validate methods DIR --markdown`" in page
    assert "- walk: It is broken." in page
    assert "1.23  2 m" in tables_text([table], problems)
    document = json.loads(tables_json([table], problems))
    assert document["tables"]["t"]["rows"][0] == {"method": "one", "error [m]": 1.234, "paper": "2 m"}
    assert document["tables"]["t"]["rows"][1]["error [m]"] is None


def test_a_folder_without_a_set_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        methods_tables(tmp_path)
    assert refused.value.code == "no_known_set"


def test_the_command_prints_a_page_or_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = folders.ten_metres(tmp_path / "ten", "1-1")
    assert main(["validate", "methods", str(folder), "--markdown"]) == 0
    assert capsys.readouterr().out.startswith("# Published methods on public recordings\n")
    assert main(["validate", "methods", str(folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["schema"] == "gaitlab.methods/1"
    assert main(["validate", "methods", str(tmp_path / "none")]) == 1
    capsys.readouterr()
    for wrong in (["methods"], ["10m-walk", str(folder), "--markdown"], ["10m-walk", str(folder), "--all"]):
        with pytest.raises(SystemExit) as ended:
            main(["validate", *wrong])
        assert ended.value.code == 2


def test_public_recordings_bear_the_papers_out_where_they_can(data_dir: Path) -> None:
    """Limits a little above the figures reached, so that a step back is noticed."""
    found, problems = tables(data_dir)
    assert not problems
    for name, most in (
        ("gaitlab", 1.0),
        ("jimenez2009_acceleration", 1.5),
        ("jimenez2009_gyroscope", 1.5),
        ("jimenez2009_magnetometer", 4.0),
    ):
        missed = found["steps"].rows[[row[0] for row in found["steps"].rows].index(name)][3]
        assert isinstance(missed, float)
        assert missed < most
    closing = {row[0]: row for row in found["closing"].rows}
    for name, most in (
        ("gaitlab", 2.0),
        ("jimenez2009_zupt", 5.0),
        ("feliz2009", 5.0),
        ("jimenez2009_sl_zupt", 7.0),
    ):
        assert float(closing[name][3]) < most  # type: ignore[arg-type]
    lengths = {(row[0], row[1]): row for row in found["known_length"].rows}
    assert float(lengths["gaitlab", "position"][3]) < 0.45  # type: ignore[arg-type]
    assert numbers(found["length_classes"], "gaitlab", "RMSE") < 0.02
    assert numbers(found["length_classes"], "sun2015", "RMSE") < 0.15
