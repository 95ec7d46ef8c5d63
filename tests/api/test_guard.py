"""Deny by default: what has no policy does not start, and what gets past the start is refused."""

from __future__ import annotations

import asyncio
from collections.abc import MutableMapping
from pathlib import Path
from typing import Annotated, Any

import pytest
from fastapi import APIRouter, FastAPI
from fastapi.staticfiles import StaticFiles
from starlette.responses import PlainTextResponse
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.testclient import TestClient

from api import guard, web
from api.app import create_app
from api.guard import GuardedRoute
from api.middleware import Envelope
from api.policy import open_to_all, person, policy_of
from api.settings import WebSettings
from gaitlab.clinic import audit
from gaitlab.clinic.access import Permission
from gaitlab.errors import Misconfigured
from tests.api.visitors import HOST, House, Program, open_house

LEAK = "LEAK"


def require(_permission: str) -> Any:
    """A dependency as one would write it: F1 is to use it without ``Depends``."""
    return lambda: None


def test_the_application_has_a_policy_on_every_route() -> None:
    guard.audit(create_app())


@pytest.mark.parametrize(
    "router", [APIRouter(), APIRouter(route_class=GuardedRoute)], ids=["plain", "guarded"]
)
def test_a_route_without_a_policy_stops_the_start(router: APIRouter) -> None:
    @router.get("/forgotten")
    def forgotten() -> str:
        return LEAK

    app = FastAPI(openapi_url=None)
    app.include_router(router)
    with pytest.raises(Misconfigured, match="/forgotten"):
        guard.audit(app)


def test_a_dependency_written_without_depends_does_not_open_a_route() -> None:
    router = APIRouter(route_class=GuardedRoute)

    @router.get("/bad")
    def bad(u: Annotated[Any, require("patient:read")]) -> str:
        return LEAK

    app = FastAPI(openapi_url=None)
    app.include_router(router)
    with pytest.raises(Misconfigured, match="/bad"):
        guard.audit(app)


def test_a_policy_on_a_route_of_another_class_stops_the_start() -> None:
    router = APIRouter()

    @router.get("/unread")
    @open_to_all("never read by this class")
    def unread() -> str:
        return LEAK

    app = FastAPI(openapi_url=None)
    app.include_router(router)
    with pytest.raises(Misconfigured, match="/unread"):
        guard.audit(app)


def test_mounts_sockets_plain_routes_and_the_frameworks_own_pages_stop_the_start(tmp_path: Path) -> None:
    def answer(_request: Any) -> PlainTextResponse:
        return PlainTextResponse(LEAK)

    for stray in (
        Mount("/files", StaticFiles(directory=tmp_path)),
        Route("/plain", answer),
        WebSocketRoute("/socket", answer),
    ):
        app = FastAPI(openapi_url=None)
        app.router.routes.append(stray)
        with pytest.raises(Misconfigured, match=stray.path):
            guard.audit(app)
    with pytest.raises(Misconfigured, match=r"/openapi\.json"):
        guard.audit(FastAPI())
    (tmp_path / "index.html").write_text(LEAK)
    app = FastAPI(openapi_url=None)
    app.frontend("/", directory=str(tmp_path))
    with pytest.raises(Misconfigured):
        guard.audit(app)


def test_a_forgotten_route_of_an_included_router_is_found_under_its_prefix() -> None:
    inner, outer = APIRouter(route_class=GuardedRoute), APIRouter(route_class=GuardedRoute)

    @inner.get("/deep")
    def deep() -> str:
        return LEAK

    outer.include_router(inner, prefix="/inner")
    app = FastAPI(openapi_url=None)
    app.include_router(outer, prefix="/outer")
    with pytest.raises(Misconfigured, match="/outer/inner/deep"):
        guard.audit(app)


def test_a_route_added_after_the_start_answers_nothing(house: House) -> None:
    house.app.router.routes.insert(0, Route("/late", lambda _request: PlainTextResponse(LEAK)))
    router = APIRouter(route_class=GuardedRoute)

    @router.get("/later")
    def later() -> str:
        return LEAK

    house.app.include_router(router)
    for path in ("/late", "/later"):
        answer = house.browser(house.alice).get(path)
        assert answer.status_code in (500, 503)
        assert LEAK not in answer.text


def test_an_open_route_must_say_why() -> None:
    with pytest.raises(ValueError, match="why"):
        open_to_all("")


def test_the_policy_is_kept_on_the_endpoint() -> None:
    @person(Permission.PATIENT_READ)
    def endpoint() -> None: ...

    policy = policy_of(endpoint)
    assert policy is not None
    assert policy.permission is Permission.PATIENT_READ
    assert policy_of(lambda: None) is None


def test_a_request_with_cookie_and_token_is_refused(house: House) -> None:
    token = house.token(house.alice)
    answer = house.browser(house.alice).get("/api/v1/patients", headers={"Authorization": f"Bearer {token}"})
    assert answer.status_code == 400
    assert answer.json()["code"] == "two_credentials"


def test_a_cookie_opens_no_rest_and_a_token_no_page(house: House) -> None:
    assert house.browser(house.alice).get("/api/v1/patients").status_code == 401
    page = house.program(house.alice).get("/")
    assert (page.status_code, page.headers["location"]) == (303, "/login")


@pytest.mark.parametrize("host", ["evil.example", "localhost@evil.example", "localhost/health/live?", ""])
def test_a_foreign_host_header_is_refused(house: House, host: str) -> None:
    answer = house.browser(house.alice).get("/", headers={"Host": host, "Accept": "application/json"})
    assert (answer.status_code, answer.json()["code"]) == (400, "unknown_host")


@pytest.mark.parametrize("host", ["localhost", "LOCALHOST:8000", "127.0.0.1:8000", "[::1]:8000"])
def test_this_machine_s_own_names_are_answered(house: House, host: str) -> None:
    assert house.browser(house.alice).get("/", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "path",
    ["//", "/health/live/../../", "/static/..%2f..%2fapp.py", "/static/%2e%2e/app.py", "/patients/new/"],
)
def test_odd_paths_open_nothing(house: House, path: str) -> None:
    answer = house.stranger().client.send(
        house.stranger().client.build_request("GET", HOST + path), follow_redirects=False
    )
    assert answer.status_code in (303, 404)
    assert "import" not in answer.text


class Wire:
    """A request straight at the application, to see what it reads of the body and when it stops."""

    def __init__(self, house: House, path: str, *headers: tuple[bytes, bytes]) -> None:
        self._app = house.app
        self._scope = {
            "type": "http",
            "http_version": "1.1",
            "method": "POST",
            "scheme": "http",
            "path": path,
            "raw_path": path.encode(),
            "query_string": b"",
            "root_path": "",
            "headers": [(b"host", b"localhost"), *headers],
            "client": ("127.0.0.1", 1),
            "server": ("localhost", 80),
        }
        self.n_read = 0
        self.gone_after = 1000
        self.status = 0

    async def _receive(self) -> MutableMapping[str, Any]:
        self.n_read += 1
        assert self.n_read < 100, "the body is read without end"
        if self.n_read > self.gone_after:
            return {"type": "http.disconnect"}
        return {"type": "http.request", "body": b"x" * 65536, "more_body": True}

    async def _send(self, message: MutableMapping[str, Any]) -> None:
        self.status = message.get("status", self.status)

    def send(self) -> Wire:
        asyncio.run(self._app(self._scope, self._receive, self._send))
        return self


def test_the_body_is_not_read_before_the_caller_is_known(house: House) -> None:
    form = (b"content-type", b"multipart/form-data; boundary=b")
    wire = Wire(house, "/api/v1/patients/x/sessions", form).send()
    assert (wire.status, wire.n_read) == (401, 0)


def test_an_endless_body_is_cut_off_at_the_limit(house: House) -> None:
    bearer = (b"authorization", f"Bearer {house.token(house.alice)}".encode())
    wire = Wire(house, "/api/v1/patients", bearer, (b"content-type", b"application/json")).send()
    assert (wire.status, wire.n_read) == (413, 17)


def test_a_body_declared_over_the_limit_is_refused_unread(house: House) -> None:
    bearer = (b"authorization", f"Bearer {house.token(house.alice)}".encode())
    length = (b"content-length", b"4000000000")
    wire = Wire(house, "/api/v1/patients", bearer, length, (b"content-type", b"application/json")).send()
    assert (wire.status, wire.n_read) == (413, 0)


def test_a_caller_who_goes_away_is_no_crash(house: House, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", "gaitlab.web")
    browser = house.browser(house.alice)
    form = (b"content-type", b"application/x-www-form-urlencoded")
    wire = Wire(
        house,
        "/patients/new",
        form,
        (b"cookie", b"gait=" + browser.secret.encode()),
        (b"sec-fetch-site", b"same-origin"),
    )
    wire.gone_after = 2
    assert wire.send().status == 0
    assert '"status": 499' in caplog.text
    assert "crash" not in caplog.text


def test_a_body_over_the_limit_gets_a_problem_document(house: House) -> None:
    answer = house.program(house.alice).post(
        "/api/v1/patients", content=b"x" * 1_100_000, headers={"Content-Type": "application/json"}
    )
    assert (answer.status_code, answer.json()["code"]) == (413, "too_large")


def test_an_upload_over_its_limit_is_refused_and_stores_nothing(tmp_path: Path) -> None:
    with open_house(tmp_path, max_upload_bytes=100_000) as house:
        patient = house.patient(house.alice)
        big = {"left_foot": ("lf.txt", b"1\t2\n" * 600_000)}
        data = {"date": "2026-11-20", "test": "walk"}
        answer = house.program(house.alice).post(
            f"/api/v1/patients/{patient.id}/sessions", data=data, files=big
        )
        assert answer.status_code == 413
        page = house.browser(house.alice).post(
            f"/patients/{patient.id}/sessions/new", data, files=[("files", ("lf.txt", b"1\t2\n" * 600_000))]
        )
        assert page.status_code == 413
        assert house.n_sessions(patient.id) == 0


def test_a_compressed_request_is_refused(house: House) -> None:
    answer = house.program(house.alice).post(
        "/api/v1/patients", content=b"{}", headers={"Content-Encoding": "gzip"}
    )
    assert (answer.status_code, answer.json()["code"]) == (415, "content_encoding")


def test_a_crash_tells_nothing_but_the_request_number(house: House, caplog: pytest.LogCaptureFixture) -> None:
    secret = "patient Jane Doe"
    router = APIRouter(route_class=GuardedRoute)

    @router.get("/crash")
    @open_to_all("test")
    def crash() -> None:
        raise RuntimeError(secret)

    house.app.include_router(router)
    answer = house.stranger().get("/crash")
    assert answer.status_code == 500
    assert answer.headers["x-request-id"] in answer.text
    assert secret not in answer.text
    assert secret not in caplog.text
    assert "RuntimeError" in caplog.text


def test_the_envelope_alone_refuses_an_answer_that_passed_no_guard() -> None:
    app = FastAPI(openapi_url=None)

    @app.get("/open")
    def unguarded() -> str:
        return LEAK

    app.add_middleware(Envelope, web=WebSettings(), page=web.error_page)
    answer = TestClient(app, base_url=HOST, raise_server_exceptions=False).get("/open")
    assert answer.status_code == 503
    assert LEAK not in answer.text


def test_a_revoked_and_an_unknown_token_are_refused_alike(house: House) -> None:
    answers = [Program(house.app, token).get("/api/v1/patients") for token in ("", "gait_x_y", "nonsense")]
    assert {answer.status_code for answer in answers} == {401}
    assert len({answer.json()["detail"] for answer in answers}) == 1
    assert answers[0].headers["www-authenticate"] == "Bearer"


def test_what_the_guard_refuses_a_known_caller_is_in_the_trail(house: House) -> None:
    bob = house.browser(house.bob)
    assert bob.get("/patients/new").status_code == 403
    assert bob.post("/logout", headers={"Sec-Fetch-Site": "cross-site"}).status_code == 403
    assert bob.post("/logout", {"form_token": "another"}).status_code == 403
    scoped = house.program(house.alice, [Permission.PATIENT_READ])
    assert scoped.post("/api/v1/patients", json={"code": "P-9"}).status_code == 403
    with house.clinic.desk(house.ada) as desk:
        events = audit.list_events(desk).items
    refused = [(one.actor, one.details) for one in events if one.outcome == "refused"]
    assert refused[::-1] == [
        ("Bob", {"code": "not_allowed", "permission": "patient:write"}),
        ("Bob", {"code": "cross_site"}),
        ("Bob", {"code": "form_token"}),
        ("Alice", {"code": "not_allowed", "permission": "patient:write"}),
    ]


def test_a_body_over_the_limit_is_told_the_limit(house: House) -> None:
    answer = house.program(house.alice).post("/api/v1/patients", content=b"x" * 2_000_000)
    assert answer.status_code == 413
    assert "iB" in answer.json()["detail"]
