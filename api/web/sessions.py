"""A session: its numbers, figures and files."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from api import answers
from api.call import CurrentCall
from api.guard import GuardedRoute
from api.params import Id
from api.policy import person
from api.web.strip import walk_strip
from api.web.tables import parameter_tables, summary
from api.web.templates import go, page
from api.web.text import METHODS
from gaitlab.analysis import Settings
from gaitlab.clinic import reports, sessions
from gaitlab.clinic.access import Permission
from gaitlab.errors import InputError, NotFound
from gaitlab.report.strides import stride_rows
from gaitlab.report.summary import verdict

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)


@router.get("/sessions/{session_id}")
@person(Permission.SESSION_READ)
def show(
    session_id: Id,
    call: CurrentCall,
    number: Annotated[int | None, Query(alias="trial", ge=1, le=100_000)] = None,
) -> Response:
    with call.desk() as desk:
        session = sessions.get_session(desk, session_id)
        wanted = session.trials[-1].number if number is None else number
        trial = next((one for one in session.trials if one.number == wanted), None)
        if trial is None:
            raise NotFound(
                "not_found", "There is no such trial.", "Open the session and choose one of its trials."
            )
        figures = reports.trial_figures(desk, trial.id)
    return page(
        call,
        "sessions/show.html",
        session=session,
        trial=trial,
        result=trial.result,
        summary=summary(trial.result),
        verdict=verdict(trial.result),
        strides=stride_rows(trial.result),
        tables=parameter_tables(trial.result),
        strip=walk_strip(trial.result),
        figures=figures,
        methods=METHODS,
    )


@router.get("/sessions/{session_id}/report.html")
@person(Permission.REPORT_READ)
def report_html(session_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        return answers.report_page(reports.session_report_html(desk, session_id))


@router.get("/sessions/{session_id}/report.pdf")
@person(Permission.REPORT_READ)
def report_pdf(session_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        return answers.pdf(reports.session_report_pdf(desk, session_id), session_id)


@router.get("/trials/{trial_id}/figures/{name}.svg")
@person(Permission.SESSION_READ)
def figure(trial_id: Id, name: str, call: CurrentCall) -> Response:
    with call.desk() as desk:
        found = [one for one in reports.trial_figures(desk, trial_id) if one.name == name]
    if not found:
        raise NotFound("not_found", "There is no such figure.", "Open it from the session's page.")
    return answers.figure(found[0].svg)


@router.get("/trials/{trial_id}/result.json")
@person(Permission.SESSION_READ)
def result_json(trial_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        return answers.result_json(reports.trial_result_json(desk, trial_id), trial_id)


@router.get("/trials/{trial_id}/series.csv")
@person(Permission.SESSION_READ)
def series_csv(trial_id: Id, call: CurrentCall) -> Response:
    with call.desk() as desk:
        return answers.series_csv(reports.trial_series_csv(desk, trial_id), trial_id)


@router.post("/trials/{trial_id}/analyses")
@person(Permission.SESSION_WRITE)
def analyse_again(trial_id: Id, call: CurrentCall) -> Response:
    method = str(call.form.get("method", ""))
    if method not in METHODS:
        raise InputError(
            "unknown_method", "There is no such method.", "Choose one of the list.", column="method"
        )
    with call.desk() as desk:
        session = sessions.get_session(desk, sessions.get_trial(desk, trial_id).session_id)
        trial = sessions.reanalyse(desk, trial_id, Settings(method=method, course_m=session.course_m))
    return go(f"/sessions/{trial.session_id}?trial={trial.number}")
