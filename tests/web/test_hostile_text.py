"""Text that databases choke on is refused or kept, on SQLite and on PostgreSQL; it is never a crash."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

import pytest

from tests.api.visitors import House, as_choice, open_house
from tests.recordings import short_walk

HOSTILE = ["\x00", "a\x00b", "\ufffe", "%", "_", "'\"\\;--", "\u202e", "\U0001d4b3"]


@pytest.fixture
def house_on(migrated_url: str, tmp_path: Path) -> Iterator[House]:
    with open_house(tmp_path, database_url=migrated_url) as made:
        yield made


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_no_text_in_any_field_crashes(house_on: House, text: str) -> None:
    house = house_on
    patient = house.patient(house.alice)
    session = house.session(house.alice, patient.id)
    browser, program = house.browser(house.alice), house.program(house.alice)
    walk = {"date": "2026-11-20", "test": "walk", "course_m": ""}
    answers = [
        browser.get("/", params={"query": text}),
        program.get("/api/v1/patients", params={"query": text}),
        browser.post("/login", {"email": text, "password": text, "next": text}),
        browser.post("/patients/new", {"code": f"c{text}", "sex": "female", "diagnosis": text, "note": text}),
        program.post("/api/v1/patients", json={"code": f"d{text}", "diagnosis": text, "note": text}),
        browser.post("/tokens", {"name": f"t{text}", "days": "1", "scopes": ["patient:read"]}),
        browser.post(
            f"/patients/{patient.id}/sessions/new",
            {**walk, "note": text},
            files=as_choice(short_walk().values()),
        ),
        browser.post(f"/trials/{session.trials[0].id}/analyses", {"method": text}),
        browser.get(f"/trials/{session.trials[0].id}/figures/{quote(text)}.svg"),
        browser.post(f"/patients/{patient.id}/delete", {"reason": text}),
    ]
    assert [answer.status_code for answer in answers if answer.status_code >= 500] == []
