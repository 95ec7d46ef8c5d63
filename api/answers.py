"""Answers that are files: the same for pages and REST, each with headers of its own."""

from __future__ import annotations

from starlette.responses import Response

from gaitlab.report import style_source

FIGURE_POLICY = "default-src 'none'; frame-ancestors 'none'; sandbox"
"""A figure has neither styles nor scripts of its own."""


class ReportPage(Response):
    """A report as HTML."""

    media_type = "text/html"


class Pdf(Response):
    """A PDF."""

    media_type = "application/pdf"


class Json(Response):
    """JSON that is already text."""

    media_type = "application/json"


class Csv(Response):
    """CSV."""

    media_type = "text/csv"


class Svg(Response):
    """A figure."""

    media_type = "image/svg+xml"


def report_page(content: str) -> ReportPage:
    """The report to look at: one self-contained page, its own style and pictures, no script, nothing from anywhere."""
    policy = (
        f"default-src 'none'; style-src {style_source()}; img-src data:; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'; sandbox"
    )
    return ReportPage(content, headers={"Content-Security-Policy": policy})


def figure(content: bytes) -> Svg:
    """A figure to look at alone."""
    return Svg(content, headers={"Content-Security-Policy": FIGURE_POLICY})


def pdf(content: bytes, session_id: str) -> Pdf:
    """The report as a file to keep."""
    return Pdf(content, headers=_file(f"gait-report-{session_id}.pdf"))


def result_json(content: str, trial_id: str) -> Json:
    """``result.json`` as a file to keep."""
    return Json(content, headers=_file(f"result-{trial_id}.json"))


def series_csv(content: str, trial_id: str) -> Csv:
    """The series as a file to keep."""
    return Csv(content, headers=_file(f"series-{trial_id}.csv"))


def _file(name: str) -> dict[str, str]:
    """Names are made of identifiers only: nothing of a person gets into a download folder."""
    return {"Content-Disposition": f'attachment; filename="{name}"'}
