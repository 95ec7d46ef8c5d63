"""Security headers on every answer, the cookie's attributes, and what stands in the log."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import pytest
from fastapi import APIRouter
from fastapi.routing import iter_route_contexts

from api.guard import GuardedRoute
from api.policy import open_to_all
from api.settings import WebSettings
from tests.api.visitors import House, open_house

EXPECTED = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "font-src 'self'; connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'; "
    "object-src 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cache-control": "no-store",
}


def check(answer: Any, **other: str) -> None:
    for name, value in {**EXPECTED, **other}.items():
        assert answer.headers.get(name) == value, (answer.request.url, answer.status_code, name)
    assert "permissions-policy" in answer.headers
    assert len(answer.headers["x-request-id"]) == 16
    assert "server" not in answer.headers


def test_every_route_answers_with_the_headers(house: House) -> None:
    patient = house.patient(house.alice)
    session = house.session(house.alice, patient.id)
    ids = {
        "patient_id": patient.id,
        "session_id": session.id,
        "trial_id": session.trials[0].id,
        "name": "route",
    }
    browser, program = house.browser(house.alice), house.program(house.alice)
    own = {"report.html", "{name}.svg", "{name}", "favicon.ico"}
    for context in iter_route_contexts(house.app.routes):
        if context.path is None or "GET" not in (context.methods or ()):
            continue
        path = context.path
        for name, value in ids.items():
            path = path.replace("{" + name + "}", value)
        answer = (program if path.startswith("/api/") else browser).get(path)
        assert answer.status_code < 500
        if context.path.rsplit("/", 1)[-1] not in own:
            check(answer)


def test_errors_answer_with_the_headers_too(house: House) -> None:
    router = APIRouter(route_class=GuardedRoute)

    @router.get("/crash")
    @open_to_all("test")
    def crash() -> None:
        raise RuntimeError

    house.app.include_router(router)
    browser, program = house.browser(house.alice), house.program(house.alice)
    answers = {
        303: house.stranger().get("/"),
        400: browser.get("/", headers={"Host": "evil.example"}),
        401: house.stranger().get("/api/v1/patients"),
        403: house.stranger().client.post("/login"),
        404: browser.get("/nothing/here"),
        405: browser.client.put("/"),
        413: program.post("/api/v1/patients", content=b"x" * 1_100_000),
        415: program.post("/api/v1/patients", content=b"", headers={"Content-Encoding": "br"}),
        422: program.post("/api/v1/patients", json={}),
        500: browser.get("/crash"),
    }
    for status, answer in answers.items():
        assert answer.status_code == status
        check(answer)
    assert answers[405].headers["allow"]


def test_a_report_may_have_its_own_style_and_nothing_else(house: House) -> None:
    session = house.session(house.alice, house.patient(house.alice).id)
    for answer in (
        house.browser(house.alice).get(f"/sessions/{session.id}/report.html"),
        house.program(house.alice).get(f"/api/v1/sessions/{session.id}/report.html"),
    ):
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "sandbox" in policy
        assert "style-src 'sha256-" in policy
        assert "unsafe" not in policy


def test_a_figure_shown_alone_can_do_nothing(house: House) -> None:
    session = house.session(house.alice, house.patient(house.alice).id)
    answer = house.browser(house.alice).get(f"/trials/{session.trials[0].id}/figures/route.svg")
    assert answer.status_code == 200
    check(answer, **{"content-security-policy": "default-src 'none'; frame-ancestors 'none'; sandbox"})


def test_downloads_are_named_by_ids_only(house: House) -> None:
    patient = house.patient(house.alice, "Jane Doe")
    session = house.session(house.alice, patient.id)
    browser = house.browser(house.alice)
    trial = session.trials[0].id
    for path in (
        f"/sessions/{session.id}/report.pdf",
        f"/trials/{trial}/result.json",
        f"/trials/{trial}/series.csv",
    ):
        disposition = browser.get(path).headers["content-disposition"]
        assert disposition.startswith("attachment; filename=")
        assert "Jane" not in disposition


def test_static_files_are_kept_by_browsers_under_their_content_s_address(house: House) -> None:
    browser = house.stranger()
    page = browser.get("/login").text
    address = page.split('href="/static/app.css')[1].split('"')[0]
    answer = browser.get(f"/static/app.css{address}")
    assert answer.headers["cache-control"] == "public, max-age=31536000, immutable"
    assert answer.headers["content-type"].startswith("text/css")
    assert browser.get("/static/app.css").headers["cache-control"] == "no-cache"
    assert browser.get("/static/app.py").status_code == 404


def test_behind_tls_the_cookie_is_bound_to_the_host_and_tls_is_insisted_on(tmp_path: Path) -> None:
    web = WebSettings(behind_tls=True, allowed_hosts=("localhost", "gait.example.org"))
    with open_house(tmp_path, web=web) as house:
        data = {"email": "alice@clinic.example", "password": "violet-tractor-hums-94"}
        answer = house.stranger().post("/login", data)
        cookie = answer.headers["set-cookie"]
        assert cookie.startswith("__Host-gait=")
        for part in ("HttpOnly", "Path=/", "SameSite=lax", "Secure"):
            assert part in cookie
        assert "Domain" not in cookie
        assert "Max-Age" not in cookie
        assert answer.headers["strict-transport-security"] == "max-age=31536000"


def test_the_log_names_the_route_and_not_the_address(house: House, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "gaitlab.web")
    patient = house.patient(house.alice, "CANARY-code")
    browser = house.browser(house.alice)
    browser.get(f"/patients/{patient.id}")
    browser.get("/?query=CANARY-query")
    browser.post("/patients/new", {"code": "CANARY-new\r\nforged line"})
    lines = [json.loads(record.message) for record in caplog.records if record.name == "gaitlab.web"]
    assert [line["route"] for line in lines] == ["/patients/{patient_id}", "/", "/patients/new"]
    assert [line["status"] for line in lines] == [200, 200, 422]
    assert all(line["principal"] == house.alice.user_id for line in lines)
    for word in ("CANARY", patient.id, browser.secret, browser.token, "forged"):
        assert word not in caplog.text
