"""Fixtures for all tests."""

from __future__ import annotations

import os
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
