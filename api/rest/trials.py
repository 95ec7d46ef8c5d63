"""``/api/v1/trials``: one walk's numbers."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from api import answers
from api.call import CurrentCall
from api.guard import GuardedRoute
from api.params import Id
from api.policy import token
from api.rest.schemas import Trial, trial_out
from gaitlab.clinic import comparisons, reports, sessions
from gaitlab.clinic.access import Permission
from gaitlab.comparison import to_json

router = APIRouter(prefix="/api/v1/trials", tags=["trials"], route_class=GuardedRoute)

_KNOWN_LENGTH = "How far each foot walked, measured otherwise: sets the factors of the step-length models."


@router.get("/{trial_id}")
@token(Permission.SESSION_READ)
def get_trial(trial_id: Id, call: CurrentCall) -> Trial:
    """Get a trial: its files, its analyses, and the parameters of the current one."""
    with call.desk() as desk:
        return trial_out(sessions.get_trial(desk, trial_id))


@router.get("/{trial_id}/result.json", response_class=answers.Json)
@token(Permission.SESSION_READ)
def result_json(trial_id: Id, call: CurrentCall) -> Response:
    """Get the whole current result (`gaitlab.result/1`), byte for byte as it was stored."""
    with call.desk() as desk:
        return answers.result_json(reports.trial_result_json(desk, trial_id), trial_id)


@router.get("/{trial_id}/series.csv", response_class=answers.Csv)
@token(Permission.SESSION_READ)
def series_csv(trial_id: Id, call: CurrentCall) -> Response:
    """Get acceleration, velocity and position of every sensor over time."""
    with call.desk() as desk:
        return answers.series_csv(reports.trial_series_csv(desk, trial_id), trial_id)


@router.get("/{trial_id}/comparison", response_class=answers.Json)
@token(Permission.SESSION_READ)
def comparison(
    trial_id: Id,
    call: CurrentCall,
    known_length_m: Annotated[float | None, Query(ge=0.5, le=10_000.0, description=_KNOWN_LENGTH)] = None,
) -> Response:
    """Compare every published method with gaitlab's own on this trial (`gaitlab.comparison/1`). Nothing of it is stored."""
    with call.desk() as desk:
        found = comparisons.compare_trial(desk, trial_id, known_length_m)
    return answers.Json(to_json(found.comparison))
