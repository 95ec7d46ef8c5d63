"""What every request and answer goes through, errors included: number, headers, log line, the last no."""

from __future__ import annotations

import json
import logging
import re
import secrets
import time
import traceback
from types import MappingProxyType

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api.call import Trace, start_trace
from api.errors import ErrorPage, RequestRefused, problem_response
from api.settings import WebSettings
from gaitlab.errors import Misconfigured

CONTENT_SECURITY_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'; object-src 'none'"
)
SECURITY_HEADERS = MappingProxyType(
    {
        "Content-Security-Policy": CONTENT_SECURITY_POLICY,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Permissions-Policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
        "Cache-Control": "no-store",
    }
)
"""Sent with every answer; an answer that carries its own value of one of them keeps it."""

CLIENT_CLOSED_REQUEST = 499
"""In the log only: the caller went away before the answer."""

_HOST = re.compile(r"(?P<name>\[[0-9a-f:.]{2,45}\]|[a-z0-9.-]{1,253})(?::[0-9]{1,5})?")
_WRONG_HOST = RequestRefused(
    "unknown_host",
    "This server does not answer to the name in the request.",
    "Use the address it was started with; further names are allowed by GAITLAB_ALLOWED_HOSTS.",
)
_log = logging.getLogger("gaitlab.web")


class Envelope:
    """The outermost layer of our own: nothing leaves without it, not even the answer to a crash."""

    def __init__(self, app: ASGIApp, *, web: WebSettings, page: ErrorPage) -> None:
        self._app = app
        self._web = web
        self._page = page

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        trace = start_trace(scope, secrets.token_hex(8))
        began = time.monotonic()
        status = 0

        async def send_sealed(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                if message["status"] < 400 and not trace.cleared:
                    raise Misconfigured("not_guarded", "An answer was made without passing the guard.")
                status = message["status"]
                self._seal(MutableHeaders(scope=message), trace)
            await send(message)

        async def tell(error: Exception) -> None:
            await problem_response(Request(scope, receive), error, self._page)(scope, receive, send_sealed)

        try:
            if host_of(scope) in self._web.allowed_hosts:
                await self._app(scope, receive, send_sealed)
            else:
                await tell(_WRONG_HOST)
        except ClientDisconnect:
            status = CLIENT_CLOSED_REQUEST
        except Exception as error:
            _log_crash(error, trace)
            if status:
                raise
            await tell(error)
        finally:
            _log_request(scope, trace, status, began)

    def _seal(self, headers: MutableHeaders, trace: Trace) -> None:
        for name, value in SECURITY_HEADERS.items():
            headers.setdefault(name, value)
        headers["X-Request-ID"] = trace.request_id
        if self._web.behind_tls:
            headers["Strict-Transport-Security"] = "max-age=31536000"


def host_of(scope: Scope) -> str:
    """Name in the Host header, without port; empty where it cannot be one."""
    found = _HOST.fullmatch(Headers(scope=scope).get("host", "").lower())
    return found["name"] if found else ""


def _log_request(scope: Scope, trace: Trace, status: int, began: float) -> None:
    """One line: the route's template, never the URL, so no id, name or query can get into a log."""
    line = {
        "event": "request",
        "request_id": trace.request_id,
        "method": scope["method"],
        "route": trace.route or "-",
        "status": status,
        "ms": round((time.monotonic() - began) * 1000),
        "principal": trace.principal or "-",
    }
    _log.info(json.dumps(line))


def _log_crash(error: Exception, trace: Trace) -> None:
    """Where it happened, without the message: messages can carry values out of a record."""
    where = [
        f"{frame.filename}:{frame.lineno} {frame.name}" for frame in traceback.extract_tb(error.__traceback__)
    ]
    line = {
        "event": "crash",
        "request_id": trace.request_id,
        "error": type(error).__name__,
        "where": where[-12:],
    }
    _log.error(json.dumps(line))
