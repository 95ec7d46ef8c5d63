"""The two databases that the same tests run on: SQLite in a new folder, PostgreSQL on a server that answers.

Import the fixtures into a ``conftest.py``: ``database_url`` is an empty database, ``migrated_url`` one at head.
"""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, make_url, text
from sqlalchemy.exc import OperationalError

from gaitlab.store import schema
from gaitlab.store.database import normalised_url, open_engine

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
def postgresql_database(template: str = "template1") -> Iterator[str]:
    """A new database on the server, dropped afterwards; gives its address."""
    server = postgresql_server()
    name = f"gaitlab_test_{secrets.token_hex(8)}"
    admin = create_engine(normalised_url(server), isolation_level="AUTOCOMMIT")
    try:
        with admin.connect() as connection:
            connection.execute(text(f"CREATE DATABASE {name} TEMPLATE {template}"))
            try:
                yield make_url(server).set(database=name).render_as_string(hide_password=False)
            finally:
                connection.execute(text(f"DROP DATABASE {name} WITH (FORCE)"))
    finally:
        admin.dispose()


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Address of a new, empty database of each kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'gaitlab.sqlite3'}"
    else:
        with postgresql_database() as url:
            yield url


@pytest.fixture(scope="session")
def postgresql_template(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Name of a PostgreSQL database at head, to copy from."""
    with postgresql_database() as url:
        engine = open_engine(url, tmp_path_factory.mktemp("template"))
        schema.migrate(engine)
        engine.dispose()
        yield str(make_url(url).database)


@pytest.fixture(params=["sqlite", "postgresql"])
def migrated_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Address of a new database of each kind with all tables (SQLite: made when it is opened)."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'gaitlab.sqlite3'}"
    else:
        with postgresql_database(request.getfixturevalue("postgresql_template")) as url:
            yield url


def raw(engine: Engine) -> Callable[..., list[tuple[object, ...]]]:
    """Run SQL beside the program, as somebody with the database in their hands would."""

    def run(sql: str, **values: object) -> list[tuple[object, ...]]:
        with engine.connect() as connection, connection.begin():
            result = connection.execute(text(sql), values)
            return [tuple(row) for row in result] if result.returns_rows else []

    return run
