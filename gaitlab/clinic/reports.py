"""Reports and exports of stored sessions; each look is audited."""

from __future__ import annotations

from typing import Any

from gaitlab.clinic.clinic import Desk


def session_report_html(desk: Desk, session_id: str) -> str:
    """The report as a self-contained HTML page. REPORT_READ."""
    raise NotImplementedError


def session_report_pdf(desk: Desk, session_id: str) -> bytes:
    """The report as a PDF with the results attached. REPORT_READ."""
    raise NotImplementedError


def trial_figures(desk: Desk, trial_id: str) -> list[Any]:
    """Figures of the trial's current analysis, for the session page."""
    raise NotImplementedError


def trial_result_json(desk: Desk, trial_id: str) -> str:
    """The current result as ``gaitlab.result/1`` JSON."""
    raise NotImplementedError


def trial_series_csv(desk: Desk, trial_id: str) -> str:
    """The series of the current analysis: ``placement``, then the fixed columns of ``--series``."""
    raise NotImplementedError
