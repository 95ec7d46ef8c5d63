"""A new session or a further trial: one form, with or without JavaScript."""

from __future__ import annotations

import re
import secrets
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from fastapi import APIRouter
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from api import uploads
from api.call import Call, CurrentCall
from api.errors import problem_of, wants_problem_document
from api.guard import GuardedRoute
from api.params import KEY_PATTERN, Id
from api.policy import person
from api.web.forms import Typed, check, decimal, typed
from api.web.templates import go, page
from gaitlab.clinic import patients, sessions
from gaitlab.clinic.access import Permission
from gaitlab.clinic.sessions import InspectedFile
from gaitlab.clinic.views import COURSE_M, SessionForm
from gaitlab.errors import Conflict, InputError

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

FIELDS = ("date", "test", "course_m", "note")
KEY_FIELD = "idempotency_key"


@router.get("/patients/{patient_id}/sessions/new")
@person(Permission.SESSION_WRITE)
def show_new_session(patient_id: Id, call: CurrentCall) -> Response:
    return _session_page(call, patient_id, Typed({KEY_FIELD: _new_key(), "test": "t25fw"}))


@router.post("/patients/{patient_id}/sessions/inspect")
@person(Permission.SESSION_WRITE, upload=True)
def inspect(patient_id: Id, call: CurrentCall) -> Response:
    """What each file is, for the form's script; stores nothing."""
    with call.desk() as desk:
        patients.get_patient(desk, patient_id)
        found, errors = uploads.inspect_all(desk, uploads.files_of(call.form, "files"))
    problems = [problem_of(error).model_dump(mode="json") for error in errors]
    return JSONResponse({"files": [asdict(one) for one in found], "problems": problems})


@router.post("/patients/{patient_id}/sessions/new")
@person(Permission.SESSION_WRITE, upload=True)
def add_session(patient_id: Id, call: CurrentCall, request: Request) -> Response:
    form = typed(call.form, (*FIELDS, KEY_FIELD), never_kept=("files",))
    data: dict[str, Any] = {name: form.value(name) for name in FIELDS}
    checked, errors = check(SessionForm, {**data, "course_m": decimal(form.value("course_m"))})
    form = Typed(form.values, errors)
    try:
        if checked is None:
            field, message = next(iter(errors.items()))
            raise InputError("invalid_field", message, column=field)
        with call.desk() as desk:
            placed = uploads.place(
                desk, uploads.files_of(call.form, "files"), uploads.chosen_placements(call.form)
            )
            session = sessions.add_session(
                desk, patient_id, checked, placed, idempotency_key=_key(form.value(KEY_FIELD))
            )
    except (InputError, Conflict) as error:
        if wants_problem_document(request):
            raise
        return _session_page(call, patient_id, _with(form, error), error)
    return _created(request, f"/sessions/{session.id}")


@router.get("/sessions/{session_id}/trials/new")
@person(Permission.SESSION_WRITE)
def show_new_trial(session_id: Id, call: CurrentCall) -> Response:
    return _trial_page(call, session_id, Typed({KEY_FIELD: _new_key()}))


@router.post("/sessions/{session_id}/trials/new")
@person(Permission.SESSION_WRITE, upload=True)
def add_trial(session_id: Id, call: CurrentCall, request: Request) -> Response:
    form = typed(call.form, (KEY_FIELD,), never_kept=("files",))
    try:
        with call.desk() as desk:
            placed = uploads.place(
                desk, uploads.files_of(call.form, "files"), uploads.chosen_placements(call.form)
            )
            trial = sessions.add_trial(desk, session_id, placed, idempotency_key=_key(form.value(KEY_FIELD)))
    except (InputError, Conflict) as error:
        if wants_problem_document(request):
            raise
        return _trial_page(call, session_id, _with(form, error), error)
    return _created(request, f"/sessions/{session_id}?trial={trial.number}")


def _created(request: Request, path: str) -> Response:
    """On to the new thing: a browser by redirect, the form's script in words, so that it opens only once."""
    if wants_problem_document(request):
        return JSONResponse({"location": path}, 201, headers={"Location": path})
    return go(path)


def _session_page(call: Call, patient_id: str, form: Typed, error: Exception | None = None) -> Response:
    with call.desk() as desk:
        patient = patients.get_patient(desk, patient_id)
    status = 200 if error is None else problem_of(error).status
    return page(
        call,
        "sessions/new.html",
        status,
        patient=patient,
        form=form,
        courses=COURSE_M,
        inspected=_inspected(error),
        chosen=uploads.chosen_placements(call.form),
    )


def _trial_page(call: Call, session_id: str, form: Typed, error: Exception | None = None) -> Response:
    with call.desk() as desk:
        session = sessions.get_session(desk, session_id)
    status = 200 if error is None else problem_of(error).status
    return page(
        call,
        "sessions/new_trial.html",
        status,
        session=session,
        form=form,
        inspected=_inspected(error),
        chosen=uploads.chosen_placements(call.form),
    )


def _with(form: Typed, error: Exception) -> Typed:
    """The form with the problem, unless a field already says it."""
    return form if form.errors else form.with_problem(problem_of(error))


def _inspected(error: Exception | None) -> Sequence[InspectedFile]:
    return error.inspected if isinstance(error, uploads.PlacementsUnknownError) else ()


def _new_key() -> str:
    """One key for each form that is shown: pressing the button twice makes one session."""
    return secrets.token_urlsafe(16)


def _key(text: str) -> str | None:
    return text if re.fullmatch(KEY_PATTERN, text) else None
