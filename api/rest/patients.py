"""``/api/v1/patients``."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Body, Query, Response

from api.call import CurrentCall
from api.guard import GuardedRoute
from api.params import Id
from api.policy import token
from api.rest.schemas import IfMatch, PatientChanges
from gaitlab.clinic import patients
from gaitlab.clinic.access import Permission
from gaitlab.clinic.views import Page, PatientForm, PatientView

router = APIRouter(prefix="/api/v1/patients", tags=["patients"], route_class=GuardedRoute)

NewPatient = Annotated[
    PatientForm,
    Body(
        openapi_examples={
            "a patient": {
                "value": {
                    "code": "P-017",
                    "sex": "female",
                    "birth_year": 1968,
                    "height_m": 1.68,
                    "weight_kg": 70.5,
                    "leg_length_m": 0.86,
                    "diagnosis": "relapsing-remitting MS",
                }
            }
        }
    ),
]


@router.post("", status_code=201)
@token(Permission.PATIENT_WRITE)
def add_patient(form: NewPatient, call: CurrentCall, response: Response) -> PatientView:
    """Add a patient. The code must be new in your site; only the code is required."""
    with call.desk() as desk:
        patient = patients.add_patient(desk, form)
    response.headers["Location"] = f"/api/v1/patients/{patient.id}"
    return _tagged(response, patient)


@router.get("")
@token(Permission.PATIENT_READ)
def list_patients(
    call: CurrentCall,
    query: Annotated[str, Query(max_length=64, description="Part of the code.")] = "",
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    offset: Annotated[int, Query(ge=0, le=10_000_000)] = 0,
) -> Page[PatientView]:
    """List the patients of your site by code."""
    with call.desk() as desk:
        return patients.list_patients(desk, query=query, limit=limit, offset=offset)


@router.get("/{patient_id}")
@token(Permission.PATIENT_READ)
def get_patient(patient_id: Id, call: CurrentCall, response: Response) -> PatientView:
    """Get a patient. The ETag names the version, for If-Match when you change it."""
    with call.desk() as desk:
        return _tagged(response, patients.get_patient(desk, patient_id))


@router.patch("/{patient_id}")
@token(Permission.PATIENT_WRITE)
def change_patient(
    patient_id: Id, changes: PatientChanges, call: CurrentCall, response: Response, if_match: IfMatch = None
) -> PatientView:
    """Change the named fields of a patient. With If-Match it is refused if somebody else was faster."""
    version = None if if_match is None else int(if_match.strip('"'))
    with call.desk() as desk:
        changed = patients.edit_patient(
            desk, patient_id, changes.model_dump(exclude_unset=True), version=version
        )
    return _tagged(response, changed)


@router.delete("/{patient_id}", status_code=204)
@token(Permission.PATIENT_WRITE)
def delete_patient(patient_id: Id, call: CurrentCall) -> None:
    """Hide a patient and all that belongs to them. Nothing is erased."""
    with call.desk() as desk:
        patients.delete_patient(desk, patient_id, "deleted by REST")


def _tagged(response: Response, patient: PatientView) -> PatientView:
    response.headers["ETag"] = f'"{patient.version}"'
    return patient
