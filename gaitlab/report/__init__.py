"""The report of a session: one text, one set of figures, as HTML and as PDF.

``build_report`` words everything once; ``report_html`` and ``report_pdf`` lay the same words out.
"""

from __future__ import annotations

from gaitlab.report.build import build_report
from gaitlab.report.document import Report, SessionInfo, Subject, TrialReport
from gaitlab.report.environment import template_environment
from gaitlab.report.figures import FIGURES, Figure, figures
from gaitlab.report.html import report_html, style_source
from gaitlab.report.pdf import load_fonts, report_pdf


def warm_up() -> None:
    """Load plotting and typesetting now, about a second, so that the first report does not wait for them."""
    from gaitlab.report.figures import canvas

    canvas.Sheet(10, 10)
    load_fonts()


__all__ = [
    "FIGURES",
    "Figure",
    "Report",
    "SessionInfo",
    "Subject",
    "TrialReport",
    "build_report",
    "figures",
    "report_html",
    "report_pdf",
    "style_source",
    "template_environment",
    "warm_up",
]
