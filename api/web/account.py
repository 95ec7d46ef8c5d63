"""First account, log-in and log-out."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from api.call import Call, CurrentCall
from api.errors import problem_of
from api.guard import GuardedRoute
from api.policy import open_to_all, person
from api.web.forms import Typed, typed
from api.web.templates import go, page
from gaitlab.clinic import accounts
from gaitlab.clinic.access import Permission, Principal
from gaitlab.errors import GaitlabError

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

_SETUP = ("code", "email", "name")
_WHY_SETUP = "The first account can only be made before there is one, with the one-time code of the console."
_WHY_LOGIN = "Who logs in is not logged in yet."


@router.get("/setup")
@open_to_all(_WHY_SETUP)
def show_setup(call: CurrentCall) -> Response:
    if not accounts.needs_setup(call.clinic):
        return go("/login")
    return page(None, "setup.html", form=Typed())


@router.post("/setup")
@open_to_all(_WHY_SETUP)
def set_up(call: CurrentCall) -> Response:
    form = typed(call.form, _SETUP, never_kept=("password",))
    password = str(call.form.get("password", ""))
    try:
        if password != str(call.form.get("password_again", "")):
            return page(
                None, "setup.html", 422, form=Typed(form.values, {"password_again": "The two differ."})
            )
        accounts.create_first_account(
            call.clinic,
            code=form.value("code"),
            email=form.value("email"),
            name=form.value("name"),
            password=password,
            address=call.address,
        )
    except GaitlabError as error:
        problem = problem_of(error)
        return page(None, "setup.html", problem.status, form=form.with_problem(problem))
    return go("/login?new=1")


@router.get("/login")
@open_to_all(_WHY_LOGIN)
def show_login(
    call: CurrentCall, next_: Annotated[str, Query(alias="next", max_length=300)] = "/", new: str = ""
) -> Response:
    if accounts.needs_setup(call.clinic):
        return go("/setup")
    return page(None, "login.html", form=Typed({"next": _inside(next_)}), new=bool(new))


@router.post("/login")
@open_to_all(_WHY_LOGIN)
def log_in(call: CurrentCall) -> Response:
    form = typed(call.form, ("email", "next"))
    password = str(call.form.get("password", ""))
    try:
        secret, who = accounts.log_in(
            call.clinic, email=form.value("email"), password=password, address=call.address
        )
    except GaitlabError as error:
        problem = problem_of(error)
        return page(None, "login.html", problem.status, form=Typed(form.values, problem=problem), new=False)
    answer = go(_start(who, _inside(form.value("next"))))
    _set_cookie(call, answer, secret)
    return answer


@router.post("/logout")
@person()
def log_out(call: CurrentCall) -> Response:
    accounts.log_out(call.clinic, call.session_secret)
    answer = go("/login")
    _set_cookie(call, answer, "")
    return answer


def _set_cookie(call: Call, answer: Response, secret: str) -> None:
    """A cookie for as long as the browser is open; the server ends the session sooner. Empty: remove it."""
    answer.set_cookie(
        call.web.cookie_name,
        secret,
        max_age=None if secret else 0,
        path="/",
        secure=call.web.behind_tls,
        httponly=True,
        samesite="lax",
    )


def _start(who: Principal, path: str) -> str:
    """Where a log-in leads; who may not see the list of patients starts where they have something to do."""
    return "/tokens" if path == "/" and Permission.PATIENT_READ not in who.permissions else path


def _inside(path: str) -> str:
    """A path of this server, or the start page: never the way to another site."""
    plain = path.startswith("/") and not path.startswith("//") and "\\" not in path and path.isprintable()
    return path if plain else "/"
