"""The page in a real browser: nothing cut off on a phone or a desktop, nothing the browser refuses."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from gaitlab.report import Subject, TrialReport, build_report, report_html
from tests.report import walk
from tests.report.conftest import MADE_AT, SESSION, report_of

playwright = pytest.importorskip("playwright.sync_api")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
LONG = "ABCDEFGHIJ" * 6


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="No Chromium on this machine.")
def test_nothing_is_cut_off_and_nothing_refused_from_phone_to_desktop(
    trial: TrialReport, tmp_path: Path
) -> None:
    result = walk.result(names={"left_foot": LONG * 3})
    long_names = TrialReport(1, result, trial.series)
    reports = {
        "usual": report_of(trial),
        "two": report_of(trial, TrialReport(2, trial.result, trial.series)),
        "long": build_report(Subject(LONG, diagnosis=LONG * 3), SESSION, [long_names], created_at=MADE_AT),
    }
    for name, report in reports.items():
        (tmp_path / f"{name}.html").write_text(report_html(report), encoding="utf-8")
    refused: list[str] = []
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for width in (390, 1280):
            page = browser.new_page(viewport={"width": width, "height": 900})
            page.on("console", lambda message: refused.append(message.text))
            for name in reports:
                page.goto((tmp_path / f"{name}.html").as_uri())
                assert page.evaluate("document.documentElement.scrollWidth") == width, (name, width)
                stroke = page.evaluate(
                    "getComputedStyle(document.querySelector('figure svg path[stroke]')).stroke"
                )
                assert stroke.startswith("rgb")
            page.close()
        browser.close()
    assert refused == []
