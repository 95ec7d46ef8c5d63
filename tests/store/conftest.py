from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine

from gaitlab.store.database import open_engine
from tests.databases import database_url

__all__ = ["database_url"]


@pytest.fixture
def engine(database_url: str, tmp_path: Path) -> Iterator[Engine]:
    """An engine on an empty database."""
    engine = open_engine(database_url, tmp_path)
    yield engine
    engine.dispose()
