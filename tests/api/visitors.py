"""Who comes to the web application in tests, and how: a browser with its cookie, a program with its token."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from bs4 import BeautifulSoup
from fastapi import FastAPI
from starlette.testclient import TestClient

from api.app import create_app
from api.call import form_token
from api.settings import WebSettings
from gaitlab.clinic import accounts, patients, sessions
from gaitlab.clinic.access import Permission, Principal, Role
from gaitlab.clinic.clinic import Clinic, ClinicSettings
from gaitlab.clinic.views import PatientForm, PatientView, SessionForm, SessionView
from gaitlab.recording import InputFile, Placement
from tests.clinic.people import PASSWORD, add_person, add_site
from tests.recordings import short_walk

HOST = "http://localhost"
SAME_ORIGIN = {"Sec-Fetch-Site": "same-origin"}
REST_SCOPES = (
    Permission.PATIENT_READ,
    Permission.PATIENT_WRITE,
    Permission.PATIENT_NAMES,
    Permission.SESSION_READ,
    Permission.SESSION_WRITE,
    Permission.REPORT_READ,
)


class Visitor:
    """A browser: keeps its cookie, sends forms with their token, follows nothing by itself."""

    def __init__(self, app: FastAPI, secret: str = "") -> None:
        self._app = app
        self.secret = secret
        cookies = {app.state.web.cookie_name: secret} if secret else {}
        self.client = TestClient(
            app, base_url=HOST, cookies=cookies, follow_redirects=False, raise_server_exceptions=False
        )

    @property
    def token(self) -> str:
        """What this visitor's forms carry."""
        return form_token(self._app.state.clinic.form_key(), self.secret)

    def get(self, path: str, **more: Any) -> Any:
        return self.client.get(path, **more)

    def post(self, path: str, data: dict[str, Any] | None = None, **more: Any) -> Any:
        headers = {**SAME_ORIGIN, **more.pop("headers", {})}
        fields = {**({"form_token": self.token} if self.secret else {}), **(data or {})}
        return self.client.post(path, data=fields, headers=headers, **more)

    def soup(self, path: str) -> BeautifulSoup:
        answer = self.get(path)
        assert answer.status_code == 200, (path, answer.status_code)
        return soup(answer)


class Program:
    """A REST client: sends its token, keeps no cookie."""

    def __init__(self, app: FastAPI, token: str) -> None:
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        self.client = TestClient(
            app, base_url=HOST, headers=headers, follow_redirects=False, raise_server_exceptions=False
        )

    def request(self, method: str, path: str, **more: Any) -> Any:
        return self.client.request(method, path, **more)

    def get(self, path: str, **more: Any) -> Any:
        return self.client.get(path, **more)

    def post(self, path: str, **more: Any) -> Any:
        return self.client.post(path, **more)


def soup(answer: Any) -> BeautifulSoup:
    """An answer's page."""
    return BeautifulSoup(answer.text, "html.parser")


@dataclass(frozen=True)
class House:
    """An application on a clinic of its own: Alice (clinician), Bob (reader), Erik (engineer) and Ada (admin) at one
    site, Charlie at another.
    """

    clinic: Clinic
    app: FastAPI
    alice: Principal
    bob: Principal
    erik: Principal
    ada: Principal
    charlie: Principal

    def browser(self, who: Principal) -> Visitor:
        """Somebody logged in."""
        secret, _ = accounts.log_in(
            self.clinic, email=f"{who.name.lower()}@clinic.example", password=PASSWORD, address="127.0.0.1"
        )
        return Visitor(self.app, secret)

    def stranger(self) -> Visitor:
        """A browser that is not logged in."""
        return Visitor(self.app)

    def token(self, who: Principal, scopes: Iterable[Permission] = REST_SCOPES, days: int = 1) -> str:
        """The text of a new API token."""
        with self.clinic.desk(who) as desk:
            text, _ = accounts.add_token(desk, name="test", permissions=scopes, days=days)
        return text

    def program(self, who: Principal, scopes: Iterable[Permission] = REST_SCOPES) -> Program:
        """A program with a new token."""
        return Program(self.app, self.token(who, scopes))

    def patient(self, who: Principal, code: str = "P-1", **fields: Any) -> PatientView:
        """A stored patient."""
        with self.clinic.desk(who) as desk:
            return patients.add_patient(desk, PatientForm(code=code, **fields))

    def session(self, who: Principal, patient_id: str, note: str = "") -> SessionView:
        """A stored session of a short simulated walk."""
        form = SessionForm(date=dt.date(2026, 11, 20), test="walk", note=note)
        with self.clinic.desk(who) as desk:
            return sessions.add_session(desk, patient_id, form, short_walk())

    def n_sessions(self, patient_id: str) -> int:
        with self.clinic.desk(self.alice) as desk:
            return len(sessions.list_sessions(desk, patient_id))


@contextmanager
def open_house(folder: Path, *, web: WebSettings | None = None, **limits: Any) -> Iterator[House]:
    """An application with its people on a new SQLite database in ``folder``."""
    clinic = Clinic.open(replace(ClinicSettings(folder / "data"), **limits))
    try:
        here, elsewhere = accounts.console(clinic).site_id, add_site(clinic, "elsewhere")
        yield House(
            clinic=clinic,
            app=create_app(clinic, web or WebSettings()),
            alice=add_person(clinic, here, "Alice", Role.CLINICIAN),
            bob=add_person(clinic, here, "Bob", Role.READER),
            erik=add_person(clinic, here, "Erik", Role.ENGINEER),
            ada=add_person(clinic, here, "Ada", Role.ADMIN),
            charlie=add_person(clinic, elsewhere, "Charlie", Role.CLINICIAN, Role.ADMIN),
        )
    finally:
        clinic.close()


def as_uploads(files: dict[Placement, InputFile]) -> dict[str, tuple[str, bytes]]:
    """Files as REST takes them, under the name of their placement."""
    return {place.value: (file.name, file.content) for place, file in files.items()}


def as_choice(files: Iterable[InputFile]) -> list[tuple[str, tuple[str, bytes]]]:
    """Files as the form takes them, all in one field."""
    return [("files", (file.name, file.content)) for file in files]


__all__ = [
    "HOST",
    "SAME_ORIGIN",
    "House",
    "Program",
    "Visitor",
    "as_choice",
    "as_uploads",
    "open_house",
    "soup",
]
