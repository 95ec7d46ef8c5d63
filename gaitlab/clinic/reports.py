"""Reports and exports of what is stored; each look is audited."""

from __future__ import annotations

import io
from collections.abc import Sequence

from gaitlab.clinic.access import Permission
from gaitlab.clinic.clinic import DEFAULT_SITE, Desk
from gaitlab.clinic.desk import not_found
from gaitlab.clinic.showing import patient_code, result_of
from gaitlab.report import (
    Figure,
    Report,
    SessionInfo,
    Subject,
    TrialReport,
    build_report,
    figures,
    report_html,
    report_pdf,
)
from gaitlab.series import Series, from_bytes
from gaitlab.store import records
from gaitlab.store.records import Scope
from gaitlab.store.tables import Patient, Session, Trial

__all__ = [
    "Figure",
    "session_report_html",
    "session_report_pdf",
    "trial_figures",
    "trial_result_json",
    "trial_series_csv",
]


def session_report_html(desk: Desk, session_id: str) -> str:
    """The report as a self-contained HTML page. REPORT_READ."""
    return report_html(_report(desk, session_id, "report.html"))


def session_report_pdf(desk: Desk, session_id: str) -> bytes:
    """The report as a PDF with the results attached. REPORT_READ."""
    return report_pdf(_report(desk, session_id, "report.pdf"))


def trial_figures(desk: Desk, trial_id: str) -> Sequence[Figure]:
    """Figures of the trial's current analysis, for the session page. SESSION_READ."""
    row = _trial(desk, trial_id, "trial.figures")
    result, series = result_of(desk, row), _series(desk, row)
    desk.pause()
    return figures(result, series)


def trial_result_json(desk: Desk, trial_id: str) -> str:
    """The current result as ``gaitlab.result/1`` JSON. SESSION_READ."""
    row = _trial(desk, trial_id, "trial.result")
    return records.current(row).result_json if desk.sees_names else result_of(desk, row).to_json()


def trial_series_csv(desk: Desk, trial_id: str) -> str:
    """The series of the current analysis: ``placement``, then the fixed columns of ``--series``. SESSION_READ."""
    series = _series(desk, _trial(desk, trial_id, "trial.series"))
    desk.pause()
    table = io.StringIO()
    for placement, one in series.items():
        frame = one.to_frame()
        frame.insert(0, "placement", placement.value)
        frame.to_csv(table, index=False, float_format="%.6g", lineterminator="\n", header=table.tell() == 0)
    return table.getvalue()


def _trial(desk: Desk, trial_id: str, action: str) -> Trial:
    scope = desk.reading(Permission.SESSION_READ, action, trial_id)
    row = records.trial(scope, trial_id)
    if row is None:
        raise not_found()
    desk.looked(action, object_id=row.id, patient_id=row.session.patient_id)
    return row


def _report(desk: Desk, session_id: str, action: str) -> Report:
    scope = desk.reading(Permission.REPORT_READ, action, session_id)
    row = records.session(scope, session_id)
    if row is None:
        raise not_found()
    desk.looked(action, object_id=row.id, patient_id=row.patient_id)
    subject, session = _subject(desk, row.patient), _session_info(desk, scope, row)
    trials = [
        TrialReport(trial.number, result_of(desk, trial), _series(desk, trial))
        for trial in records.trials_of(scope, row.id)
    ]
    desk.pause()
    return build_report(subject, session, trials, created_at=desk.now().replace(microsecond=0))


def _subject(desk: Desk, row: Patient) -> Subject:
    return Subject(
        code=patient_code(desk, row),
        sex=row.sex,
        birth_year=row.birth_year,
        height_m=row.height_m,
        weight_kg=row.weight_kg,
        leg_length_m=row.leg_length_m,
        diagnosis=row.diagnosis if desk.sees_names else "",
        note=row.note if desk.sees_names else "",
    )


def _session_info(desk: Desk, scope: Scope, row: Session) -> SessionInfo:
    site = records.site_name(scope)
    return SessionInfo(
        date=row.date,
        test=row.test,
        course_m=row.course_m,
        note=row.note if desk.sees_names else "",
        site="" if site == DEFAULT_SITE else site,
    )


def _series(desk: Desk, row: Trial) -> Series:
    return from_bytes(desk.clinic.files.get(records.current(row).series_sha256))
