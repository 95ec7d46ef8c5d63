from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.api.visitors import House, open_house
from tests.databases import migrated_url, postgresql_url, sqlite_at_head

__all__ = ["migrated_url", "postgresql_url", "sqlite_at_head"]


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    """A new application with nobody's records in it."""
    with open_house(tmp_path) as made:
        yield made
