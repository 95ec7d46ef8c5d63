"""Tables of people and their credentials: sites, accounts, web sessions, tokens, attempts."""

from __future__ import annotations

import datetime as dt

from sqlalchemy import JSON, CheckConstraint, ForeignKeyConstraint, Index, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from gaitlab.store.base import Base, Id, Identified, OfSite, Sha256


class Site(Identified, Base):
    """A clinic or laboratory: the wall that no record is seen across."""

    __tablename__ = "site"

    name: Mapped[str] = mapped_column(String(100), unique=True)
    created_at: Mapped[dt.datetime]


class Account(Identified, OfSite, Base):
    """A person who can log in."""

    __tablename__ = "account"
    __table_args__ = (UniqueConstraint("site_id", "id"),)

    email: Mapped[str] = mapped_column(String(254), unique=True)
    name: Mapped[str] = mapped_column(String(100))
    password_hash: Mapped[str] = mapped_column(String(255))
    roles: Mapped[list[str]] = mapped_column(JSON)
    created_at: Mapped[dt.datetime]
    disabled_at: Mapped[dt.datetime | None]


class WebSession(Identified, OfSite, Base):
    """A person logged in with a browser. Only the hash of the cookie's secret is kept."""

    __tablename__ = "web_session"
    __table_args__ = (
        ForeignKeyConstraint(["site_id", "account_id"], ["account.site_id", "account.id"]),
        Index(None, "account_id"),
    )

    account_id: Mapped[str] = mapped_column(Id)
    secret_sha256: Mapped[str] = mapped_column(Sha256, unique=True)
    created_at: Mapped[dt.datetime]
    last_seen_at: Mapped[dt.datetime]
    ended_at: Mapped[dt.datetime | None]


class SetupCode(Identified, Base):
    """A one-time code for the first account."""

    __tablename__ = "setup_code"

    code_sha256: Mapped[str] = mapped_column(Sha256, unique=True)
    created_at: Mapped[dt.datetime]
    expires_at: Mapped[dt.datetime]
    used_at: Mapped[dt.datetime | None]


class ApiToken(Identified, OfSite, Base):
    """A token for programs; it acts for its owner within its scopes. Only the hash of its secret is kept."""

    __tablename__ = "api_token"
    __table_args__ = (
        ForeignKeyConstraint(["site_id", "account_id"], ["account.site_id", "account.id"]),
        Index(None, "account_id"),
    )

    account_id: Mapped[str] = mapped_column(Id)
    name: Mapped[str] = mapped_column(String(100))
    secret_sha256: Mapped[str] = mapped_column(Sha256)
    scopes: Mapped[list[str]] = mapped_column(JSON)
    created_at: Mapped[dt.datetime]
    expires_at: Mapped[dt.datetime]
    last_used_at: Mapped[dt.datetime | None]
    last_refused_at: Mapped[dt.datetime | None]
    revoked_at: Mapped[dt.datetime | None]


class LoginAttempt(Identified, Base):
    """An attempt to log in. Account and address are keyed hashes: what was typed is not kept."""

    __tablename__ = "login_attempt"
    __table_args__ = (
        CheckConstraint("outcome IN ('failed', 'succeeded', 'limited')", name="outcome"),
        Index(None, "account_key", "at"),
        Index(None, "address_key", "at"),
    )

    at: Mapped[dt.datetime]
    account_key: Mapped[str] = mapped_column(Sha256)
    address_key: Mapped[str] = mapped_column(Sha256)
    outcome: Mapped[str] = mapped_column(String(10))
