from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine

from gaitlab.store import schema
from gaitlab.store.database import Database, open_engine
from tests.databases import database_url, migrated_url, postgresql_url, sqlite_at_head

__all__ = ["database_url", "migrated_url", "postgresql_url", "sqlite_at_head"]


@pytest.fixture
def engine(database_url: str, tmp_path: Path) -> Iterator[Engine]:
    """An engine on an empty database."""
    engine = open_engine(database_url, tmp_path)
    yield engine
    engine.dispose()


@pytest.fixture
def db(migrated_url: str, tmp_path: Path) -> Iterator[Database]:
    """A database at head."""
    engine = open_engine(migrated_url, tmp_path)
    schema.migrate(engine)
    yield Database(engine)
    engine.dispose()
