"""Fixtures for all tests."""

from __future__ import annotations

import os
from collections.abc import Generator
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("gaitlab", deadline=None)  # speed is measured in benchmarks, not in tests
settings.load_profile("gaitlab")


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of public recordings: ``GAITLAB_DATA``, else ``../shared/data`` beside the repository."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("GAITLAB_DATA") or beside)
    if not folder.is_dir():
        pytest.skip("The public recordings are not here; set GAITLAB_DATA to their folder.")
    return folder


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """With ``GAITLAB_NO_SKIP``, a test that cannot run where it should is a test that fails."""
    report = yield
    if report.skipped and os.environ.get("GAITLAB_NO_SKIP") and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} was skipped: {report.longrepr}"
    return report
