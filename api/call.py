"""One request that passed the guard: who is calling, from where, and the way to the clinic."""

from __future__ import annotations

import hashlib
import hmac
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated

from fastapi import Depends
from starlette.datastructures import FormData
from starlette.requests import Request

from api.settings import WebSettings
from gaitlab.clinic.access import Permission, Principal
from gaitlab.clinic.clinic import Clinic, Desk
from gaitlab.errors import NotLoggedIn

if TYPE_CHECKING:
    from starlette.types import Scope

_TRACE = "gaitlab.trace"


@dataclass
class Trace:
    """What the log line of a request will say; filled in on its way through.

    Attributes
    ----------
    cleared : bool
        The guard has let the request through. No answer below 400 leaves the house without it.
    """

    request_id: str
    route: str = ""
    principal: str = ""
    cleared: bool = False


def start_trace(scope: Scope, request_id: str) -> Trace:
    """Attach a new trace to a request."""
    trace = Trace(request_id)
    scope[_TRACE] = trace
    return trace


def trace_of(request: Request) -> Trace:
    """The trace of a request."""
    trace = request.scope[_TRACE]
    assert isinstance(trace, Trace)
    return trace


@dataclass(frozen=True)
class Call:
    """An authorised request.

    Attributes
    ----------
    caller : Principal or None
        None only on routes open to everyone.
    session_secret : str
        Value of the session cookie; empty for tokens and on open routes.
    form : FormData
        Fields and files of an unsafe request's form; empty otherwise.
    """

    clinic: Clinic
    web: WebSettings
    request_id: str
    address: str
    caller: Principal | None = None
    session_secret: str = ""
    form: FormData = field(default_factory=FormData)

    @property
    def principal(self) -> Principal:
        if self.caller is None:
            raise NotLoggedIn("not_logged_in", "You are not logged in.", "Log in and try again.")
        return self.caller

    def may(self, permission: Permission | str) -> bool:
        """May the caller do this? For showing or hiding a button; the clinic decides for itself."""
        return self.caller is not None and Permission(permission) in self.caller.permissions

    def desk(self) -> AbstractContextManager[Desk]:
        """The desk in the clinic: one transaction, committed once on leaving it."""
        return self.clinic.desk(self.principal, request_id=self.request_id, address=self.address)

    @property
    def form_token(self) -> str:
        """What every form of this web session carries, and no other site can know."""
        return form_token(self.clinic.form_key(), self.session_secret) if self.session_secret else ""


def form_token(key: bytes, session_secret: str) -> str:
    """HMAC-SHA256 of a web session's secret."""
    return hmac.new(
        key, b"form:" + hashlib.sha256(session_secret.encode()).digest(), hashlib.sha256
    ).hexdigest()


async def _current_call(request: Request) -> Call:
    call = request.state.call
    assert isinstance(call, Call)
    return call


CurrentCall = Annotated[Call, Depends(_current_call)]
