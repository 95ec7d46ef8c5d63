"""What REST takes and gives where it is not a view of the clinic itself."""

from __future__ import annotations

import datetime as dt
from typing import Annotated

from fastapi import Header
from pydantic import BaseModel, ConfigDict, Field

from api.params import KEY_PATTERN
from gaitlab.clinic.views import AnalysisView, FileView, SessionSummary, SessionView, Sex, TrialView
from gaitlab.result import Parameter, ResultWarning

IdempotencyKey = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        pattern=KEY_PATTERN,
        description="Any text of up to 64 characters, new for each upload. A request repeated with the same "
        "key and content gives the first one's answer and stores nothing again; with other content it is "
        "refused.",
    ),
]
IfMatch = Annotated[
    str | None,
    Header(
        alias="If-Match",
        pattern=r'^"[0-9]{1,9}"$',
        description="The ETag of the version you saw; refused if it changed.",
    ),
]


class PatientChanges(BaseModel):
    """The fields to change; those left out stay as they are."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"weight_kg": 71.5}})

    code: str = ""
    sex: Sex = "unknown"
    birth_year: int | None = None
    height_m: float | None = None
    weight_kg: float | None = None
    leg_length_m: float | None = None
    diagnosis: str = ""
    note: str = ""


class Trial(BaseModel):
    """A trial: its files, its analyses, and the parameters of the current one.

    ``result.json`` has the whole result: strides, rests, events, turns, settings.
    """

    id: str
    session_id: str
    number: int
    created_at: dt.datetime
    files: list[FileView]
    analyses: list[AnalysisView]
    parameters: list[Parameter]
    warnings: list[ResultWarning]
    result_url: str = Field(description="Path of result.json.")
    series_url: str = Field(description="Path of series.csv.")


class Session(SessionSummary):
    """A session with its trials."""

    trials: list[Trial]
    report_html_url: str
    report_pdf_url: str


class Sessions(BaseModel):
    """A patient's sessions, newest first."""

    items: list[SessionSummary]


def trial_out(trial: TrialView) -> Trial:
    """A trial as REST shows it."""
    path = f"/api/v1/trials/{trial.id}"
    return Trial(
        **trial.model_dump(exclude={"result"}),
        parameters=list(trial.result.parameters),
        warnings=list(trial.result.warnings),
        result_url=f"{path}/result.json",
        series_url=f"{path}/series.csv",
    )


def session_out(session: SessionView) -> Session:
    """A session as REST shows it."""
    path = f"/api/v1/sessions/{session.id}"
    return Session(
        **session.model_dump(exclude={"trials"}),
        trials=[trial_out(trial) for trial in session.trials],
        report_html_url=f"{path}/report.html",
        report_pdf_url=f"{path}/report.pdf",
    )
