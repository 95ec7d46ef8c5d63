"""Bring a database to the newest schema, and tell whether it is there."""

from __future__ import annotations

from functools import cache
from typing import Any

from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, func, select
from sqlalchemy.exc import SQLAlchemyError

from gaitlab.errors import Misconfigured
from gaitlab.paths import data_folder
from gaitlab.store import people, tables
from gaitlab.store.base import Base
from gaitlab.store.database import WRITES

METADATA = Base.metadata
TABLE_MODULES = (people, tables)


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(data_folder("migrations")).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    return config


@cache
def _revisions() -> tuple[str, frozenset[str]]:
    """The newest revision this program has, and all it knows."""
    script = ScriptDirectory.from_config(_config())
    head = script.get_current_head()
    if head is None:
        raise Misconfigured(
            "migrations", "The migrations are missing from this installation.", "Install it again."
        )
    return head, frozenset(revision.revision for revision in script.walk_revisions())


def revision(engine: Engine) -> str | None:
    """The database's revision; None where it is empty."""
    with engine.connect() as connection:
        return MigrationContext.configure(connection).get_current_revision()


def migrate(engine: Engine) -> None:
    """Bring the database to head, in one transaction; does nothing where it is there already.

    Raises
    ------
    Misconfigured
        If the database cannot be reached or was made by a newer version of gaitlab.
    """
    head, known = _revisions()
    try:
        with engine.connect().execution_options(**{WRITES: True}) as connection, connection.begin():
            if engine.dialect.name == "postgresql":
                connection.execute(select(func.pg_advisory_xact_lock(func.hashtext("gaitlab migrate"))))
            current = MigrationContext.configure(connection).get_current_revision()
            if current is not None and current not in known:
                raise Misconfigured(
                    "database_newer",
                    f"The database is at revision {current}, which this version of gaitlab does not know.",
                    "Start the newer version of gaitlab that made it, or restore an older backup.",
                )
            if current != head:
                config = _config()
                config.attributes["connection"] = connection
                command.upgrade(config, "head")
    except SQLAlchemyError as problem:
        raise Misconfigured(
            "database",
            f"The database cannot be used ({type(problem).__name__}).",
            "Check GAITLAB_DATABASE_URL, that the database server runs, and that the data folder is writable.",
        ) from problem


def at_head(engine: Engine) -> bool:
    """Has the database the newest schema?"""
    return revision(engine) == _revisions()[0]


def differences(engine: Engine) -> list[Any]:
    """What the database's schema lacks or has too much, compared with the mapped classes."""
    with engine.connect() as connection:
        return list(
            compare_metadata(MigrationContext.configure(connection, opts={"compare_type": True}), METADATA)
        )
