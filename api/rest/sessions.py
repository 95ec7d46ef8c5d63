"""``/api/v1/patients/{id}/sessions`` and ``/api/v1/sessions``: a walk in, its report out."""

from __future__ import annotations

from typing import Annotated, Final

from fastapi import APIRouter, File, Form, Response, UploadFile

from api import answers, uploads
from api.call import Call, CurrentCall
from api.guard import GuardedRoute
from api.params import Id
from api.policy import token
from api.rest.schemas import IdempotencyKey, Session, Sessions, Trial, session_out, trial_out
from gaitlab.clinic import reports, sessions
from gaitlab.clinic.access import Permission
from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.views import SessionForm, Test, WalkDay, read_form
from gaitlab.errors import InputError
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Placement

router = APIRouter(prefix="/api/v1", tags=["sessions"], route_class=GuardedRoute)

_FILES: Final = (*(place.value for place in Placement), "recording")
_DETAILS: Final = ("date", "test", "course_m", "note")
SensorFile = Annotated[UploadFile | None, File(description="The sensor's file, as MT Manager exported it.")]
Zip = Annotated[
    UploadFile | None,
    File(description="Instead of single files: a zip; placements come from names or its placement.json."),
]


@router.post("/patients/{patient_id}/sessions", status_code=201)
@token(Permission.SESSION_WRITE, upload=True)
def add_session(
    patient_id: Id,
    call: CurrentCall,
    response: Response,
    date: Annotated[WalkDay, Form(description="Day of the walk.")],
    test: Annotated[Test, Form(description="t25fw: timed 25-foot walk; 10mwt: 10 m walk; walk: free walk.")],
    course_m: Annotated[
        float | None,
        Form(description="Timed course in metres; left out: the test's own, or none."),
    ] = None,
    note: Annotated[str, Form(max_length=2000)] = "",
    left_foot: SensorFile = None,
    right_foot: SensorFile = None,
    left_knee: SensorFile = None,
    right_knee: SensorFile = None,
    recording: Zip = None,
    idempotency_key: IdempotencyKey = None,
) -> Session:
    """Store a session with its first trial and analyse it. If a file is wrong, nothing is stored."""
    uploads.check_fields(call.form, (*_DETAILS, *_FILES))
    form = read_form(SessionForm, {"date": date, "test": test, "course_m": course_m, "note": note})
    with call.desk() as desk:
        session = sessions.add_session(
            desk, patient_id, form, _files(call, desk), idempotency_key=idempotency_key
        )
    response.headers["Location"] = f"/api/v1/sessions/{session.id}"
    return session_out(session)


@router.get("/patients/{patient_id}/sessions")
@token(Permission.SESSION_READ)
def list_sessions(patient_id: Id, call: CurrentCall) -> Sessions:
    """List a patient's sessions, newest first."""
    with call.desk() as desk:
        return Sessions(items=sessions.list_sessions(desk, patient_id))


@router.post("/sessions/{session_id}/trials", status_code=201)
@token(Permission.SESSION_WRITE, upload=True)
def add_trial(
    session_id: Id,
    call: CurrentCall,
    response: Response,
    left_foot: SensorFile = None,
    right_foot: SensorFile = None,
    left_knee: SensorFile = None,
    right_knee: SensorFile = None,
    recording: Zip = None,
    idempotency_key: IdempotencyKey = None,
) -> Trial:
    """Store a further trial of a session and analyse it."""
    uploads.check_fields(call.form, _FILES)
    with call.desk() as desk:
        trial = sessions.add_trial(desk, session_id, _files(call, desk), idempotency_key=idempotency_key)
    response.headers["Location"] = f"/api/v1/trials/{trial.id}"
    return trial_out(trial)


@router.get("/sessions/{session_id}")
@token(Permission.SESSION_READ)
def get_session(session_id: Id, call: CurrentCall) -> Session:
    """Get a session with its trials and their parameters."""
    with call.desk() as desk:
        return session_out(sessions.get_session(desk, session_id))


@router.get("/sessions/{session_id}/report.html", response_class=answers.ReportPage)
@token(Permission.REPORT_READ)
def report_html(session_id: Id, call: CurrentCall) -> Response:
    """Get the report as one self-contained HTML page."""
    with call.desk() as desk:
        return answers.report_page(reports.session_report_html(desk, session_id))


@router.get("/sessions/{session_id}/report.pdf", response_class=answers.Pdf)
@token(Permission.REPORT_READ)
def report_pdf(session_id: Id, call: CurrentCall) -> Response:
    """Get the report as a PDF with the results attached."""
    with call.desk() as desk:
        return answers.pdf(reports.session_report_pdf(desk, session_id), session_id)


def _files(call: Call, desk: Desk) -> dict[Placement, InputFile]:
    """One file per placement, or one zip."""
    named, zipped = uploads.by_placement(call.form), uploads.files_of(call.form, "recording")
    if named and zipped:
        raise InputError(
            "two_ways",
            "The files came both one by one and as a zip.",
            "Send either left_foot, right_foot, left_knee, right_knee, or recording.",
            column="recording",
        )
    return named or uploads.place(desk, zipped)
