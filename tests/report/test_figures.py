"""Figures: complete, described, safe to put into a page, and small however long the recording."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from gaitlab.recording.model import Placement, Side
from gaitlab.report import FIGURES, Figure, TrialReport, figures
from gaitlab.report.figures.decimate import envelope, shares, spans
from gaitlab.result import Rest, Result, Stride
from gaitlab.series import SensorSeries
from tests.report import walk

SVG = "{http://www.w3.org/2000/svg}"
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def drawn(trial: TrialReport) -> list[Figure]:
    return figures(trial.result, trial.series)


def test_two_feet_and_two_knees_give_every_figure(drawn: list[Figure]) -> None:
    assert [figure.name for figure in drawn] == list(FIGURES)


def test_one_foot_gives_its_own_figures_only() -> None:
    left = figures(walk.result([Side.LEFT], knees=False), walk.series([Side.LEFT], knees=False))
    assert [figure.name for figure in left] == [
        "route",
        "strides",
        "left_foot_acceleration",
        "left_foot_velocity",
        "left_foot_position",
    ]


def test_nothing_recorded_gives_no_figure() -> None:
    nothing = np.empty(0, dtype=bool)
    empty = SensorSeries(np.empty(0), nothing, nothing, *([np.empty((0, 3))] * 5))
    bare = walk.result([], knees=False, chosen=())
    assert figures(bare, {}) == []
    assert figures(bare, {Placement.LEFT_FOOT: empty}) == []


def test_a_foot_that_never_moves_is_drawn() -> None:
    n = 400
    still = SensorSeries(
        np.arange(n) / 100, np.zeros(n, dtype=bool), np.ones(n, dtype=bool), *([np.zeros((n, 3))] * 5)
    )
    names = [figure.name for figure in figures(walk.result([], chosen=()), {Placement.LEFT_FOOT: still})]
    assert names == ["route", "left_foot_acceleration", "left_foot_velocity", "left_foot_position"]


def test_every_picture_has_a_title_and_a_description_that_it_names(drawn: list[Figure]) -> None:
    for figure in drawn:
        root = ET.fromstring(figure.svg)
        title, description = root.find(f"{SVG}title"), root.find(f"{SVG}desc")
        assert title is not None
        assert description is not None
        assert (title.text, description.text) == (figure.title, figure.alt)
        assert root.get("aria-labelledby") == f"{title.get('id')} {description.get('id')}"
        assert root.get("role") == "img"
        assert len(figure.alt) > 40


def test_no_inline_style_no_script_and_no_outside_link_is_in_a_picture(drawn: list[Figure]) -> None:
    for figure in drawn:
        for element in ET.fromstring(figure.svg).iter():
            assert element.tag not in {f"{SVG}style", f"{SVG}script", f"{SVG}image", f"{SVG}foreignObject"}
            assert "style" not in element.attrib
            assert element.get("href", "#").startswith("#")
        assert b"<!DOCTYPE" not in figure.svg
        assert figure.svg.startswith(b"<svg")


def test_ids_are_unique_over_all_figures_of_two_trials(trial: TrialReport) -> None:
    both = [figures(trial.result, trial.series, prefix=prefix) for prefix in ("t1-", "t2-")]
    ids = [
        e.get("id")
        for made in both
        for figure in made
        for e in ET.fromstring(figure.svg).iter()
        if e.get("id")
    ]
    assert len(ids) == len(set(ids))


def test_every_reference_inside_a_picture_leads_somewhere(drawn: list[Figure]) -> None:
    for figure in drawn:
        elements = list(ET.fromstring(figure.svg).iter())
        there = {e.get("id") for e in elements}
        assert {e.get("href", "")[1:] for e in elements if e.get("href")} <= there


def test_left_and_right_differ_in_colour_line_and_mark(drawn: list[Figure]) -> None:
    route = next(figure for figure in drawn if figure.name == "route")
    lines = [
        e for e in ET.fromstring(route.svg).iter(f"{SVG}path") if e.get("stroke") in {"#0072b2", "#d55e00"}
    ]
    dashed = {e.get("stroke"): False for e in lines}
    for line in lines:
        dashed[line.get("stroke")] |= line.get("stroke-dasharray") is not None
    assert dashed == {"#0072b2": False, "#d55e00": True}


def test_the_same_trial_gives_the_same_bytes_in_this_and_another_process(drawn: list[Figure]) -> None:
    here = hashlib.sha256(b"".join(figure.svg for figure in drawn)).hexdigest()
    again = figures(walk.result(), walk.series())
    assert hashlib.sha256(b"".join(figure.svg for figure in again)).hexdigest() == here
    program = (
        "import hashlib; from tests.report import walk; from gaitlab.report import figures;"
        "made = figures(walk.result(), walk.series());"
        "print(hashlib.sha256(b''.join(f.svg for f in made)).hexdigest())"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "77"}
    other = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    assert other.stdout.strip() == here


def test_importing_the_report_loads_no_plotting_library() -> None:
    program = "import sys, gaitlab.report; print('matplotlib' in sys.modules, 'typst' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["False", "False"]


def test_an_hour_of_walking_stays_under_a_megabyte() -> None:
    series, result = _an_hour()
    made = figures(result, series)
    assert len(made) == 5
    assert sum(len(figure.svg) for figure in made) < 1_000_000


def _an_hour() -> tuple[dict[Placement, SensorSeries], Result]:
    n = 360_000
    chance = np.random.default_rng(1)
    vectors = [chance.normal(size=(n, 3)).cumsum(axis=0) for _ in range(5)]
    t_s = np.arange(n) / 100
    rest, lost = np.arange(n) % 110 < 60, chance.random(n) < 0.05
    one = SensorSeries(t_s, lost, rest, *vectors)
    times = np.arange(0.3, 3598.0, 1.1)
    rests = tuple(Rest(start_s=t, end_s=t + 0.6, residual_velocity_mps=0.02) for t in times)
    strides = tuple(
        Stride(
            start_s=t,
            end_s=t + 1.1,
            length_m=1.2 + 0.1 * float(np.sin(t)),
            length_sd_m=0.02,
            duration_s=1.1,
            speed_mps=1.1,
            turning=k % 17 == 0,
        )
        for k, t in enumerate(times)
    )
    base = walk.result([Side.LEFT], knees=False)
    foot = base.feet["left"].model_copy(update={"rests": rests, "strides": strides})
    return {Placement.LEFT_FOOT: one}, base.model_copy(update={"feet": {"left": foot}})


def test_the_envelope_keeps_every_peak_and_the_ends() -> None:
    values = np.random.default_rng(3).normal(size=50_000)
    values[[12_345, 40_001]] = [50.0, -60.0]
    kept = envelope(values)
    assert {0, 12_345, 40_001, 49_999} <= set(kept.tolist())
    assert len(kept) < 700
    assert (np.diff(kept) > 0).all()


def test_spans_are_the_runs_of_the_mask_half_open() -> None:
    t_s = np.arange(10) / 10
    mask = np.array([1, 1, 0, 0, 1, 0, 0, 0, 0, 1], dtype=bool)
    np.testing.assert_allclose(spans(t_s, mask), [[0.0, 0.2], [0.4, 0.5], [0.9, 1.0]])
    np.testing.assert_allclose(spans(t_s, mask, 0.15), [[0.0, 0.2]])
    assert spans(t_s, ~mask & mask).shape == (0, 2)


def test_shares_of_lost_samples_add_up_to_all_of_them() -> None:
    t_s, lost = np.arange(1001) / 100, np.zeros(1001, dtype=bool)
    lost[[3, 4, 500, 1000]] = True
    rows = shares(t_s, lost, 100)
    assert len(rows) == 3
    assert ((rows[:, 1] - rows[:, 0]) * 100 * rows[:, 2]).sum() == pytest.approx(4)
    assert rows[0, 0] <= 0.03 < rows[0, 1]
    assert len(shares(t_s, lost, 10_000)) == 4


def test_lost_samples_are_shown_only_where_there_are_some(trial: TrialReport) -> None:
    series = dict(trial.series)
    left = series[Placement.LEFT_FOOT]
    series[Placement.LEFT_FOOT] = replace(left, lost=np.zeros_like(left.lost))
    assert {f.name for f in fields(left)} >= {"lost"}
    with_loss = {f.name: f.svg for f in figures(trial.result, trial.series)}
    without = {f.name: f.svg for f in figures(trial.result, series)}
    assert b"#8f1d5b" in with_loss["left_foot_velocity"]
    assert b"#8f1d5b" not in without["left_foot_velocity"]
