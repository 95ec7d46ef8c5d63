"""Sessions and trials: store and analyse a walk, look it up, analyse it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from gaitlab.analysis import Settings
from gaitlab.clinic import idempotency, trials
from gaitlab.clinic.access import Permission
from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.desk import not_found
from gaitlab.clinic.showing import session_summary, session_view, trial_view
from gaitlab.clinic.uploads import InspectedFile, inspect_upload
from gaitlab.clinic.views import SessionForm, SessionSummary, SessionView, TrialView
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Placement
from gaitlab.store import records, tables
from gaitlab.store.base import new_id
from gaitlab.store.records import Scope

__all__ = [
    "InspectedFile",
    "SessionForm",
    "SessionSummary",
    "SessionView",
    "TrialView",
    "add_session",
    "add_trial",
    "get_session",
    "get_trial",
    "inspect_upload",
    "list_sessions",
    "reanalyse",
]

_ADD_SESSION, _ADD_TRIAL, _REANALYSE = "session.add", "trial.add", "trial.reanalyse"


def add_session(
    desk: Desk,
    patient_id: str,
    form: SessionForm,
    files: Mapping[Placement, InputFile],
    *,
    idempotency_key: str | None = None,
    settings: Settings | None = None,
) -> SessionView:
    """Read and analyse the files and store all as a session with its first trial; on any error nothing is stored.

    With the same ``idempotency_key`` and the same content, the session of the first call is returned again.

    Raises
    ------
    InputError
        If a file cannot be used; code ``idempotency_key_reused`` where the key came with another content before.
    TooLarge
        If the files are over ``max_upload_bytes``.
    """
    scope = desk.reading(Permission.SESSION_WRITE, _ADD_SESSION, patient_id)
    typed = form.model_dump(mode="json")
    asked = idempotency.request(idempotency_key, _ADD_SESSION, patient_id, typed, files, settings)
    _require_patient(scope, patient_id)
    earlier = idempotency.earlier(desk, scope, asked)
    if earlier is not None:
        return _shown_session(desk, scope, earlier)
    prepared = trials.prepare(desk, files, replace(settings or Settings(), course_m=form.course_m))
    scope = desk.writing(Permission.SESSION_WRITE, _ADD_SESSION, patient_id)
    _require_patient(scope, patient_id)
    session_id, trial_id = new_id(), new_id()
    first = idempotency.claim(desk, scope, asked, session_id)
    if first == session_id:
        trials.keep_contents(desk, scope, prepared)
        _add_session_row(desk, scope, session_id, patient_id, form)
        trials.add_rows(desk, scope, trial_id, session_id, 1, prepared)
        details = {"trial": trial_id, "files": _hashes(prepared)}
        desk.changed(_ADD_SESSION, object_id=session_id, patient_id=patient_id, details=details)
    return _shown_session(desk, scope, first)


def add_trial(
    desk: Desk,
    session_id: str,
    files: Mapping[Placement, InputFile],
    *,
    idempotency_key: str | None = None,
    settings: Settings | None = None,
) -> TrialView:
    """Read and analyse the files and store them as a further trial of a session; errors as ``add_session``."""
    scope = desk.reading(Permission.SESSION_WRITE, _ADD_TRIAL, session_id)
    asked = idempotency.request(idempotency_key, _ADD_TRIAL, session_id, {}, files, settings)
    course_m = _session(scope, session_id).course_m
    earlier = idempotency.earlier(desk, scope, asked)
    if earlier is not None:
        return trial_view(desk, _trial(scope, earlier))
    prepared = trials.prepare(desk, files, replace(settings or Settings(), course_m=course_m))
    scope = desk.writing(Permission.SESSION_WRITE, _ADD_TRIAL, session_id)
    session = _session(scope, session_id, lock=True)
    trial_id = new_id()
    first = idempotency.claim(desk, scope, asked, trial_id)
    if first == trial_id:
        trials.keep_contents(desk, scope, prepared)
        number = records.trial_counts(scope, [session_id])[session_id] + 1
        trials.add_rows(desk, scope, trial_id, session_id, number, prepared)
        details = {"session": session_id, "files": _hashes(prepared)}
        desk.changed(_ADD_TRIAL, object_id=trial_id, patient_id=session.patient_id, details=details)
    return trial_view(desk, _trial(scope, first))


def get_session(desk: Desk, session_id: str) -> SessionView:
    """One session with its trials and their current results."""
    scope = desk.reading(Permission.SESSION_READ, "session.view", session_id)
    row = _session(scope, session_id)
    desk.looked("session.view", object_id=row.id, patient_id=row.patient_id)
    return session_view(desk, scope, row)


def list_sessions(desk: Desk, patient_id: str) -> list[SessionSummary]:
    """A patient's sessions, newest first, without results."""
    scope = desk.reading(Permission.SESSION_READ, "session.list", patient_id)
    _require_patient(scope, patient_id)
    rows = records.sessions_of(scope, patient_id)
    counts = records.trial_counts(scope, [row.id for row in rows])
    authors = records.account_names(scope, [row.created_by for row in rows])
    desk.looked("session.list", object_id=patient_id, patient_id=patient_id)
    return [session_summary(desk, row, counts.get(row.id, 0), authors) for row in rows]


def get_trial(desk: Desk, trial_id: str) -> TrialView:
    """One trial with its current result."""
    scope = desk.reading(Permission.SESSION_READ, "trial.view", trial_id)
    row = _trial(scope, trial_id)
    desk.looked("trial.view", object_id=row.id, patient_id=row.session.patient_id)
    return trial_view(desk, row)


def reanalyse(desk: Desk, trial_id: str, settings: Settings | None = None) -> TrialView:
    """Analyse a trial's stored files again: adds an analysis, which becomes the current one.

    Without ``settings`` those of today's default, on the session's course.

    Raises
    ------
    GaitlabError
        ``file_missing`` or ``file_damaged`` where a stored file is not as it was stored.
    """
    scope = desk.reading(Permission.SESSION_WRITE, _REANALYSE, trial_id)
    row = _trial(scope, trial_id)
    files = {
        Placement(one.placement): InputFile(one.name, desk.clinic.files.get(one.sha256)) for one in row.files
    }
    prepared = trials.prepare(desk, files, settings or Settings(course_m=row.session.course_m))
    scope = desk.writing(Permission.SESSION_WRITE, _REANALYSE, trial_id)
    row = _trial(scope, trial_id, lock=True)
    trials.keep_contents(desk, scope, prepared)
    analysis_id = trials.add_analysis(desk, scope, trial_id, records.current(row).number + 1, prepared)
    details = {
        "analysis": analysis_id,
        "settings_sha256": prepared.analysis.result.provenance.settings_sha256,
    }
    desk.changed(_REANALYSE, object_id=trial_id, patient_id=row.session.patient_id, details=details)
    return trial_view(desk, _trial(scope, trial_id))


def _add_session_row(desk: Desk, scope: Scope, session_id: str, patient_id: str, form: SessionForm) -> None:
    scope.db.add(
        tables.Session(
            **form.model_dump(),
            id=session_id,
            site_id=scope.site_id,
            patient_id=patient_id,
            created_at=desk.now(),
            created_by=desk.principal.user_id,
        )
    )
    scope.db.flush()


def _hashes(prepared: trials.Prepared) -> dict[str, str]:
    return {placement.value: file.sha256 for placement, file in prepared.files.items()}


def _shown_session(desk: Desk, scope: Scope, session_id: str) -> SessionView:
    return session_view(desk, scope, _session(scope, session_id))


def _require_patient(scope: Scope, patient_id: str) -> None:
    if records.patient(scope, patient_id) is None:
        raise not_found()


def _session(scope: Scope, session_id: str, *, lock: bool = False) -> tables.Session:
    row = records.session(scope, session_id, lock=lock)
    if row is None:
        raise not_found()
    return row


def _trial(scope: Scope, trial_id: str, *, lock: bool = False) -> tables.Trial:
    row = records.trial(scope, trial_id, lock=lock)
    if row is None:
        raise not_found()
    return row
