"""The database: engine, transactions, and schema upgrades. SQLite or PostgreSQL, the same code for both."""

from __future__ import annotations

import datetime as dt
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, func, select
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError, NoSuchModuleError, OperationalError
from sqlalchemy.orm import ORMExecuteState, Session, with_loader_criteria

from gaitlab.errors import GaitlabError, Misconfigured
from gaitlab.store.base import OfSite

LOCK_TIMEOUT_S = 15.0
WRITES = "gaitlab_writes"
_SITE = "gaitlab_site"
_MENDED_BRANCHES = ((3, 44, 6), (3, 50, 7))
_MENDED_SINCE = (3, 51, 3)


def journal_settings(version: tuple[int, ...]) -> tuple[str, str]:
    """Journal mode and ``synchronous`` for this version of SQLite.

    The write-ahead log can corrupt a database in versions 3.7.0 to 3.51.2, but for two branches mended later
    (https://sqlite.org/changes.html, 3.51.3); those get the rollback journal.
    """
    on_mended_branch = any(version[:2] == mended[:2] and version >= mended for mended in _MENDED_BRANCHES)
    return ("WAL", "FULL") if version >= _MENDED_SINCE or on_mended_branch else ("TRUNCATE", "EXTRA")


def normalised_url(url: str) -> str:
    """``postgresql://`` (or ``postgres://``) means psycopg 3; anything but PostgreSQL and SQLite is refused."""
    scheme, separator, rest = url.partition("://")
    if separator and scheme in ("postgresql", "postgres", "postgresql+psycopg"):
        return f"postgresql+psycopg://{rest}"
    if separator and scheme == "sqlite":
        return url
    raise Misconfigured(
        "database_url",
        "GAITLAB_DATABASE_URL is neither a postgresql:// nor a sqlite:// address.",
        "Write postgresql://user:password@host/database, or leave it out for SQLite in the data folder.",
    )


def open_engine(url: str | None, data_dir: Path) -> Engine:
    """Engine for ``url``, or for SQLite in ``data_dir``.

    Raises
    ------
    Misconfigured
        If the address cannot be used or the driver is missing.
    """
    address = normalised_url(url) if url else f"sqlite:///{data_dir / 'gaitlab.sqlite3'}"
    try:
        parsed = make_url(address)
        if parsed.get_backend_name() == "sqlite":
            engine = create_engine(parsed, connect_args={"check_same_thread": False})
            _keep_sqlite_safe(engine)
            return engine
        return create_engine(parsed, pool_pre_ping=True, isolation_level="READ COMMITTED")
    except (ArgumentError, NoSuchModuleError, ValueError):
        raise Misconfigured("database_url", "GAITLAB_DATABASE_URL is not a valid address.") from None
    except ModuleNotFoundError:
        raise Misconfigured(
            "database_driver",
            "The driver for PostgreSQL is not installed.",
            "Install it with: pip install 'gaitlab[postgresql]'",
        ) from None


def require_durable(engine: Engine) -> None:
    """Refuse a PostgreSQL server that would lose what it has confirmed.

    Raises
    ------
    Misconfigured
        If ``fsync`` or ``synchronous_commit`` is off.
    """
    if engine.dialect.name != "postgresql":
        return
    with engine.connect() as connection:
        off = [
            name
            for name in ("fsync", "synchronous_commit")
            if connection.scalar(select(func.current_setting(name))) == "off"
        ]
    if off:
        raise Misconfigured(
            "database_not_durable",
            f"The PostgreSQL server has {' and '.join(off)} switched off: it could lose records after confirming them.",
            f"Switch {' and '.join(off)} on.",
        )


def _keep_sqlite_safe(engine: Engine) -> None:
    journal, synchronous = journal_settings(sqlite3.sqlite_version_info)

    @event.listens_for(engine, "connect")
    def configure(connection: Any, _record: Any) -> None:
        connection.isolation_level = None  # SQLAlchemy begins transactions below, not the driver
        for pragma in (
            f"busy_timeout={int(LOCK_TIMEOUT_S * 1000)}",
            f"journal_mode={journal}",
            f"synchronous={synchronous}",
            "foreign_keys=ON",
            "trusted_schema=OFF",
            "secure_delete=ON",
            "cell_size_check=ON",
            "mmap_size=0",
        ):
            connection.execute(f"PRAGMA {pragma}").close()

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get(WRITES, False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def busy() -> GaitlabError:
    """Somebody else kept the records locked for too long."""
    return GaitlabError("busy", "The records are busy.", "Try again in a moment.")


class Transaction:
    """One database session that reads until it has to write, and commits once.

    Reading needs no lock. ``write()`` ends the reading and begins anew as the only writer (SQLite), so whatever a
    change depends on has to be read after it.

    Parameters
    ----------
    site_id : str or None
        The site whose rows alone are seen; None sees all (log-in, audit, upkeep).
    """

    def __init__(self, database: Database, site_id: str | None) -> None:
        self._database = database
        self._session = Session(database.engine, expire_on_commit=False)
        self._session.info[_SITE] = site_id
        self.writing = False

    def read(self) -> Session:
        """The session, in whatever state it is."""
        return self._session

    def write(self) -> Session:
        """The session, with the right to change rows until ``commit`` or ``rollback``."""
        if not self.writing:
            self._session.rollback()
            self._database.take_write_lock()
            self.writing = True
            try:
                self._session.connection(execution_options={WRITES: True})
            except OperationalError as problem:
                self.rollback()
                raise busy() from problem
        return self._session

    def pause(self) -> None:
        """Let go of what was read before lengthy work, unless changes are pending."""
        if not self.writing:
            self._session.rollback()

    def commit(self) -> None:
        try:
            self._session.commit()
        finally:
            self._release()

    def rollback(self) -> None:
        try:
            self._session.rollback()
        finally:
            self._release()

    def close(self) -> None:
        try:
            self._session.close()
        finally:
            self._release()

    def _release(self) -> None:
        if self.writing:
            self.writing = False
            self._database.give_write_lock()


class Database:
    """An engine and the rule that one thread of a process writes SQLite at a time."""

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._writer = threading.Lock() if engine.dialect.name == "sqlite" else None

    def transaction(self, site_id: str | None) -> Transaction:
        """A new transaction; close it whatever happens."""
        return Transaction(self, site_id)

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """A session on the rows of all sites, for what happens before anybody is known."""
        transaction = self.transaction(None)
        try:
            yield transaction.read()
        finally:
            transaction.close()

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """A session on the rows of all sites that commits at the end, and on an error changes nothing."""
        transaction = self.transaction(None)
        try:
            yield transaction.write()
            transaction.commit()
        finally:
            transaction.close()

    def take_write_lock(self) -> None:
        if self._writer is not None and not self._writer.acquire(timeout=LOCK_TIMEOUT_S):
            raise busy()

    def give_write_lock(self) -> None:
        if self._writer is not None:
            self._writer.release()


@event.listens_for(Session, "do_orm_execute")
def _only_this_site(state: ORMExecuteState) -> None:
    """Second wall between sites; the first is that every query of ``records.py`` names the site."""
    site_id = state.session.info.get(_SITE)
    if site_id is not None and not state.is_column_load and not state.is_relationship_load:
        state.statement = state.statement.options(
            with_loader_criteria(OfSite, lambda row: row.site_id == site_id, include_aliases=True)
        )


def one_at_a_time(session: Session, what: str, *, shared: bool = False) -> None:
    """Until the transaction ends, keep others out who ask for the same ``what`` (SQLite: writers wait anyway)."""
    if session.get_bind().dialect.name == "postgresql":
        lock = func.pg_advisory_xact_lock_shared if shared else func.pg_advisory_xact_lock
        session.execute(select(lock(func.hashtext(f"gaitlab {what}"))))


def utc_now() -> dt.datetime:
    """Now, aware, in UTC."""
    return dt.datetime.now(dt.UTC)
