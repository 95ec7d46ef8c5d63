"""The report as one HTML file that needs nothing else: style and figures within, no script, no link."""

from __future__ import annotations

import base64
import functools
import hashlib

from jinja2 import Template
from markupsafe import Markup

from gaitlab.paths import data_folder
from gaitlab.report.document import Report
from gaitlab.report.environment import template_environment


def report_html(report: Report) -> str:
    """Lay a report out as a page for screens from 390 px and for the printer."""
    style = _stylesheet()
    return _template().render(report=report, style=Markup(style), style_source=style_source())  # noqa: S704


def style_source() -> str:
    """The page's style as a Content-Security-Policy names it: ``'sha256-…'``."""
    digest = hashlib.sha256(_stylesheet().encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


@functools.cache
def _template() -> Template:
    return template_environment().get_template("report.html")


@functools.cache
def _stylesheet() -> str:
    return (data_folder("templates") / "report.css").read_text(encoding="utf-8")
