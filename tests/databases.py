"""The two databases that the same tests run on: SQLite in a new folder, PostgreSQL in a schema of its own."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, text
from sqlalchemy.exc import OperationalError

from gaitlab.store.database import normalised_url

DEFAULT_POSTGRESQL = "postgresql://postgres@127.0.0.1:5432/test"


def postgresql_server() -> str:
    """Address of the server for tests; skips with the reason where none answers."""
    url = os.environ.get("GAITLAB_TEST_POSTGRESQL_URL", DEFAULT_POSTGRESQL)
    engine = create_engine(normalised_url(url), connect_args={"connect_timeout": 3})
    try:
        with engine.connect():
            return url
    except OperationalError:
        pytest.skip("no PostgreSQL answers; GAITLAB_TEST_POSTGRESQL_URL can name one")
    finally:
        engine.dispose()


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Address of a new, empty database of each kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'gaitlab.sqlite3'}"
        return
    server = postgresql_server()
    schema = f"gaitlab_{secrets.token_hex(8)}"
    admin = create_engine(normalised_url(server), isolation_level="AUTOCOMMIT")
    with admin.connect() as connection:
        connection.execute(text(f"CREATE SCHEMA {schema}"))
    try:
        joint = "&" if "?" in server else "?"
        yield f"{server}{joint}options=-csearch_path%3D{schema}"
    finally:
        with admin.connect() as connection:
            connection.execute(text(f"DROP SCHEMA {schema} CASCADE"))
        admin.dispose()


def raw(engine: Engine) -> Callable[..., list[tuple[object, ...]]]:
    """Run SQL beside the program, as somebody with the database in their hands would."""

    def run(sql: str, **values: object) -> list[tuple[object, ...]]:
        with engine.connect() as connection, connection.begin():
            result = connection.execute(text(sql), values)
            return [tuple(row) for row in result] if result.returns_rows else []

    return run
