"""Every route with every kind of caller: who may, who may not, and that nothing of another site leaks."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi.routing import iter_route_contexts
from sqlalchemy import text

from gaitlab.clinic import accounts
from gaitlab.clinic.access import Permission, Principal, granted
from tests.api.visitors import REST_SCOPES, SAME_ORIGIN, House, Program, Visitor, as_uploads, open_house
from tests.recordings import short_walk

CANARY = "CANARY-zq7"
"""Stands in every text field of Alice's site; nobody else may ever see it."""


@dataclass(frozen=True)
class Rule:
    """Who may use a route: ``page``, ``rest``, ``both`` (any caller) or ``open``, and the permission, by its name."""

    way: str
    permission: str = ""


RULES: dict[str, Rule] = {
    "POST /api/v1/patients": Rule("rest", "patient:write"),
    "GET /api/v1/patients": Rule("rest", "patient:read"),
    "GET /api/v1/patients/{patient_id}": Rule("rest", "patient:read"),
    "PATCH /api/v1/patients/{patient_id}": Rule("rest", "patient:write"),
    "DELETE /api/v1/patients/{patient_id}": Rule("rest", "patient:write"),
    "POST /api/v1/patients/{patient_id}/sessions": Rule("rest", "session:write"),
    "GET /api/v1/patients/{patient_id}/sessions": Rule("rest", "session:read"),
    "POST /api/v1/sessions/{session_id}/trials": Rule("rest", "session:write"),
    "GET /api/v1/sessions/{session_id}": Rule("rest", "session:read"),
    "GET /api/v1/sessions/{session_id}/report.html": Rule("rest", "report:read"),
    "GET /api/v1/sessions/{session_id}/report.pdf": Rule("rest", "report:read"),
    "GET /api/v1/trials/{trial_id}": Rule("rest", "session:read"),
    "GET /api/v1/trials/{trial_id}/result.json": Rule("rest", "session:read"),
    "GET /api/v1/trials/{trial_id}/series.csv": Rule("rest", "session:read"),
    "GET /api/v1/trials/{trial_id}/comparison": Rule("rest", "session:read"),
    "GET /": Rule("page", "patient:read"),
    "GET /patients/new": Rule("page", "patient:write"),
    "POST /patients/new": Rule("page", "patient:write"),
    "GET /patients/{patient_id}": Rule("page", "patient:read"),
    "GET /patients/{patient_id}/edit": Rule("page", "patient:write"),
    "POST /patients/{patient_id}/edit": Rule("page", "patient:write"),
    "POST /patients/{patient_id}/delete": Rule("page", "patient:write"),
    "GET /patients/{patient_id}/sessions/new": Rule("page", "session:write"),
    "POST /patients/{patient_id}/sessions/new": Rule("page", "session:write"),
    "POST /patients/{patient_id}/sessions/inspect": Rule("page", "session:write"),
    "GET /sessions/{session_id}": Rule("page", "session:read"),
    "GET /sessions/{session_id}/trials/new": Rule("page", "session:write"),
    "POST /sessions/{session_id}/trials/new": Rule("page", "session:write"),
    "GET /sessions/{session_id}/report.html": Rule("page", "report:read"),
    "GET /sessions/{session_id}/report.pdf": Rule("page", "report:read"),
    "GET /trials/{trial_id}/result.json": Rule("page", "session:read"),
    "GET /trials/{trial_id}/series.csv": Rule("page", "session:read"),
    "GET /trials/{trial_id}/figures/{name}.svg": Rule("page", "session:read"),
    "GET /trials/{trial_id}/compare": Rule("page", "session:read"),
    "POST /trials/{trial_id}/analyses": Rule("page", "session:write"),
    "GET /tokens": Rule("page", "token:manage"),
    "POST /tokens": Rule("page", "token:manage"),
    "POST /tokens/{token_id}/revoke": Rule("page", "token:manage"),
    "POST /logout": Rule("page"),
    "GET /help": Rule("page"),
    "GET /docs": Rule("both"),
    "GET /openapi.json": Rule("both"),
    "GET /login": Rule("open"),
    "POST /login": Rule("open"),
    "GET /setup": Rule("open"),
    "POST /setup": Rule("open"),
    "GET /health/live": Rule("open"),
    "GET /health/ready": Rule("open"),
    "GET /static/{name}": Rule("open"),
    "GET /favicon.ico": Rule("open"),
}
ROUTES = sorted(RULES)
BODIES = {
    "POST /api/v1/patients/{patient_id}/sessions": {"date": "2026-11-20", "test": "walk"},
    "POST /trials/{trial_id}/analyses": {"method": "gaitlab"},
}


@dataclass(frozen=True)
class Records:
    """An application with a full record at Alice's site."""

    house: House
    ids: dict[str, str]
    revoked: str
    expired: str

    def path(self, route: str) -> str:
        return self._filled(route, self.ids)

    def missing(self, route: str) -> str:
        """The same path to what does not exist."""
        nothing = {name: "n" * 26 for name in self.ids if name.endswith("_id")}
        return self._filled(route, {**self.ids, **nothing})

    @staticmethod
    def _filled(route: str, ids: dict[str, str]) -> str:
        path = route.split(" ", 1)[1]
        for name, value in ids.items():
            path = path.replace("{" + name + "}", value)
        return path


@pytest.fixture(scope="module")
def records(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Records]:
    with open_house(tmp_path_factory.mktemp("matrix"), attempts_per_address=10_000) as house:
        patient = house.patient(
            house.alice, f"{CANARY} code", diagnosis=f"{CANARY} dia", note=f"{CANARY} note"
        )
        session = house.session(house.alice, patient.id, note=f"{CANARY} session")
        house.token(house.alice)
        with house.clinic.desk(house.alice) as desk:
            token = accounts.list_tokens(desk)[0]
        revoked, expired = house.token(house.alice), house.token(house.alice)
        with house.clinic.desk(house.alice) as desk:
            accounts.revoke_token(desk, next(t.id for t in accounts.list_tokens(desk) if t.id in revoked))
        with house.clinic.database.writing() as db:
            past = dt.datetime.now(dt.UTC) - dt.timedelta(days=1)
            changed = text("UPDATE api_token SET expires_at = :past WHERE id = :id")
            ids = [row[0] for row in db.execute(text("SELECT id FROM api_token")) if row[0] in expired]
            db.execute(changed, {"past": past.replace(tzinfo=None), "id": ids[0]})
        yield Records(
            house,
            {
                "patient_id": patient.id,
                "session_id": session.id,
                "trial_id": session.trials[0].id,
                "token_id": token.id,
                "name": "app.css",
            },
            revoked,
            expired,
        )


def ask(records: Records, route: str, caller: Visitor | Program, *, missing: bool = False) -> Any:
    """One request. Walks are sent whole, so that nothing but the rights can stop them; the other bodies are empty."""
    method = route.split(" ", 1)[0]
    path = records.missing(route) if missing else records.path(route)
    if isinstance(caller, Visitor):
        if method in ("GET", "POST"):
            return caller.get(path) if method == "GET" else caller.post(path, BODIES.get(route))
        return caller.client.request(method, path, headers=SAME_ORIGIN)
    more: dict[str, Any] = {}
    if method == "PATCH" or path == "/api/v1/patients":
        more = {"json": {}} if method != "GET" else {}
    elif route.endswith(("/sessions", "/trials")) and method == "POST":
        more = {"data": BODIES.get(route), "files": as_uploads(short_walk())}
    return caller.request(method, path, **more)


def test_every_route_is_in_the_matrix(records: Records) -> None:
    contexts = iter_route_contexts(records.house.app.routes)
    found = {f"{method} {context.path}" for context in contexts for method in context.methods or ()}
    assert found == set(RULES)


@pytest.mark.parametrize("route", ROUTES)
def test_nobody_gets_in_without_a_credential(records: Records, route: str) -> None:
    rule = RULES[route]
    for caller in (
        records.house.stranger(),
        Visitor(records.house.app, "not-a-session"),
        Program(records.house.app, ""),
    ):
        answer = ask(records, route, caller)
        assert CANARY not in answer.text
        if rule.way == "open":
            assert answer.status_code not in (401, 403) or route in ("POST /login", "POST /setup")
        elif route.startswith("GET") and rule.way != "rest":
            assert answer.status_code == 303
            assert answer.headers["location"].startswith("/login")
        else:
            assert answer.status_code in (401, 403)


@pytest.mark.parametrize("who", ["alice", "bob", "erik", "ada"])
def test_people_reach_the_pages_of_their_roles_and_no_others(records: Records, who: str) -> None:
    caller: Principal = getattr(records.house, who)
    held = {str(permission) for permission in granted(caller.roles)}
    browser = records.house.browser(caller)
    for route in ROUTES:
        rule = RULES[route]
        if rule.way in ("open", "rest") or route in ("POST /logout", "POST /patients/{patient_id}/delete"):
            continue
        answer = ask(records, route, browser, missing=route.startswith("POST"))
        if rule.permission and rule.permission not in held:
            assert answer.status_code == 403, route
            assert CANARY not in answer.text
        else:
            assert answer.status_code not in (303, 401, 403), route


@pytest.mark.parametrize("scope", REST_SCOPES)
def test_a_token_reaches_the_routes_of_its_scope_and_no_others(records: Records, scope: Permission) -> None:
    program = records.house.program(records.house.alice, [scope])
    for route in ROUTES:
        rule = RULES[route]
        if rule.way != "rest" or route.startswith("DELETE"):
            continue
        answer = ask(records, route, program)
        if rule.permission == scope:
            assert answer.status_code in (200, 201, 422), route
        else:
            assert (answer.status_code, answer.json()["code"]) == (403, "not_allowed"), route
            assert CANARY not in answer.text


@pytest.mark.parametrize("state", ["revoked", "expired"])
def test_a_revoked_or_expired_token_opens_nothing(records: Records, state: str) -> None:
    program = Program(records.house.app, getattr(records, state))
    for route in ROUTES:
        if RULES[route].way in ("rest", "both") and not route.startswith("DELETE"):
            answer = ask(records, route, program)
            assert answer.status_code == (401 if RULES[route].way == "rest" else 303), route


def test_a_token_has_no_more_than_its_owner_has_now(tmp_path_factory: pytest.TempPathFactory) -> None:
    with open_house(tmp_path_factory.mktemp("demoted")) as house:
        program = house.program(house.alice)
        assert program.get("/api/v1/patients").status_code == 200
        with house.clinic.database.writing() as db:
            db.execute(
                text("UPDATE account SET roles = '[\"admin\"]' WHERE id = :id"), {"id": house.alice.user_id}
            )
        assert program.get("/api/v1/patients").status_code == 403
        with house.clinic.desk(accounts.console(house.clinic)) as desk:
            accounts.disable_user(desk, "alice@clinic.example")
        assert program.get("/api/v1/patients").status_code == 401


@pytest.mark.parametrize(
    "route", [r for r in ROUTES if RULES[r].way in ("page", "rest") and r != "POST /logout"]
)
def test_another_site_finds_nothing_and_sees_nothing(records: Records, route: str) -> None:
    house = records.house
    caller = house.program(house.charlie) if RULES[route].way == "rest" else house.browser(house.charlie)
    answer = ask(records, route, caller)
    assert CANARY not in answer.text
    assert CANARY.encode() not in answer.content
    if "{" not in route.replace("{name}", ""):
        return
    assert answer.status_code == 404, route
    absent = ask(records, route, caller, missing=True)
    assert absent.status_code == 404
    assert _without_numbers(answer) == _without_numbers(absent)


def test_pages_show_an_engineer_no_names(records: Records) -> None:
    """An engineer may read sessions, but codes, notes, diagnoses and file names are not theirs to see."""
    browser = records.house.browser(records.house.erik)
    for route in ROUTES:
        if (
            RULES[route].way == "page"
            and route.startswith("GET")
            and RULES[route].permission.endswith(":read")
        ):
            answer = ask(records, route, browser)
            assert f"{CANARY} code" not in answer.text, route
            assert f"{CANARY} dia" not in answer.text, route


def _without_numbers(answer: Any) -> str:
    number = answer.headers["x-request-id"]
    shown: str = answer.text.replace(number, "")
    return shown
