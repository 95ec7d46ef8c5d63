"""What all tables share: naming convention, ids, time in UTC, and belonging to a site."""

from __future__ import annotations

import base64
import datetime as dt
import re
import secrets
from typing import Any, ClassVar

from sqlalchemy import DateTime, Dialect, ForeignKey, MetaData, String
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column
from sqlalchemy.types import TypeDecorator

ID_PATTERN = re.compile(r"[a-z2-7]{26}")
SHA256_PATTERN = re.compile(r"[0-9a-f]{64}")

Id = String(26)
Sha256 = String(64)


def new_id() -> str:
    """128 random bits as 26 letters and digits: nobody can guess another one, and it can be read out."""
    return base64.b32encode(secrets.token_bytes(16)).decode().rstrip("=").lower()


class UtcDateTime(TypeDecorator[dt.datetime]):
    """An instant: aware and in UTC on every engine (SQLite keeps no time zone)."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: dt.datetime | None, dialect: Dialect) -> dt.datetime | None:
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError("an instant needs a time zone")
        utc = value.astimezone(dt.UTC)
        return utc.replace(tzinfo=None) if dialect.name == "sqlite" else utc

    def process_result_value(self, value: dt.datetime | None, dialect: Dialect) -> dt.datetime | None:
        if value is None:
            return None
        return value.replace(tzinfo=dt.UTC) if value.tzinfo is None else value.astimezone(dt.UTC)


class Base(DeclarativeBase):
    """Base of all tables."""

    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map: ClassVar[dict[Any, Any]] = {dt.datetime: UtcDateTime()}


class Identified:
    """A row with an id that says nothing and cannot be guessed."""

    id: Mapped[str] = mapped_column(Id, primary_key=True, default=new_id, sort_order=-2)


class OfSite:
    """A row that belongs to a site; sessions opened for a site see no other (``database.py``)."""

    site_id: Mapped[str] = mapped_column(Id, ForeignKey("site.id"), sort_order=-1)
