"""The pages' template environment: everything escaped, nothing undefined passes silently."""

from __future__ import annotations

import datetime as dt
import hashlib
from functools import lru_cache
from importlib import resources
from typing import Any

from jinja2 import Environment
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from api.call import Call, trace_of
from api.errors import Problem
from api.web import text
from gaitlab import __version__
from gaitlab.report import template_environment


@lru_cache(maxsize=1)
def environment() -> Environment:
    """The reports' environment (all is escaped, nothing undefined is silent) with what pages need besides."""
    made = template_environment()
    made.globals.update(static=static_url, version=__version__, today=_today)
    made.filters.update(text.FILTERS)
    return made


def page(call: Call | None, template: str, status: int = 200, **values: Any) -> HTMLResponse:
    """Render a page. ``call`` is None where nobody is known: the page then has no navigation."""
    content = environment().get_template(template).render(call=call, **values)
    return HTMLResponse(content, status)


def go(path: str) -> RedirectResponse:
    """Send the browser on after a form (POST, redirect, GET)."""
    return RedirectResponse(path, 303)


def error_page(request: Request, problem: Problem) -> Response:
    """An error as a page, with a way on; who is not logged in is led to the log-in."""
    if problem.status == 401 and request.method == "GET":
        trace_of(request).cleared = True  # the answer shows nothing but the way to the log-in
        return go(login_url(request.scope["path"]))
    call = getattr(request.state, "call", None)
    log_in = _login_from(request) if problem.status == 401 else ""
    return page(call, "error.html", problem.status, problem=problem, log_in=log_in)


def _login_from(request: Request) -> str:
    """The log-in, coming back to the form that was sent, where its address shows it."""
    path: str = request.scope["path"]
    return login_url(path if path.endswith(("/new", "/edit", "/tokens")) else "/")


def login_url(path: str) -> str:
    """The log-in, coming back to ``path``."""
    return "/login" if path in ("/", "/login", "/logout") else f"/login?next={text.quote(path)}"


def _today() -> str:
    """The day where the server stands: that is where the patient walks."""
    return dt.datetime.now().astimezone().date().isoformat()


@lru_cache(maxsize=32)
def static_file(name: str) -> tuple[bytes, str]:
    """Content of a file in ``api/static`` and the first 16 digits of its SHA-256."""
    content = resources.files("api").joinpath("static", name).read_bytes()
    return content, hashlib.sha256(content).hexdigest()[:16]


def static_url(name: str) -> str:
    """Where a static file is; the address changes with the content, so it may be kept for ever."""
    return f"/static/{name}?v={static_file(name)[1]}"
