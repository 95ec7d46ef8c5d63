"""API tokens: made here, shown once, ended here."""

from __future__ import annotations

import re

from fastapi import APIRouter
from starlette.responses import Response

from api.call import Call, CurrentCall
from api.errors import problem_of
from api.guard import GuardedRoute
from api.params import Id
from api.policy import person
from api.web.forms import Typed, typed
from api.web.templates import go, page
from gaitlab.clinic import accounts
from gaitlab.clinic.access import NEVER_FOR_TOKENS, Permission
from gaitlab.errors import InputError

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

SCOPES = {
    Permission.PATIENT_READ: "read patients (codes as pseudonyms)",
    Permission.PATIENT_NAMES: "see patients' codes, diagnoses, notes and file names",
    Permission.PATIENT_WRITE: "add, change and hide patients",
    Permission.SESSION_READ: "read sessions, results and series",
    Permission.SESSION_WRITE: "upload and analyse walks",
    Permission.REPORT_READ: "read reports",
}


@router.get("/tokens")
@person(Permission.TOKEN_MANAGE)
def show(call: CurrentCall) -> Response:
    return _page(call, Typed({"days": "90"}))


@router.post("/tokens")
@person(Permission.TOKEN_MANAGE)
def add(call: CurrentCall) -> Response:
    """Answers with the page itself: the text must be shown once and stand in no address."""
    form = typed(call.form, ("name", "days"), never_kept=("scopes",))
    scopes = [str(scope) for scope in call.form.getlist("scopes")]
    try:
        if not re.fullmatch(r"[0-9]{1,4}", form.value("days")):
            raise InputError("invalid_field", "This must be a whole number of days.", column="days")
        if any(scope not in SCOPES for scope in scopes):
            raise InputError("invalid_field", "There is no such permission.", column="scopes")
        with call.desk() as desk:
            secret, token = accounts.add_token(
                desk,
                name=form.value("name"),
                permissions=[Permission(scope) for scope in scopes],
                days=int(form.value("days")),
            )
    except InputError as error:
        column = "scopes" if error.column == "permissions" else error.column
        problem = problem_of(error).model_copy(update={"column": column})
        return _page(call, form.with_problem(problem), scopes=scopes, status=problem.status)
    return _page(call, Typed({"days": "90"}), secret=secret, made=token.name)


@router.post("/tokens/{token_id}/revoke")
@person(Permission.TOKEN_MANAGE)
def revoke(token_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        accounts.revoke_token(desk, token_id)
    return go("/tokens")


def _page(
    call: Call,
    form: Typed,
    *,
    scopes: list[str] | None = None,
    secret: str = "",
    made: str = "",
    status: int = 200,
) -> Response:
    with call.desk() as desk:
        tokens = accounts.list_tokens(desk)
    mine = {
        scope: words for scope, words in SCOPES.items() if call.may(scope) and scope not in NEVER_FOR_TOKENS
    }
    return page(
        call,
        "tokens.html",
        status,
        tokens=tokens,
        form=form,
        chosen=scopes or [],
        scopes=mine,
        secret=secret,
        made=made,
    )
