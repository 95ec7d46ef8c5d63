"""All templates escape, none needs what the security policy forbids, and all can be used without seeing them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from bs4 import BeautifulSoup
from jinja2 import UndefinedError

from api.web.templates import environment
from gaitlab.paths import data_folder
from tests.api.visitors import open_house

PAGES = sorted(
    str(path.relative_to(data_folder("templates")))
    for path in data_folder("templates").rglob("*.html")
    if path.name not in ("report.html", "base.html", "macros.html")
)


@pytest.mark.parametrize("name", ["a.html", "a.html.j2", "a.svg", "a.css", "a.txt", "a"])
def test_everything_is_escaped_whatever_the_file_is_called(name: str) -> None:
    template = environment().from_string("{{ x }}")
    template.name = name
    assert template.render(x="<b>&\"'") == "&lt;b&gt;&amp;&#34;&#39;"
    assert environment().autoescape is True


def test_what_is_undefined_is_not_silent() -> None:
    with pytest.raises(UndefinedError):
        environment().from_string("{{ nothing }}").render()


@pytest.mark.parametrize("name", PAGES)
def test_no_template_switches_the_escaping_off_or_brings_style_or_script_of_its_own(name: str) -> None:
    text = (data_folder("templates") / name).read_text(encoding="utf-8")
    for forbidden in (
        "|safe",
        "| safe",
        "autoescape",
        "<style",
        "style=",
        "javascript:",
        "http://",
        "https://",
    ):
        assert forbidden not in text
    assert not re.search(r"\son\w+=", text)
    assert not re.search(r"<script(?![^>]*\bsrc=\"\{\{ static)", text)


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, BeautifulSoup]]:
    """Every page once, as a clinician sees it."""
    with open_house(tmp_path_factory.mktemp("pages")) as house:
        patient = house.patient(house.alice)
        session = house.session(house.alice, patient.id)
        browser = house.browser(house.alice)
        house.token(house.alice)
        paths = (
            *(
                "/",
                "/patients/new",
                f"/patients/{patient.id}",
                f"/patients/{patient.id}/edit",
                "/tokens",
                "/help",
                "/docs",
            ),
            *(
                f"/patients/{patient.id}/sessions/new",
                f"/sessions/{session.id}",
                f"/sessions/{session.id}/trials/new",
                f"/trials/{session.trials[0].id}/compare",
            ),
        )
        pages = {path.replace(patient.id, "P").replace(session.id, "S"): browser.soup(path) for path in paths}
        pages["/login"] = house.stranger().soup("/login")
        pages["error"] = BeautifulSoup(browser.get("/nothing").text, "html.parser")
        yield pages


def test_every_page_loads_from_here_only(shown: dict[str, BeautifulSoup]) -> None:
    for path, page in shown.items():
        for element in page.select("[src], link[href], form[action]"):
            address = str(element.get("src") or element.get("href") or element.get("action"))
            assert address.startswith(("/", "data:image/svg+xml;base64,")), (path, address)
            assert not address.startswith("//")
        assert not page.select("[style], style, [onclick], [onload]"), path


def test_every_page_has_a_language_a_title_one_heading_and_a_way_past_the_navigation(
    shown: dict[str, BeautifulSoup],
) -> None:
    for path, page in shown.items():
        assert page.html is not None
        assert page.html["lang"] == "en"
        assert page.title is not None
        assert page.title.get_text().endswith("gaitlab")
        assert len(page.select("h1")) == 1, path
        assert page.select_one("a.skip[href='#main']") is not None
        assert page.select_one("main#main") is not None


def test_every_field_has_a_label_and_every_id_is_there_once(shown: dict[str, BeautifulSoup]) -> None:
    for path, page in shown.items():
        for template in page.select("template"):
            template.decompose()
        ids = [str(element["id"]) for element in page.select("[id]")]
        assert len(ids) == len(set(ids)), path
        for field in page.select("input:not([type=hidden]), select, textarea"):
            labelled = (
                field.find_parent("label")
                or field.get("aria-label")
                or page.select_one(f"label[for='{field.get('id')}']")
            )
            assert labelled, (path, str(field)[:80])
        for element in page.select("[aria-describedby], [aria-labelledby]"):
            for name in str(element.get("aria-describedby") or element.get("aria-labelledby")).split():
                assert name in ids, (path, name)


def test_every_table_has_a_name_and_headed_columns(shown: dict[str, BeautifulSoup]) -> None:
    for path, page in shown.items():
        for table in page.select("table"):
            assert table.select_one("caption") or table.get("aria-labelledby"), path
            for head in table.select("thead th"):
                assert head.get("scope") == "col", path


def test_every_image_has_a_text_or_is_hidden_from_readers(shown: dict[str, BeautifulSoup]) -> None:
    for path, page in shown.items():
        for image in page.select("img"):
            assert image.get("alt"), path
        for drawing in page.select("svg"):
            assert drawing.get("aria-hidden") == "true" or drawing.get("aria-label"), path


def test_every_form_that_changes_something_carries_its_token(shown: dict[str, BeautifulSoup]) -> None:
    for path, page in shown.items():
        for form in page.select("form[method=post]"):
            if form["action"] != "/login":
                assert form.select_one("input[name=form_token][value]"), (path, form["action"])


def test_the_style_sheet_and_the_script_reach_for_nothing_elsewhere() -> None:
    folder = Path(__file__).resolve().parents[2] / "api" / "static"
    for name in ("app.css", "upload.js", "icon.svg"):
        text = (folder / name).read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
        for forbidden in (
            "http:",
            "https:",
            "//cdn",
            "@import",
            "url(",
            "eval(",
            "innerHTML",
            "document.write",
        ):
            assert forbidden not in text, (name, forbidden)
