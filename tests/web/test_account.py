"""First account, log-in, log-out, tokens."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from api.app import create_app
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.clinic import Clinic, ClinicSettings
from tests.api.visitors import House, Program, Visitor, soup
from tests.clinic.people import PASSWORD

GOOD = {"email": "anna@clinic.example", "name": "Anna", "password": PASSWORD, "password_again": PASSWORD}


@pytest.fixture
def new(tmp_path: Path) -> Iterator[tuple[Clinic, Visitor]]:
    """An installation without an account, and a browser in front of it."""
    clinic = Clinic.open(ClinicSettings(tmp_path / "data"))
    yield clinic, Visitor(create_app(clinic, WebSettings()))
    clinic.close()


def test_a_new_installation_leads_to_the_set_up(new: tuple[Clinic, Visitor]) -> None:
    _, browser = new
    assert browser.get("/").headers["location"] == "/login"
    assert browser.get("/login").headers["location"] == "/setup"
    assert browser.soup("/setup").select_one("input[name=code]") is not None


def test_the_first_account_is_made_with_the_code_and_can_log_in(new: tuple[Clinic, Visitor]) -> None:
    clinic, browser = new
    code = accounts.setup_code(clinic)
    made = browser.post("/setup", {**GOOD, "code": code})
    assert (made.status_code, made.headers["location"]) == (303, "/login?new=1")
    assert "account is ready" in browser.get("/login?new=1").text
    entered = browser.post("/login", {"email": GOOD["email"], "password": PASSWORD})
    assert (entered.status_code, entered.headers["location"]) == (303, "/")
    assert "Add the first patient" in browser.get("/").text


@pytest.mark.parametrize(
    ("wrong", "status", "where"),
    [
        ({"code": "not-the-code"}, 403, ".notice.bad"),
        ({"password": "short", "password_again": "short"}, 422, "#password-error"),
        ({"password": "password1234", "password_again": "password1234"}, 422, "#password-error"),
        ({"password_again": "another one"}, 422, "#password_again-error"),
        ({"email": "nobody"}, 422, "#email-error"),
        ({"name": ""}, 422, "#name-error"),
    ],
)
def test_a_wrong_set_up_says_what_and_keeps_the_rest(
    new: tuple[Clinic, Visitor], wrong: dict[str, str], status: int, where: str
) -> None:
    clinic, browser = new
    code = accounts.setup_code(clinic)
    answer = browser.post("/setup", {**GOOD, "code": code, **wrong})
    page = soup(answer)
    assert answer.status_code == status
    assert page.select_one(where) is not None
    for field in {"email", "name"} - set(wrong):
        assert page.select_one(f"input[name={field}]")["value"] == GOOD[field]  # type: ignore[index]
    assert "value" not in page.select_one("input[name=password]").attrs  # type: ignore[union-attr]
    assert accounts.needs_setup(clinic)


def test_the_code_makes_one_account_only(new: tuple[Clinic, Visitor]) -> None:
    clinic, browser = new
    code = accounts.setup_code(clinic)
    browser.post("/setup", {**GOOD, "code": code})
    assert browser.get("/setup").headers["location"] == "/login"
    again = browser.post("/setup", {**GOOD, "email": "eve@clinic.example", "code": code})
    assert again.status_code == 409


def test_unknown_person_and_wrong_password_get_the_same_words(house: House) -> None:
    answers = [
        house.stranger().post("/login", {"email": email, "password": "wrong"})
        for email in ("alice@clinic.example", "nobody@clinic.example")
    ]
    words = [re.sub(r'value="[^"]*"', "", answer.text) for answer in answers]
    assert [answer.status_code for answer in answers] == [401, 401]
    assert words[0] == words[1]
    assert "set-cookie" not in answers[0].headers


def test_too_many_attempts_are_slowed(house: House) -> None:
    browser = house.stranger()
    answers = [
        browser.post("/login", {"email": "alice@clinic.example", "password": "wrong"}) for _ in range(12)
    ]
    assert answers[0].status_code == 401
    assert answers[-1].status_code == 429
    assert soup(answers[-1]).select_one(".notice.bad") is not None


def test_the_log_in_comes_back_to_where_one_was(house: House) -> None:
    browser = house.stranger()
    sent_away = browser.get("/patients/new").headers["location"]
    assert sent_away == "/login?next=/patients/new"
    back = browser.soup(sent_away).select_one("input[name=next]")
    assert back is not None
    data = {"email": "alice@clinic.example", "password": PASSWORD, "next": str(back["value"])}
    assert browser.post("/login", data).headers["location"] == "/patients/new"


@pytest.mark.parametrize(
    "elsewhere", ["https://evil.example", "//evil.example", "/\\evil.example", "/a\r\nX: y", "javascript:x"]
)
def test_the_log_in_never_leads_to_another_site(house: House, elsewhere: str) -> None:
    data = {"email": "alice@clinic.example", "password": PASSWORD, "next": elsewhere}
    assert house.stranger().post("/login", data).headers["location"] == "/"


def test_logging_out_ends_the_session_on_the_server(house: House) -> None:
    browser = house.browser(house.alice)
    other = Visitor(house.app, browser.secret)
    answer = browser.post("/logout")
    assert (answer.status_code, answer.headers["location"]) == (303, "/login")
    assert "Max-Age=0" in answer.headers["set-cookie"]
    assert other.get("/").status_code == 303


def test_a_token_is_shown_once_works_and_is_revoked(house: House) -> None:
    browser = house.browser(house.alice)
    made = browser.post(
        "/tokens", {"name": "pipeline", "days": "30", "scopes": ["patient:read", "patient:names"]}
    )
    text = soup(made).select_one(".secret-text").get_text()  # type: ignore[union-attr]
    assert text.startswith("gait_")
    program = Program(house.app, text)
    assert program.get("/api/v1/patients").status_code == 200
    assert program.post("/api/v1/patients", json={"code": "x"}).status_code == 403
    page = browser.soup("/tokens")
    assert text not in str(page)
    form = page.select_one("form[action$=revoke]")
    assert form is not None
    assert browser.post(str(form["action"])).status_code == 303
    assert program.get("/api/v1/patients").status_code == 401
    assert "revoked" in browser.soup("/tokens").select_one("table").get_text()  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        ({"name": ""}, "#name-error"),
        ({"days": "0"}, "#days-error"),
        ({"days": "366"}, "#days-error"),
        ({"days": "many"}, "#days-error"),
        ({"days": "9" * 5000}, "#days-error"),
        ({"scopes": []}, "#scopes-error"),
        ({"scopes": ["token:manage"]}, "#scopes-error"),
        ({"scopes": ["everything"]}, "#scopes-error"),
    ],
)
def test_a_wrong_token_form_says_what_and_makes_none(
    house: House, wrong: dict[str, object], where: str
) -> None:
    browser = house.browser(house.alice)
    answer = browser.post("/tokens", {"name": "n", "days": "30", "scopes": ["patient:read"], **wrong})
    assert answer.status_code == 422
    assert soup(answer).select_one(where) is not None
    assert browser.soup("/tokens").select_one("table") is None


def test_an_engineer_can_only_give_a_token_what_they_have(house: House) -> None:
    offered = {
        str(box["value"]) for box in house.browser(house.erik).soup("/tokens").select("input[name=scopes]")
    }
    assert "session:write" in offered
    assert not offered & {"patient:write", "patient:names", "token:manage"}
    answer = house.browser(house.erik).post(
        "/tokens", {"name": "n", "days": "1", "scopes": ["patient:write"]}
    )
    assert answer.status_code in (403, 422)


def test_an_account_that_may_not_see_patients_starts_at_the_tokens(house: House) -> None:
    form = {"email": "ada@clinic.example", "password": PASSWORD, "next": "/"}
    answer = house.stranger().post("/login", form)
    assert (answer.status_code, answer.headers["location"]) == (303, "/tokens")
    assert house.browser(house.ada).get("/tokens").status_code == 200


def test_a_form_sent_after_the_log_in_ended_leads_to_the_log_in(house: House) -> None:
    browser = house.browser(house.alice)
    browser.post("/logout")
    answer = browser.post("/patients/new", {"code": "P-1"})
    assert answer.status_code == 401
    assert soup(answer).select_one('main a[href="/login?next=/patients/new"]') is not None
