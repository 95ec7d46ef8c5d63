"""The two databases that the same tests run on: SQLite in a new folder, PostgreSQL on a server that answers.

Import the fixtures into a ``conftest.py``: ``database_url`` is an empty database, ``migrated_url`` one at head.
"""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, make_url, text
from sqlalchemy.exc import OperationalError

from gaitlab.store import schema
from gaitlab.store.database import normalised_url, open_engine

N_TRIGGERS = 5
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


@contextmanager
def postgresql_database() -> Iterator[str]:
    """A new database on the server, dropped afterwards; gives its address."""
    server = postgresql_server()
    name = f"gaitlab_test_{secrets.token_hex(8)}"
    admin = create_engine(normalised_url(server), isolation_level="AUTOCOMMIT")
    try:
        with admin.connect() as connection:
            connection.execute(text(f"CREATE DATABASE {name}"))
            try:
                yield make_url(server).set(database=name).render_as_string(hide_password=False)
            finally:
                connection.execute(text(f"DROP DATABASE {name} WITH (FORCE)"))
    finally:
        admin.dispose()


@pytest.fixture(scope="session")
def postgresql_url() -> Iterator[str]:
    """Address of one PostgreSQL database for the whole run; making one for each test would take too long."""
    with postgresql_database() as url:
        yield url


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Address of an empty database of each kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'gaitlab.sqlite3'}"
        return
    url: str = request.getfixturevalue("postgresql_url")
    with _engine(url) as engine:
        _drop_everything(engine)
        yield url
        _drop_everything(engine)


@pytest.fixture(scope="session")
def sqlite_at_head(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A SQLite database at head and without rows, to copy."""
    folder = tmp_path_factory.mktemp("at-head")
    engine = open_engine(None, folder)
    schema.migrate(engine)
    engine.dispose()
    return folder / "gaitlab.sqlite3"


@pytest.fixture(params=["sqlite", "postgresql"])
def migrated_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Address of a database of each kind at head and without rows."""
    if request.param == "sqlite":
        shutil.copy(request.getfixturevalue("sqlite_at_head"), tmp_path / "gaitlab.sqlite3")
        return f"sqlite:///{tmp_path / 'gaitlab.sqlite3'}"
    url: str = request.getfixturevalue("postgresql_url")
    with _engine(url) as engine:
        if not _delete_rows(engine):
            _drop_everything(engine)
            schema.migrate(engine)
    return url


@contextmanager
def _engine(url: str) -> Iterator[Engine]:
    engine = create_engine(normalised_url(url))
    try:
        yield engine
    finally:
        engine.dispose()


def _drop_everything(engine: Engine) -> None:
    with engine.begin() as connection:
        connection.execute(text("DROP SCHEMA public CASCADE"))
        connection.execute(text("CREATE SCHEMA public"))


def _delete_rows(engine: Engine) -> bool:
    """Empty all tables, if they are as the migrations make them."""
    with engine.begin() as connection:
        triggers = text("SELECT count(*) FROM pg_trigger WHERE NOT tgisinternal")
        if (
            connection.scalar(triggers) != N_TRIGGERS
            or not schema.at_head(engine)
            or schema.differences(engine)
        ):
            return False
        connection.execute(text("ALTER TABLE audit_event DISABLE TRIGGER USER"))
        for table in reversed(schema.METADATA.sorted_tables):
            connection.execute(table.delete())
        connection.execute(text("ALTER TABLE audit_event ENABLE TRIGGER USER"))
    return True


def raw(engine: Engine) -> Callable[..., list[tuple[object, ...]]]:
    """Run SQL beside the program, as somebody with the database in their hands would."""

    def run(sql: str, **values: object) -> list[tuple[object, ...]]:
        with engine.connect() as connection, connection.begin():
            result = connection.execute(text(sql), values)
            return [tuple(row) for row in result] if result.returns_rows else []

    return run
