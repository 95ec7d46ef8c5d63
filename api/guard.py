"""Deny by default: a route runs only after its policy let the request in; without one nothing starts."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Iterator
from typing import Any

from fastapi import FastAPI
from fastapi.routing import APIRoute, iter_route_contexts
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Message, Receive

from api.call import Call, form_token, trace_of
from api.errors import RequestRefused, UnsupportedBody
from api.origin import SAFE_METHODS, TOKEN_FIELD, TOKEN_HEADER, check_form_token, check_same_origin
from api.policy import Credential, Policy, policy_of
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.access import Principal
from gaitlab.clinic.clinic import Clinic
from gaitlab.errors import Misconfigured, NotAllowed, NotLoggedIn

MAX_FILES = 64
MAX_FIELDS = 256
MULTIPART_OVERHEAD_BYTES = 1024 * 1024
Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class GuardedRoute(APIRoute):
    """A route that authorises from the policy of the endpoint that was matched, before the body is read.

    The matched route decides, never the URL: a forged Host header or a doubled slash changes nothing.
    """

    def get_route_handler(self) -> Handler:
        run = super().get_route_handler()
        policy = policy_of(self.endpoint)
        template = self.path

        async def guarded(request: Request) -> Response:
            trace_of(request).route = template
            if policy is None:
                raise _without_policy([template])
            request = Request(request.scope, _limited(request, policy))
            try:
                request.state.call = await _let_in(request, policy)
                trace_of(request).cleared = True
                return await run(request)
            finally:
                await request.close()

        return guarded


async def _let_in(request: Request, policy: Policy) -> Call:
    clinic: Clinic = request.app.state.clinic
    web: WebSettings = request.app.state.web
    secret, bearer = request.cookies.get(web.cookie_name, ""), _bearer(request)
    _check_envelope(request, secret, bearer)
    unsafe = request.method not in SAFE_METHODS
    if unsafe and policy.credentials != {Credential.BEARER}:
        check_same_origin(request)
    caller = None if policy.is_open else await run_in_threadpool(_recognise, clinic, policy, secret, bearer)
    if caller is not None:
        trace_of(request).principal = caller.user_id
        _check_permission(caller, policy)
    form = await _form(request) if unsafe else FormData()
    if unsafe and caller is not None and not bearer:
        given = request.headers.get(TOKEN_HEADER) or str(form.get(TOKEN_FIELD, ""))
        check_form_token(form_token(clinic.form_key(), secret), given)
    return Call(
        clinic=clinic,
        web=web,
        request_id=trace_of(request).request_id,
        address=request.client.host if request.client else "",
        caller=caller,
        session_secret="" if bearer or caller is None else secret,
        form=form,
    )


def _recognise(clinic: Clinic, policy: Policy, secret: str, bearer: str) -> Principal:
    """Who is calling, by a credential that this route takes."""
    caller = None
    if bearer and Credential.BEARER in policy.credentials:
        caller = accounts.principal_of_token(clinic, bearer)
    elif secret and Credential.COOKIE in policy.credentials:
        caller = accounts.principal_of_session(clinic, secret)
    if caller is not None:
        return caller
    if policy.credentials == {Credential.BEARER}:
        hint = (
            "Send a valid token in the header “Authorization: Bearer …”; tokens are made on the page /tokens."
        )
        raise NotLoggedIn("not_logged_in", "The token is missing, wrong, expired or revoked.", hint)
    raise NotLoggedIn(
        "not_logged_in", "You are not logged in, or were logged out after a while.", "Log in again."
    )


def _check_permission(caller: Principal, policy: Policy) -> None:
    if policy.permission is not None and policy.permission not in caller.permissions:
        raise NotAllowed(
            "not_allowed",
            "Your account or token may not do this.",
            f"It lacks the permission “{policy.permission}”. Ask an administrator of your site.",
        )


def _check_envelope(request: Request, secret: str, bearer: str) -> None:
    if secret and bearer:
        raise RequestRefused(
            "two_credentials",
            "The request carries both a session cookie and a token.",
            "Send one of them: the cookie for pages, the token for REST.",
        )
    if request.headers.get("content-encoding", "identity").lower() != "identity":
        raise UnsupportedBody(
            "content_encoding",
            "Compressed requests are not taken.",
            "Send the body without Content-Encoding.",
        )


def _bearer(request: Request) -> str:
    scheme, _, value = request.headers.get("authorization", "").partition(" ")
    return value.strip() if scheme.lower() == "bearer" else ""


async def _form(request: Request) -> FormData:
    """Read the body of a form; the request keeps it, so nobody reads it twice."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind not in ("multipart/form-data", "application/x-www-form-urlencoded"):
        return FormData()
    return await request.form(max_files=MAX_FILES, max_fields=MAX_FIELDS)


def _limited(request: Request, policy: Policy) -> Receive:
    """Count the body as it comes and stop at the limit; a declared length is believed only to refuse."""
    clinic: Clinic = request.app.state.clinic
    web: WebSettings = request.app.state.web
    upload = clinic.settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES
    limit = upload if policy.upload else web.small_body_bytes
    declared = request.headers.get("content-length", "")
    receive = request.receive
    seen = 0

    async def counted() -> Message:
        nonlocal seen
        if declared.isdigit() and int(declared) > limit:
            raise HTTPException(413)
        message = await receive()
        seen += len(message.get("body", b""))
        if seen > limit:
            raise HTTPException(413)
        return message

    return counted


def audit(app: FastAPI) -> None:
    """Refuse an application in which any route could answer without a policy.

    Raises
    ------
    Misconfigured
        Naming every such route: without a policy, or of another class (mounts, static folders, web sockets,
        the framework's own pages).
    """
    bad = [path for path, guarded in _routes(app) if not guarded]
    if bad:
        raise _without_policy(bad)


def _routes(app: FastAPI) -> Iterator[tuple[str, bool]]:
    for context in iter_route_contexts(app.routes):
        route = context.original_route
        yield (
            context.path or repr(route),
            isinstance(route, GuardedRoute) and policy_of(route.endpoint) is not None,
        )
    # Fallback routes (``app.frontend``) are in no public list.
    for low in app.router._iter_low_priority_routes():
        yield repr(low), False


def _without_policy(paths: list[str]) -> Misconfigured:
    return Misconfigured(
        "route_without_policy",
        f"No policy says who may use {', '.join(paths)}; nothing is served.",
        "Give each endpoint one of the decorators of api.policy, on a router with route_class=GuardedRoute.",
    )
