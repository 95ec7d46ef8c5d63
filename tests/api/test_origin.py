"""Forged requests: whatever another site makes a browser send changes nothing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi.routing import iter_route_contexts
from sqlalchemy import MetaData, func, select

from api.app import create_app
from api.policy import Credential, policy_of
from tests.api.visitors import SAME_ORIGIN, House, Visitor, open_house

UNSAFE = sorted(
    context.path
    for context in iter_route_contexts(create_app().routes)
    if context.path and context.endpoint and "POST" in (context.methods or ())
    if (policy := policy_of(context.endpoint)) is not None and policy.credentials != {Credential.BEARER}
)
FORGED = {
    "another site": {"Sec-Fetch-Site": "cross-site"},
    "a sister site": {"Sec-Fetch-Site": "same-site"},
    "typed by nobody": {"Sec-Fetch-Site": "none"},
    "a foreign origin": {"Origin": "https://evil.example"},
    "a hidden origin": {"Origin": "null"},
    "an origin that looks alike": {"Origin": "http://localhost.evil.example"},
    "another port": {"Origin": "http://localhost:8000"},
    "nowhere": {},
}


@dataclass(frozen=True)
class Records:
    """An application with a record, and two people logged in."""

    house: House
    ids: dict[str, str]
    alice: Visitor
    bob: Visitor


@pytest.fixture(scope="module")
def records(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Records]:
    with open_house(tmp_path_factory.mktemp("origin")) as house:
        patient = house.patient(house.alice)
        session = house.session(house.alice, patient.id)
        token_id = house.token(house.alice).split("_")[1]
        trial_id = session.trials[0].id
        ids = {"patient_id": patient.id, "session_id": session.id, "trial_id": trial_id, "token_id": token_id}
        yield Records(house, ids, house.browser(house.alice), house.browser(house.bob))


def rows(house: House) -> dict[str, int]:
    """How many rows each table has, but for the audit trail and what a log-in leaves."""
    meta = MetaData()
    meta.reflect(house.clinic.database.engine)
    left_out = {"audit_event", "web_session", "attempt", "login_attempt"}
    with house.clinic.database.engine.connect() as db:
        tables = [table for table in meta.sorted_tables if table.name not in left_out]
        return {table.name: db.scalar(select(func.count()).select_from(table)) or 0 for table in tables}


def forge(visitor: Visitor, path: str, headers: dict[str, str], **fields: str) -> Any:
    return visitor.client.post(path, data=fields, headers=headers)


def filled(path: str, ids: dict[str, str]) -> str:
    for name, value in ids.items():
        path = path.replace("{" + name + "}", value)
    return path


def test_the_unsafe_pages_are_these() -> None:
    assert len(UNSAFE) >= 11
    assert "/login" in UNSAFE
    assert not any(path.startswith("/api/") for path in UNSAFE)


@pytest.mark.parametrize("path", UNSAFE)
@pytest.mark.parametrize("source", FORGED)
def test_a_request_from_elsewhere_is_refused(records: Records, path: str, source: str) -> None:
    house, ids = records.house, records.ids
    visitor = Visitor(house.app) if path in ("/login", "/setup") else records.alice
    before = rows(house)
    token = {"form_token": visitor.token} if visitor.secret else {}
    answer = forge(visitor, filled(path, ids), FORGED[source], **token, method="gaitlab", reason="forged")
    assert answer.status_code == 403
    assert rows(house) == before


@pytest.mark.parametrize("path", [path for path in UNSAFE if path not in ("/login", "/setup")])
@pytest.mark.parametrize("form_token", ["none", "empty", "another session's"])
def test_a_form_without_its_own_token_is_refused(records: Records, path: str, form_token: str) -> None:
    house, ids, visitor = records.house, records.ids, records.alice
    before = rows(house)
    sent = {
        "none": {},
        "empty": {"form_token": ""},
        "another session's": {"form_token": records.bob.token},
    }
    answer = forge(
        visitor, filled(path, ids), SAME_ORIGIN, **sent[form_token], method="gaitlab", reason="forged"
    )
    assert answer.status_code == 403
    assert rows(house) == before


def test_json_dressed_as_text_is_refused(records: Records) -> None:
    answer = records.alice.client.post(
        "/patients/new", content=b'{"code": "X"}', headers={**SAME_ORIGIN, "Content-Type": "text/plain"}
    )
    assert answer.status_code == 403


@pytest.mark.parametrize(
    "headers", [SAME_ORIGIN, {"Origin": "http://localhost"}], ids=["fetch metadata", "origin"]
)
def test_a_form_from_our_own_page_is_taken(house: House, headers: dict[str, str]) -> None:
    visitor = house.browser(house.alice)
    answer = forge(visitor, "/patients/new", headers, form_token=visitor.token, code="P-2", sex="male")
    assert answer.headers["location"].startswith("/patients/")


def test_looking_at_every_page_changes_nothing(records: Records) -> None:
    house, ids, visitor = records.house, records.ids, records.alice
    before = rows(house)
    for context in iter_route_contexts(house.app.routes):
        if context.path and "GET" in (context.methods or ()):
            visitor.get(filled(context.path, {**ids, "name": "route"}))
    assert rows(house) == before


def test_a_foreign_session_cookie_planted_before_the_log_in_is_not_taken_over(house: House) -> None:
    planted = "planted-by-somebody-else"
    visitor = Visitor(house.app, planted)
    answer = visitor.client.post(
        "/login",
        data={"email": "alice@clinic.example", "password": "violet-tractor-hums-94"},
        headers=SAME_ORIGIN,
    )
    assert answer.status_code == 303
    cookie = answer.headers["set-cookie"]
    assert planted not in cookie
    assert "HttpOnly" in cookie
    assert "SameSite=lax" in cookie
    assert Visitor(house.app, planted).get("/").status_code == 303
