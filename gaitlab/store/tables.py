"""Tables of the records: patients, sessions, trials, files, analyses.

Children point at their parent together with the site, so that no row can belong to a parent of another site.
"""

from __future__ import annotations

import datetime as dt
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    String,
    Text,
    UniqueConstraint,
    text,
)
from sqlalchemy.orm import Mapped, mapped_column, relationship

from gaitlab.store.base import Base, Id, Identified, OfSite, Sha256

_NOT_DELETED = text("deleted_at IS NULL")


class Patient(Identified, OfSite, Base):
    """A patient.

    ``code_key`` is the code as it is compared; ``pseudonym`` stands for the code where names may not be seen.
    """

    __tablename__ = "patient"
    __table_args__ = (
        UniqueConstraint("site_id", "id"),
        UniqueConstraint("site_id", "pseudonym"),
        Index(
            "uq_patient_site_id_code_key",
            "site_id",
            "code_key",
            unique=True,
            sqlite_where=_NOT_DELETED,
            postgresql_where=_NOT_DELETED,
        ),
    )

    code: Mapped[str] = mapped_column(String(64))
    code_key: Mapped[str] = mapped_column(String(256))
    pseudonym: Mapped[str] = mapped_column(String(12))
    sex: Mapped[str] = mapped_column(String(10))
    birth_year: Mapped[int | None]
    height_m: Mapped[float | None]
    weight_kg: Mapped[float | None]
    leg_length_m: Mapped[float | None]
    diagnosis: Mapped[str] = mapped_column(String(200))
    note: Mapped[str] = mapped_column(Text)
    version: Mapped[int]
    created_at: Mapped[dt.datetime]
    updated_at: Mapped[dt.datetime]
    deleted_at: Mapped[dt.datetime | None]


class PatientVersion(OfSite, Base):
    """What a patient's record said at a version, and who wrote it.

    The audit trail holds only a salted hash of ``content``, so that erasing a patient later leaves the trail whole.
    """

    __tablename__ = "patient_version"
    __table_args__ = (ForeignKeyConstraint(["site_id", "patient_id"], ["patient.site_id", "patient.id"]),)

    patient_id: Mapped[str] = mapped_column(Id, primary_key=True)
    version: Mapped[int] = mapped_column(primary_key=True)
    content: Mapped[str] = mapped_column(Text)
    salt: Mapped[str] = mapped_column(Sha256)
    at: Mapped[dt.datetime]
    by: Mapped[str] = mapped_column(String(26))


class Session(Identified, OfSite, Base):
    """One visit: one test, one or more trials of it."""

    __tablename__ = "session"
    __table_args__ = (
        UniqueConstraint("site_id", "id"),
        ForeignKeyConstraint(["site_id", "patient_id"], ["patient.site_id", "patient.id"]),
        Index(None, "patient_id", "date"),
        CheckConstraint("test IN ('t25fw', '10mwt', 'walk')", name="test"),
    )

    patient_id: Mapped[str] = mapped_column(Id)
    date: Mapped[dt.date]
    test: Mapped[str] = mapped_column(String(10))
    course_m: Mapped[float | None]
    note: Mapped[str] = mapped_column(Text)
    created_at: Mapped[dt.datetime]
    created_by: Mapped[str] = mapped_column(String(26))

    patient: Mapped[Patient] = relationship(viewonly=True)
    trials: Mapped[list[Trial]] = relationship(order_by="Trial.number", viewonly=True)


class Trial(Identified, OfSite, Base):
    """One recorded walk of a session."""

    __tablename__ = "trial"
    __table_args__ = (
        UniqueConstraint("site_id", "id"),
        UniqueConstraint("session_id", "number"),
        ForeignKeyConstraint(["site_id", "session_id"], ["session.site_id", "session.id"]),
    )

    session_id: Mapped[str] = mapped_column(Id)
    number: Mapped[int]
    created_at: Mapped[dt.datetime]
    created_by: Mapped[str] = mapped_column(String(26))

    session: Mapped[Session] = relationship(viewonly=True)
    files: Mapped[list[TrialFile]] = relationship(order_by="TrialFile.position", viewonly=True)
    analyses: Mapped[list[Analysis]] = relationship(order_by="Analysis.number.desc()", viewonly=True)


class RawFile(OfSite, Base):
    """A raw file's content, which lies outside the database under its hash (``files.py``)."""

    __tablename__ = "raw_file"

    site_id: Mapped[str] = mapped_column(Id, ForeignKey("site.id"), primary_key=True)
    sha256: Mapped[str] = mapped_column(Sha256, primary_key=True)
    size_bytes: Mapped[int] = mapped_column(BigInteger)
    created_at: Mapped[dt.datetime]


class TrialFile(OfSite, Base):
    """Which raw file was recorded where in a trial, and what it was called."""

    __tablename__ = "trial_file"
    __table_args__ = (
        ForeignKeyConstraint(["site_id", "trial_id"], ["trial.site_id", "trial.id"]),
        ForeignKeyConstraint(["site_id", "sha256"], ["raw_file.site_id", "raw_file.sha256"]),
        Index(None, "site_id", "device"),
        Index(None, "sha256"),
    )

    trial_id: Mapped[str] = mapped_column(Id, primary_key=True)
    placement: Mapped[str] = mapped_column(String(20), primary_key=True)
    position: Mapped[int]
    sha256: Mapped[str] = mapped_column(Sha256)
    name: Mapped[str] = mapped_column(String(255))
    device: Mapped[str | None] = mapped_column(String(100))
    created_at: Mapped[dt.datetime]

    raw: Mapped[RawFile] = relationship(viewonly=True)


class Analysis(Identified, OfSite, Base):
    """One analysis of a trial: added, never overwritten; the highest number is current."""

    __tablename__ = "analysis"
    __table_args__ = (
        UniqueConstraint("trial_id", "number"),
        ForeignKeyConstraint(["site_id", "trial_id"], ["trial.site_id", "trial.id"]),
        Index(None, "series_sha256"),
    )

    trial_id: Mapped[str] = mapped_column(Id)
    number: Mapped[int]
    gaitlab: Mapped[str] = mapped_column(String(50))
    method: Mapped[str] = mapped_column(String(50))
    settings: Mapped[dict[str, Any]] = mapped_column(JSON)
    settings_sha256: Mapped[str] = mapped_column(Sha256)
    result_json: Mapped[str] = mapped_column(Text, deferred=True)
    series_sha256: Mapped[str] = mapped_column(Sha256)
    created_at: Mapped[dt.datetime]
    created_by: Mapped[str] = mapped_column(String(26))


class Idempotency(OfSite, Base):
    """What a request with an Idempotency-Key made, so that a retry is answered and not done again."""

    __tablename__ = "idempotency"

    site_id: Mapped[str] = mapped_column(Id, ForeignKey("site.id"), primary_key=True)
    owner_id: Mapped[str] = mapped_column(String(26), primary_key=True)
    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    request_sha256: Mapped[str] = mapped_column(Sha256)
    object_id: Mapped[str] = mapped_column(Id)
    created_at: Mapped[dt.datetime]


class AuditEvent(Base):
    """One link of the audit trail (``audit.py``); the database refuses to change or delete it."""

    __tablename__ = "audit_event"
    __table_args__ = (Index(None, "site_id", "seq"), Index(None, "patient_id"))

    seq: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    at: Mapped[dt.datetime]
    site_id: Mapped[str] = mapped_column(String(26))
    actor_kind: Mapped[str] = mapped_column(String(10))
    actor_id: Mapped[str] = mapped_column(String(26))
    actor_roles: Mapped[str] = mapped_column(String(100))
    credential_id: Mapped[str] = mapped_column(String(64))
    action: Mapped[str] = mapped_column(String(40))
    patient_id: Mapped[str] = mapped_column(String(26))
    object_id: Mapped[str] = mapped_column(String(26))
    details: Mapped[str] = mapped_column(Text)
    address: Mapped[str] = mapped_column(String(64))
    request_id: Mapped[str] = mapped_column(String(64))
    outcome: Mapped[str] = mapped_column(String(10))
    prev_hash: Mapped[str] = mapped_column(Sha256)
    hash: Mapped[str] = mapped_column(Sha256)


class AuditHead(Base):
    """The last link, sealed with the installation's key so that a trail cut short is noticed."""

    __tablename__ = "audit_head"

    id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    seq: Mapped[int] = mapped_column(BigInteger)
    hash: Mapped[str] = mapped_column(Sha256)
    seal: Mapped[str] = mapped_column(Sha256)
