"""Deny by default: a route runs only after its policy let the request in; without one nothing starts."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Iterator
from typing import Any

from fastapi import FastAPI
from fastapi.routing import APIRoute, iter_route_contexts
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.requests import Request
from starlette.responses import Response

from api.body import Body, read_form
from api.call import Call, form_token, trace_of
from api.errors import RequestRefused, UnsupportedBody
from api.origin import SAFE_METHODS, TOKEN_FIELD, TOKEN_HEADER, check_form_token, check_same_origin
from api.policy import Credential, Policy, policy_of
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.access import Principal
from gaitlab.clinic.audit import record_refusal
from gaitlab.clinic.clinic import Clinic
from gaitlab.errors import Misconfigured, NotAllowed, NotLoggedIn

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
            body = Body(request.receive, request.headers.get("content-length", ""), _limit(request, policy))
            request = Request(request.scope, body.receive)
            try:
                request.state.call = await _let_in(request, policy, body)
                trace_of(request).cleared = True
                return await run(request)
            finally:
                await request.close()

        return guarded


async def _let_in(request: Request, policy: Policy, body: Body) -> Call:
    clinic: Clinic = request.app.state.clinic
    web: WebSettings = request.app.state.web
    secret, bearer = request.cookies.get(web.cookie_name, ""), _bearer(request)
    _check_envelope(request, secret, bearer)
    unsafe = request.method not in SAFE_METHODS
    caller: Principal | None = None
    form = FormData()
    try:
        if unsafe and policy.credentials != {Credential.BEARER}:
            check_same_origin(request)
        caller = (
            None if policy.is_open else await run_in_threadpool(_recognise, clinic, policy, secret, bearer)
        )
        if caller is not None:
            trace_of(request).principal = caller.user_id
            _check_permission(caller, policy)
        form = await read_form(request, body, only_forms=policy.upload) if unsafe else form
        if unsafe and caller is not None and not bearer:
            given = request.headers.get(TOKEN_HEADER) or str(form.get(TOKEN_FIELD, ""))
            check_form_token(form_token(clinic.form_key(), secret), given)
    except NotAllowed as refusal:
        await run_in_threadpool(_note, request, policy, refusal, caller, secret, bearer)
        raise
    return Call(
        clinic=clinic,
        web=web,
        request_id=trace_of(request).request_id,
        address=_address(request),
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


def _note(
    request: Request, policy: Policy, refusal: NotAllowed, caller: Principal | None, secret: str, bearer: str
) -> None:
    """Put the refusal of a known caller into the audit trail; what nobody in particular tried is in the log."""
    clinic: Clinic = request.app.state.clinic
    if caller is None and not policy.is_open:
        try:
            caller = _recognise(clinic, policy, secret, bearer)
        except NotLoggedIn:
            return
    if caller is not None:
        record_refusal(
            clinic,
            caller,
            policy.permission,
            code=refusal.code,
            request_id=trace_of(request).request_id,
            address=_address(request),
        )


def _address(request: Request) -> str:
    return request.client.host if request.client else ""


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


def _limit(request: Request, policy: Policy) -> int:
    clinic: Clinic = request.app.state.clinic
    web: WebSettings = request.app.state.web
    upload = clinic.settings.max_upload_bytes + MULTIPART_OVERHEAD_BYTES
    return upload if policy.upload else web.small_body_bytes


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
