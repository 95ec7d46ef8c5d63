"""The page that compares the methods: what it shows, to whom, and what the trail says of it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from bs4 import BeautifulSoup

from gaitlab.clinic.access import Principal
from gaitlab.methods.catalogue import catalogue
from tests.api.visitors import House, open_house


@dataclass(frozen=True)
class Stored:
    house: House
    session_id: str
    path: str


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stored]:
    with open_house(tmp_path_factory.mktemp("compared")) as house:
        patient = house.patient(house.alice, "CANARY-code", height_m=1.75, sex="female")
        session = house.session(house.alice, patient.id)
        yield Stored(house, session.id, f"/trials/{session.trials[0].id}/compare")


@pytest.fixture(scope="module")
def shown(stored: Stored) -> BeautifulSoup:
    return stored.house.browser(stored.house.alice).soup(stored.path)


def test_every_method_of_the_catalogue_stands_on_the_page_with_its_deviations(shown: BeautifulSoup) -> None:
    text = " ".join(shown.get_text(" ").split())
    ran = {summary.get_text(strip=True) for summary in shown.select("table.methods summary")}
    for method in catalogue().values():
        assert method.name in text
    assert {"gaitlab", "feliz2009", "jimenez2009_zupt", "height"} <= ran
    assert "failed" not in text
    deviation = catalogue()[next(k for k in catalogue() if k[1] == "jimenez2009_zupt")].deviations[0]
    assert " ".join(deviation.split()) in text


def test_what_is_missing_is_named_once_for_all_it_stops(shown: BeautifulSoup) -> None:
    lines = [" ".join(line.get_text().split()) for line in shown.select(".left-out")]
    assert "feliz2009_barometric: Missing: barometer." in lines
    assert any(line.endswith("weinberg, xu: Missing: a walk of known length.") for line in lines)


def test_a_known_length_lets_the_models_run(stored: Stored) -> None:
    page = stored.house.browser(stored.house.alice).soup(f"{stored.path}?length=6%2C0")
    names = {summary.get_text(strip=True) for summary in page.select("table.methods summary")}
    assert {"weinberg", "sun2015", "kim"} <= names
    assert page.select_one("#length")["value"] == "6,0"  # type: ignore[index]
    assert len(page.select(".figures figure")) == 4


@pytest.mark.parametrize("length", ["abc", "0", "-3", "1e9", "nan", "1_0"])
def test_a_length_that_cannot_be_is_said_beside_its_field(stored: Stored, length: str) -> None:
    page = stored.house.browser(stored.house.alice).soup(f"{stored.path}?length={length}")
    error = page.select_one("#length-error")
    assert error is not None
    assert "must be a number" in error.get_text()
    assert page.select("table.methods")


def test_figures_are_images_with_a_description_and_nothing_needs_a_script(shown: BeautifulSoup) -> None:
    assert not shown.select("script")
    images = shown.select(".figures img")
    assert images
    for image in images:
        assert str(image["src"]).startswith("data:image/svg+xml;base64,")
        assert len(str(image["alt"])) > 20


def test_the_session_leads_to_it_and_it_leads_back(stored: Stored, shown: BeautifulSoup) -> None:
    session = stored.house.browser(stored.house.alice).soup(f"/sessions/{stored.session_id}")
    assert session.select(f'a[href="{stored.path}"]')
    assert shown.select(f'a[href^="/sessions/{stored.session_id}"]')


def test_who_may_see_the_session_sees_it_and_an_engineer_sees_no_code(stored: Stored) -> None:
    house = stored.house
    for who in (house.alice, house.bob):
        assert "CANARY-code" in house.browser(who).get(stored.path).text
    answer = house.browser(house.erik).get(stored.path)
    assert answer.status_code == 200
    assert "CANARY-code" not in answer.text


def test_another_site_finds_nothing_and_a_stranger_must_log_in(stored: Stored) -> None:
    house = stored.house
    answer = house.browser(house.charlie).get(stored.path)
    assert answer.status_code == 404
    assert "CANARY" not in answer.text
    assert house.stranger().get(stored.path).status_code == 303
    assert house.browser(house.ada).get(stored.path).status_code == 403


def test_each_look_is_in_the_trail(stored: Stored) -> None:
    def looks(who: Principal) -> list[dict[str, str]]:
        with house.clinic.database.reading() as db:
            from sqlalchemy import text

            query = text("SELECT action, actor_id, outcome, patient_id FROM audit_event ORDER BY seq")
            rows = [dict(row) for row in db.execute(query).mappings()]
        return [r for r in rows if r["action"] == "trial.compare" and r["actor_id"] == who.user_id]

    house = stored.house
    before = len(looks(house.bob))
    house.browser(house.bob).get(stored.path)
    after = looks(house.bob)
    assert len(after) == before + 1
    assert after[-1]["patient_id"]
    house.browser(house.charlie).get(stored.path)
    assert json.dumps(looks(house.charlie)[-1]).count("refused") == 1


def test_rest_gives_the_same_as_json(stored: Stored) -> None:
    program = stored.house.program(stored.house.alice)
    path = f"/api/v1{stored.path.removesuffix('/compare')}/comparison"
    document = program.get(f"{path}?known_length_m=6").json()
    assert document["schema"] == "gaitlab.comparison/1"
    assert document["known_length_m"] == 6.0
    assert {one["method"] for one in document["questions"]["step length"]} >= {"gaitlab", "weinberg"}
    assert program.get(f"{path}?known_length_m=0").status_code == 422
