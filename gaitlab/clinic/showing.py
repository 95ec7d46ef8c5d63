"""From rows to what this caller may see: without PATIENT_NAMES nothing that a person typed to name the patient."""

from __future__ import annotations

from collections.abc import Mapping

from gaitlab.clinic.desk import Desk
from gaitlab.clinic.views import (
    AnalysisView,
    FileView,
    PatientForm,
    PatientView,
    SessionSummary,
    SessionView,
    TrialView,
)
from gaitlab.recording.model import Placement
from gaitlab.result import Result
from gaitlab.store import records
from gaitlab.store.tables import Analysis, Patient, Session, Trial, TrialFile

CONSOLE_NAME = "command line"
FORM_FIELDS = tuple(PatientForm.model_fields)


def patient_code(desk: Desk, row: Patient) -> str:
    """The patient's code, or the pseudonym."""
    return row.code if desk.sees_names else row.pseudonym


def patient_view(desk: Desk, row: Patient, n_sessions: int) -> PatientView:
    """A patient."""
    typed = {field: getattr(row, field) for field in FORM_FIELDS}
    if not desk.sees_names:
        typed |= {"code": row.pseudonym, "diagnosis": "", "note": ""}
    return PatientView(
        **typed,
        id=row.id,
        created_at=row.created_at,
        updated_at=row.updated_at,
        version=row.version,
        n_sessions=n_sessions,
    )


def session_summary(desk: Desk, row: Session, n_trials: int, authors: Mapping[str, str]) -> SessionSummary:
    """A session as listed; ``authors`` are account names by id."""
    return SessionSummary(
        id=row.id,
        patient_id=row.patient_id,
        patient_code=patient_code(desk, row.patient),
        date=row.date,
        test=row.test,
        course_m=row.course_m,
        note=row.note if desk.sees_names else "",
        created_at=row.created_at,
        created_by=authors.get(row.created_by, CONSOLE_NAME),
        n_trials=n_trials,
    )


def session_view(desk: Desk, scope: records.Scope, row: Session) -> SessionView:
    """A session with its trials."""
    trials = [trial_view(desk, trial) for trial in records.trials_of(scope, row.id)]
    summary = session_summary(desk, row, len(trials), records.account_names(scope, [row.created_by]))
    return SessionView(**summary.model_dump(), trials=trials)


def trial_view(desk: Desk, row: Trial) -> TrialView:
    """A trial with its current result."""
    current = records.current(row)
    return TrialView(
        id=row.id,
        session_id=row.session_id,
        number=row.number,
        created_at=row.created_at,
        files=[_file_view(desk, file) for file in row.files],
        analyses=[_analysis_view(analysis, analysis is current) for analysis in row.analyses],
        result=result_of(desk, row),
    )


def result_of(desk: Desk, row: Trial) -> Result:
    """The current result of a trial."""
    result = Result.model_validate_json(records.current(row).result_json)
    return result if desk.sees_names else _without_file_names(result)


def _file_view(desk: Desk, row: TrialFile) -> FileView:
    return FileView(
        placement=Placement(row.placement),
        name=row.name if desk.sees_names else row.placement,
        device=row.device,
        sha256=row.sha256,
        size_bytes=row.raw.size_bytes,
    )


def _analysis_view(row: Analysis, is_current: bool) -> AnalysisView:
    return AnalysisView(
        id=row.id,
        created_at=row.created_at,
        gaitlab=row.gaitlab,
        method=row.method,
        settings_sha256=row.settings_sha256,
        current=is_current,
    )


def _without_file_names(result: Result) -> Result:
    """File names are often made of patients' names, so they give way to the placement."""
    names = {one.name: one.placement for one in result.provenance.inputs}

    def hide(message: str) -> str:
        for name, placement in names.items():
            message = message.replace(name, placement)
        return message

    inputs = tuple(one.model_copy(update={"name": one.placement}) for one in result.provenance.inputs)
    warnings = tuple(one.model_copy(update={"message": hide(one.message)}) for one in result.warnings)
    provenance = result.provenance.model_copy(update={"inputs": inputs})
    return result.model_copy(update={"provenance": provenance, "warnings": warnings})
