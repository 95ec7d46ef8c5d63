"""Guessing is slowed: so many failures per account and per address in a sliding window, and never a lock for good."""

from __future__ import annotations

import datetime as dt
import hashlib
import hmac
from dataclasses import dataclass

from sqlalchemy import ColumnElement, delete, func, select, update
from sqlalchemy.orm import Session

from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.desk import shortened
from gaitlab.errors import TooManyAttempts
from gaitlab.store import audit
from gaitlab.store.base import new_id
from gaitlab.store.database import one_at_a_time
from gaitlab.store.people import LoginAttempt

_KEPT = dt.timedelta(days=1)


@dataclass(frozen=True)
class Attempt:
    """An attempt that was let through; it counts as failed until ``succeeded``."""

    id: str
    account_key: str
    address_key: str


def begin(clinic: Clinic, *, account: str, address: str) -> Attempt:
    """Note an attempt before its password is looked at, so that many at once cannot slip through.

    Raises
    ------
    TooManyAttempts
        Such attempts do not count, so the window empties by itself; the first of them enters the audit trail.
    """
    attempt = Attempt(new_id(), _key(clinic, "account", account), _key(clinic, "address", address))
    with clinic.database.writing() as db:
        one_at_a_time(db, "attempts")
        db.execute(delete(LoginAttempt).where(LoginAttempt.at < clinic.now() - _KEPT))
        limited = _is_limited(clinic, db, attempt)
        if not limited:
            _add(clinic, db, attempt, "failed")
        elif _count(clinic, db, LoginAttempt.address_key == attempt.address_key, "limited") == 0:
            _add(clinic, db, attempt, "limited")
            actor = audit.Actor("anonymous", "", address=shortened(address))
            details = {"code": "too_many_attempts"}
            clinic.record(db, actor, [audit.Event("session.log_in", details=details, outcome="refused")])
    if limited:
        raise TooManyAttempts(
            "too_many_attempts",
            "There were too many attempts.",
            f"Wait {clinic.settings.attempt_window_minutes} minutes, then try again.",
        )
    return attempt


def succeeded(db: Session, attempt: Attempt) -> None:
    """The attempt was right: this account's failures from this address are forgiven."""
    db.execute(update(LoginAttempt).where(LoginAttempt.id == attempt.id).values(outcome="succeeded"))
    db.execute(
        delete(LoginAttempt).where(
            LoginAttempt.account_key == attempt.account_key,
            LoginAttempt.address_key == attempt.address_key,
            LoginAttempt.outcome == "failed",
        )
    )


def _is_limited(clinic: Clinic, db: Session, attempt: Attempt) -> bool:
    limits = clinic.settings
    return (
        _count(clinic, db, LoginAttempt.account_key == attempt.account_key) >= limits.attempts_per_account
        or _count(clinic, db, LoginAttempt.address_key == attempt.address_key) >= limits.attempts_per_address
    )


def _count(clinic: Clinic, db: Session, whose: ColumnElement[bool], outcome: str = "failed") -> int:
    since = clinic.now() - dt.timedelta(minutes=clinic.settings.attempt_window_minutes)
    counted = select(func.count()).select_from(LoginAttempt)
    return db.scalar(counted.where(whose, LoginAttempt.outcome == outcome, LoginAttempt.at > since)) or 0


def _add(clinic: Clinic, db: Session, attempt: Attempt, outcome: str) -> None:
    db.add(
        LoginAttempt(
            id=attempt.id,
            at=clinic.now(),
            account_key=attempt.account_key,
            address_key=attempt.address_key,
            outcome=outcome,
        )
    )


def _key(clinic: Clinic, kind: str, value: str) -> str:
    return hmac.new(clinic.secret("attempts"), f"{kind} {value}".encode(), hashlib.sha256).hexdigest()
