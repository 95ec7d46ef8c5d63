"""Patients: the list, one patient, and the form."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from api.call import CurrentCall
from api.errors import problem_of
from api.guard import GuardedRoute
from api.params import Id
from api.policy import person
from api.web.forms import Typed, check, decimal, typed
from api.web.templates import go, page
from gaitlab.clinic import patients, sessions
from gaitlab.clinic.access import Permission
from gaitlab.clinic.views import PatientForm, PatientView
from gaitlab.errors import Conflict

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

PER_PAGE = 25
FIELDS = ("code", "sex", "birth_year", "height_cm", "weight_kg", "leg_length_cm", "diagnosis", "note")
_PLAIN_NUMBER = r"[+-]?[0-9]{1,8}(\.[0-9]{0,8})?"
_VERSION = r"[0-9]{1,9}"
_IN_CENTIMETRES = {"height_cm": "height_m", "leg_length_cm": "leg_length_m"}


@router.get("/")
@person(Permission.PATIENT_READ)
def list_patients(
    call: CurrentCall,
    query: Annotated[str, Query(max_length=64)] = "",
    page_number: Annotated[int, Query(alias="page", ge=1, le=100_000)] = 1,
) -> Response:
    with call.desk() as desk:
        found = patients.list_patients(
            desk, query=query.strip(), limit=PER_PAGE, offset=(page_number - 1) * PER_PAGE
        )
    last_page = max(1, -(-found.total // PER_PAGE))
    if page_number > last_page:
        return go("/")
    return page(
        call,
        "patients/list.html",
        found=found,
        query=query.strip(),
        page_number=page_number,
        last_page=last_page,
    )


@router.get("/patients/new")
@person(Permission.PATIENT_WRITE)
def show_new(call: CurrentCall) -> Response:
    return page(call, "patients/form.html", patient=None, form=Typed({"sex": "unknown"}))


@router.post("/patients/new")
@person(Permission.PATIENT_WRITE)
def add_patient(call: CurrentCall) -> Response:
    form = typed(call.form, FIELDS)
    checked, errors = _read(form)
    if checked is None:
        return page(call, "patients/form.html", 422, patient=None, form=Typed(form.values, errors))
    try:
        with call.desk() as desk:
            patient = patients.add_patient(desk, checked)
    except Conflict as error:
        taken = Typed(form.values, {"code": problem_of(error).detail})
        return page(call, "patients/form.html", 409, patient=None, form=taken)
    return go(f"/patients/{patient.id}")


@router.get("/patients/{patient_id}")
@person(Permission.PATIENT_READ)
def show(patient_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        patient = patients.get_patient(desk, patient_id)
        walks = sessions.list_sessions(desk, patient_id)
    return page(call, "patients/show.html", patient=patient, sessions=walks)


@router.get("/patients/{patient_id}/edit")
@person(Permission.PATIENT_WRITE)
def show_edit(patient_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        patient = patients.get_patient(desk, patient_id)
    return page(call, "patients/form.html", patient=patient, form=Typed(_as_typed(patient)))


@router.post("/patients/{patient_id}/edit")
@person(Permission.PATIENT_WRITE)
def edit(patient_id: Id, call: CurrentCall) -> Response:
    form = typed(call.form, (*FIELDS, "version"))
    checked, errors = _read(form)
    if checked is not None:
        try:
            version = _version(form.value("version"))
            with call.desk() as desk:
                patients.edit_patient(desk, patient_id, checked, version=version)
            return go(f"/patients/{patient_id}")
        except Conflict as error:
            form = form.with_problem(problem_of(error))
    with call.desk() as desk:
        patient = patients.get_patient(desk, patient_id)
    status = 409 if form.problem else 422
    return page(
        call, "patients/form.html", status, patient=patient, form=Typed(form.values, errors, form.problem)
    )


@router.post("/patients/{patient_id}/delete")
@person(Permission.PATIENT_WRITE)
def delete(patient_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        patients.delete_patient(desk, patient_id, str(call.form.get("reason", "")).strip())
    return go("/")


def _read(form: Typed) -> tuple[PatientForm | None, dict[str, str]]:
    """Check what was typed. People give lengths in centimetres; inside they are metres."""
    data: dict[str, str | None] = {name: form.value(name) for name in ("code", "sex", "diagnosis", "note")}
    data.update({name: decimal(form.value(name)) for name in ("birth_year", "weight_kg")})
    data.update({metres: _metres(form.value(shown)) for shown, metres in _IN_CENTIMETRES.items()})
    checked, errors = check(PatientForm, data)
    for shown, metres in _IN_CENTIMETRES.items():
        if metres in errors:
            bounds = {"height_m": "40 to 260", "leg_length_m": "20 to 150"}[metres]
            errors[shown] = f"This must be a number of centimetres, {bounds}."
    return checked, errors


def _metres(text: str) -> str | None:
    number = decimal(text)
    if number is None:
        return None
    return str(Decimal(number) / 100) if re.fullmatch(_PLAIN_NUMBER, number) else "no number"


def _version(text: str) -> int:
    """The version that was on the page; without it nobody could tell whether somebody was faster."""
    if not re.fullmatch(_VERSION, text):
        raise Conflict(
            "version_missing",
            "The form does not say which version of the record it was filled in on.",
            "Reload the page and make the change again.",
        )
    return int(text)


def _as_typed(patient: PatientView) -> dict[str, str]:
    plain = {
        name: getattr(patient, name)
        for name in ("code", "sex", "birth_year", "weight_kg", "diagnosis", "note")
    }
    lengths = {
        shown: None if (metres := getattr(patient, stored)) is None else f"{100 * metres:.10g}"
        for shown, stored in _IN_CENTIMETRES.items()
    }
    values = {**plain, **lengths, "version": patient.version}
    return {
        name: "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
        for name, value in values.items()
    }
