"""The session page shows what was measured, in the report's words."""

from __future__ import annotations

import pytest
from bs4 import BeautifulSoup

from api.web.strip import walk_strip
from api.web.tables import parameter_tables, summary
from gaitlab.report.parameters import group_tables
from gaitlab.report.summary import verdict
from gaitlab.result import Result
from tests.api.visitors import House, soup


@pytest.fixture
def page(house: House) -> tuple[BeautifulSoup, Result]:
    session = house.session(house.alice, house.patient(house.alice).id, note="with a note")
    return house.browser(house.alice).soup(f"/sessions/{session.id}"), session.trials[0].result


def test_every_value_of_the_report_stands_in_the_table(page: tuple[BeautifulSoup, Result]) -> None:
    shown, result = page
    table = shown.select_one("table.parameters")
    assert table is not None
    text = " ".join(table.get_text(" ").split())
    for group in group_tables(result):
        assert group.title in text
        for row in group.rows:
            assert row.label in text
            assert " ".join(row.definition.split()) in text
            for cell in (row.left, row.right, row.both):
                if cell is not None:
                    assert cell.value in text
                    assert " ".join(cell.interval.split()) in text
            for note in row.notes:
                assert " ".join(note.text.split()) in text


def test_the_verdict_the_warnings_and_the_note_are_said(page: tuple[BeautifulSoup, Result]) -> None:
    shown, result = page
    quality = shown.select_one(".quality")
    assert quality is not None
    assert verdict(result).label in quality.get_text()
    for warning in result.warnings:
        assert warning.message in quality.get_text()
    assert "with a note" in shown.get_text()


def test_every_status_is_said_in_a_word_and_not_by_colour_alone(page: tuple[BeautifulSoup, Result]) -> None:
    shown, _ = page
    states = [state.get_text(strip=True) for state in shown.select(".parameters .status")]
    assert states
    assert set(states) <= {"ok", "attention", "not determinable"}


def test_files_and_analyses_are_shown_with_their_hashes(page: tuple[BeautifulSoup, Result]) -> None:
    shown, result = page
    hashes = {cell.get_text() for cell in shown.select(".files-table .hash")}
    assert hashes == {given.sha256 for given in result.provenance.inputs}
    assert result.provenance.settings_sha256[:16] in shown.get_text()


def test_figures_come_as_images_with_a_description(page: tuple[BeautifulSoup, Result]) -> None:
    shown, _ = page
    figures = shown.select(".figures figure")
    assert len(figures) >= 6
    for figure in figures:
        image = figure.select_one("img")
        assert image is not None
        assert str(image["src"]).startswith("data:image/svg+xml;base64,")
        assert len(str(image["alt"])) > 20
        assert figure.select_one("figcaption") is not None


def test_each_download_of_the_page_is_there(house: House, page: tuple[BeautifulSoup, Result]) -> None:
    shown, _ = page
    browser = house.browser(house.alice)
    links = {str(a["href"]): a.get_text() for a in shown.select("main a[href]")}
    wanted = [
        link for link in links if link.endswith((".pdf", ".html", ".json", ".csv", ".svg", "/trials/new"))
    ]
    assert len(wanted) >= 11
    for link in wanted:
        assert browser.get(link).status_code == 200


def test_analysing_again_adds_an_analysis_and_keeps_the_first(house: House) -> None:
    browser = house.browser(house.alice)
    session = house.session(house.alice, house.patient(house.alice).id)
    trial = session.trials[0].id
    before = browser.get(f"/trials/{trial}/result.json").json()
    answer = browser.post(f"/trials/{trial}/analyses", {"method": "ikizoglu2018"})
    assert answer.headers["location"] == f"/sessions/{session.id}?trial=1"
    page = browser.soup(answer.headers["location"])
    rows = [row.get_text(" ") for row in page.select("table.list")[1].select("tbody tr")]
    assert len(rows) == 2
    assert "yes" in rows[0]
    assert "İkizoğlu" in rows[0]
    assert "no" in rows[1].split()
    after = browser.get(f"/trials/{trial}/result.json").json()
    assert (before["provenance"]["method"], after["provenance"]["method"]) == ("gaitlab", "ikizoglu2018")
    wrong = browser.post(f"/trials/{trial}/analyses", {"method": "guess"})
    assert wrong.status_code == 422


def test_a_trial_that_is_not_there_is_not_found(house: House) -> None:
    browser = house.browser(house.alice)
    session = house.session(house.alice, house.patient(house.alice).id)
    answer = browser.get(f"/sessions/{session.id}?trial=2")
    assert answer.status_code == 404
    assert soup(answer).select_one("a.button") is not None
    assert browser.get(f"/sessions/{session.id}?trial=x").status_code == 422


def test_the_strip_shows_each_stance_once_and_in_order(page: tuple[BeautifulSoup, Result]) -> None:
    _, result = page
    strip = walk_strip(result)
    assert strip is not None
    for lane in strip.lanes:
        foot = result.feet[lane.side]  # type: ignore[index]
        assert len(lane.stances) == len(foot.events.foot_off_s) + 1
        ends = [0.0, *(span.start + span.width for span in lane.stances)]
        assert all(span.start >= end for span, end in zip(lane.stances, ends, strict=False))
        assert ends[-1] == pytest.approx(100, abs=0.01)
    assert strip.ticks[0] == (0, 0)
    assert len(strip.ticks) <= 9


def test_the_strip_of_a_result_without_feet_is_left_out(page: tuple[BeautifulSoup, Result]) -> None:
    _, result = page
    assert walk_strip(result.model_copy(update={"feet": {}})) is None


def test_the_summary_names_a_side_only_where_there_is_no_value_of_both(
    page: tuple[BeautifulSoup, Result],
) -> None:
    _, result = page
    assert all(tile.side == "both" for tile in summary(result))
    one_sided = [p for p in result.parameters if p.side != "both"]
    tiles = summary(result.model_copy(update={"parameters": tuple(one_sided)}))
    assert {tile.side for tile in tiles} == {"left", "right"}
    assert summary(result.model_copy(update={"parameters": ()})) == []


def test_the_marks_lie_on_one_scale_within_the_drawing(page: tuple[BeautifulSoup, Result]) -> None:
    _, result = page
    values = {(p.label, p.side): p.value for p in result.parameters}
    rows = [row for table in parameter_tables(result) for row in table.rows if row.marks]
    assert rows
    for row in rows:
        left, right = row.marks
        assert min(left.low, right.low) == 6
        assert max(left.high, right.high) == 94
        first, second = values[row.cells.label, "left"], values[row.cells.label, "right"]
        assert first is not None
        assert second is not None
        assert (left.at <= right.at) == (first <= second) or abs(left.at - right.at) <= 0.1
