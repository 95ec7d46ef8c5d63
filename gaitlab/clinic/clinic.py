"""The clinic: opened once per process; every use case happens at one of its desks."""

from __future__ import annotations

import datetime as dt
import hashlib
import hmac
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from gaitlab.clinic.access import Principal
from gaitlab.clinic.desk import Desk
from gaitlab.clinic.settings import ClinicSettings
from gaitlab.errors import GaitlabError, Misconfigured
from gaitlab.store import audit, schema
from gaitlab.store.base import new_id
from gaitlab.store.database import Database, one_at_a_time, open_engine, require_durable, utc_now
from gaitlab.store.files import Files
from gaitlab.store.people import Site

__all__ = ["DEFAULT_SITE", "Clinic", "ClinicSettings", "Desk"]

DEFAULT_SITE = "default"
_KEY_BYTES = 32


class Clinic:
    """Database, files and secret key of one installation. Safe to use from many threads.

    Attributes
    ----------
    now : callable
        The clock: an aware instant in UTC. Tests put their own here.
    """

    def __init__(self, settings: ClinicSettings, database: Database, files: Files, key: bytes) -> None:
        self.settings = settings
        self.database = database
        self.files = files
        self.now: Callable[[], dt.datetime] = utc_now
        self._key = key

    @classmethod
    def open(cls, settings: ClinicSettings) -> Clinic:
        """Make the data folder (0700) and key (0600) where missing, and bring the database to head.

        Raises
        ------
        Misconfigured
            If folder, key or database cannot be used, or the database is newer than this program.
        """
        _make_folder(settings.data_dir)
        key = _read_key(settings.data_dir / "secret.key")
        files = Files(settings.files_url or str((settings.data_dir / "files").resolve()))
        engine = open_engine(settings.database_url, settings.data_dir)
        try:
            schema.migrate(engine)
            require_durable(engine)
            clinic = cls(settings, Database(engine), files, key)
            clinic._add_default_site()
        except BaseException:
            engine.dispose()
            raise
        return clinic

    @contextmanager
    def desk(self, principal: Principal, *, request_id: str = "", address: str = "") -> Iterator[Desk]:
        """Open a desk for a caller. On an error nothing is stored but, in the audit trail, the refusal.

        What was looked at stays in the trail even then.
        """
        desk = Desk(self, principal, request_id=request_id, address=address)
        try:
            yield desk
            desk.finish()
        except GaitlabError as problem:
            desk.refuse(problem)
            raise
        except BaseException:
            desk.abandon()
            raise
        finally:
            desk.close()

    def record(self, db: Session, actor: audit.Actor, events: list[audit.Event]) -> None:
        """Write audit events within the write transaction of ``db``."""
        audit.append(db, self.secret("audit"), self.now(), actor, events)

    def secret(self, purpose: str) -> bytes:
        """A key of its own for each purpose, from the installation's key."""
        return hmac.new(self._key, f"gaitlab {purpose}".encode(), hashlib.sha256).digest()

    def form_key(self) -> bytes:
        """Secret for the HMAC of form tokens (CSRF): 32 bytes, the same in all processes on this data."""
        return self.secret("forms")

    def ready(self) -> bool:
        """Does the database answer, is it at head, and can the data folder be written?"""
        try:
            with tempfile.TemporaryFile(dir=self.settings.data_dir) as probe:
                probe.write(b"ready")
            return schema.at_head(self.database.engine)
        except (OSError, SQLAlchemyError):
            return False

    def close(self) -> None:
        """Let go of the database."""
        self.database.engine.dispose()

    def _add_default_site(self) -> None:
        with self.database.reading() as db:
            if db.scalar(select(Site.id).limit(1)) is not None:
                return
        with self.database.writing() as db:
            one_at_a_time(db, "site")
            if db.scalar(select(Site.id).limit(1)) is None:
                site = Site(id=new_id(), name=DEFAULT_SITE, created_at=self.now())
                db.add(site)
                actor = audit.Actor("system", "system", site_id=site.id)
                self.record(db, actor, [audit.Event("site.add", object_id=site.id)])


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK | os.X_OK):
            raise PermissionError
    except OSError as problem:
        raise Misconfigured(
            "data_dir",
            f"The data folder {folder} cannot be made or written ({type(problem).__name__}).",
            "Give GAITLAB_DATA_DIR a folder that this user may write.",
        ) from problem


def _read_key(path: Path) -> bytes:
    """The installation's secret key; made on the first start."""
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        return _existing_key(path)
    key = os.urandom(_KEY_BYTES)
    with os.fdopen(descriptor, "wb") as file:
        file.write(key)
        file.flush()
        os.fsync(file.fileno())
    return key


def _existing_key(path: Path) -> bytes:
    for _ in range(20):
        key = path.read_bytes()
        if len(key) == _KEY_BYTES:
            return key
        time.sleep(0.05)  # another process may just be writing it
    raise Misconfigured(
        "secret_key",
        f"The secret key {path} is damaged.",
        "Restore it from a backup; if this is the first start ever, delete it and start again.",
    )
