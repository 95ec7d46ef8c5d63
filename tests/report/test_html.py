"""The page: everything in it, nothing from elsewhere, readable by people and machines."""

from __future__ import annotations

import base64
import hashlib
import itertools
import re

import jinja2
import pytest
from bs4 import BeautifulSoup
from markupsafe import Markup

from gaitlab.recording.model import Side
from gaitlab.report import (
    Report,
    Subject,
    TrialReport,
    build_report,
    report_html,
    style_source,
    template_environment,
)
from gaitlab.result import ResultWarning
from tests.report import walk
from tests.report.conftest import MADE_AT, report_of

HOSTILE = [
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "{{ 7 * 7 }} {% raw %}",
    '#import "x": * $x^2$ *bold* _it_ @ref `raw` \\ [a] 😀',
    "</style></title>",
]


@pytest.fixture(scope="module")
def page(report: Report) -> BeautifulSoup:
    return BeautifulSoup(report_html(report), "html.parser")


def test_the_page_needs_nothing_from_elsewhere_and_runs_nothing(page: BeautifulSoup, report: Report) -> None:
    assert page.find_all(["script", "link", "iframe", "object", "img", "form"]) == []
    assert [e for e in page.find_all(True) if e.has_attr("style")] == []
    assert [a for e in page.find_all(True) for a in e.attrs if a.startswith("on")] == []
    text = report_html(report)
    assert re.findall(r"(?:src|href|url)\s*[=(]\s*[\"']?(?!#|\")\w+:", text) == []
    assert "http:" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "https:" not in text


def test_the_page_allows_only_its_own_style(page: BeautifulSoup) -> None:
    policy = page.find("meta", attrs={"http-equiv": "Content-Security-Policy"})["content"]
    digest = base64.b64encode(hashlib.sha256(page.style.string.encode()).digest()).decode()
    assert f"'sha256-{digest}'" == style_source()
    assert policy.startswith("default-src 'none'; ")
    assert f"style-src {style_source()};" in policy


def test_headings_come_in_order_without_a_gap(trial: TrialReport) -> None:
    for report in (report_of(trial), report_of(trial, TrialReport(2, trial.result, trial.series))):
        page = BeautifulSoup(report_html(report), "html.parser")
        levels = [int(h.name[1]) for h in page.find_all(re.compile(r"^h[1-6]$"))]
        assert levels[0] == 1
        assert levels.count(1) == 1
        assert all(after - before <= 1 for before, after in itertools.pairwise(levels))


def test_tables_have_captions_and_scopes_and_the_page_a_language(page: BeautifulSoup) -> None:
    assert page.html["lang"] == "en"
    for table in page.find_all("table"):
        assert table.caption.get_text(strip=True)
        assert all(th.get("scope") in {"col", "row"} for th in table.find_all("th"))


def test_ids_are_unique_with_two_trials(trial: TrialReport) -> None:
    page = BeautifulSoup(
        report_html(report_of(trial, TrialReport(2, trial.result, trial.series))), "html.parser"
    )
    ids = [e["id"] for e in page.find_all(id=True)]
    assert len(ids) == len(set(ids)) > 20


def test_every_status_is_a_word_and_every_reason_is_said_in_full(page: BeautifulSoup) -> None:
    text = page.get_text(" ", strip=True)
    assert "attention" in text
    assert "not determinable" in text
    assert "Not determinable, left: No knee was recorded on this side." in text
    assert "Assumption: The feet start side by side." in text


def test_each_parameter_has_its_definition_and_source_beside_it(
    page: BeautifulSoup, trial: TrialReport
) -> None:
    heads = {th["abbr"]: th.get_text(" ") for th in page.select("table.parameters:not(.key) th[scope=row]")}
    for parameter in trial.result.parameters:
        assert parameter.definition in heads[parameter.label]
        assert f"Source: {parameter.reference}" in heads[parameter.label]


def test_hostile_texts_are_shown_as_text() -> None:
    for text in HOSTILE:
        warning = ResultWarning(code="x", message=text, placement=None)
        names = {"left_foot": text}
        trial = TrialReport(1, walk.result(warnings=(warning,), names=names), {})
        page_text = report_html(
            build_report(Subject(code=text, diagnosis=text, note=text), None, [trial], created_at=MADE_AT)
        )
        page = BeautifulSoup(page_text, "html.parser")
        assert page.find_all(["script", "img"]) == []
        assert page.h1.get_text() == f"Patient {text}"
        assert len(page.find_all("style")) == 1
        assert page.select_one(".warnings li").get_text() == text
        assert text in [td.get_text() for td in page.select("td.whole")]


def test_names_are_quoted_in_the_command() -> None:
    result = walk.result(names={"left_foot": "a b; rm -rf x.txt"})
    report = report_of(TrialReport(1, result, walk.series()))
    assert "--left-foot 'a b; rm -rf x.txt' --right-foot" in report.trials[0].command
    assert report.trials[0].command.endswith("--course 10 --method gaitlab --out result.json")


def test_nothing_determinable_says_so_and_why() -> None:
    chosen = tuple(
        p.model_copy(
            update={
                "value": None,
                "sd": None,
                "ci95": None,
                "status": "not_determinable",
                "reason": "No walking.",
            }
        )
        for p in walk.parameters()
    )
    report = report_of(TrialReport(1, walk.result(chosen=chosen), walk.series()))
    assert report.trials[0].verdict.label == "Not usable"
    text = BeautifulSoup(report_html(report), "html.parser").get_text(" ", strip=True)
    assert "Not usable" in text
    assert "Not determinable, left and right: No walking." in text


def test_one_foot_without_knees_has_a_report() -> None:
    sides = [Side.RIGHT]
    trial = TrialReport(1, walk.result(sides, knees=False), walk.series(sides, knees=False))
    page = BeautifulSoup(report_html(report_of(trial)), "html.parser")
    assert "Only one foot was recorded; two are needed." in page.get_text(" ")
    assert len(page.find_all("figure")) == 5


def test_the_analysis_of_a_file_without_patient_or_session_has_a_report(trial: TrialReport) -> None:
    report = build_report(None, None, [trial], created_at=MADE_AT)
    page = BeautifulSoup(report_html(report), "html.parser")
    assert page.h1.get_text() == "No patient given"
    assert page.header.dl is None


def test_time_of_making_is_said_in_utc(report: Report) -> None:
    assert report.created == "2026-11-21 12:05 UTC"


def test_templates_are_escaped_whatever_their_ending_and_strict() -> None:
    environment = template_environment()
    assert environment.autoescape is True
    assert environment.undefined is jinja2.StrictUndefined
    assert environment.from_string("{{ x }}").render(x="<b>") == "&lt;b&gt;"
    with pytest.raises(jinja2.UndefinedError):
        environment.from_string("{{ nothing }}").render()


def test_only_our_own_figures_become_markup() -> None:
    template = template_environment().from_string("{{ x | inline_svg }}")
    with pytest.raises(TypeError):
        template.render(x=Markup("<svg></svg>"))
