"""Log-in and web sessions: the secret is the browser's, the database keeps its hash, the server keeps the time."""

from __future__ import annotations

import datetime as dt
import hashlib
import secrets

from sqlalchemy import Select, select, update
from sqlalchemy.orm import Session

from gaitlab.clinic import attempts
from gaitlab.clinic.access import Principal, Role, granted
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.desk import actor_of, shortened
from gaitlab.clinic.passwords import check_password
from gaitlab.errors import NotLoggedIn
from gaitlab.store import audit
from gaitlab.store.base import new_id
from gaitlab.store.people import Account, WebSession

_SECRET_BYTES = 32
_NOTED_EVERY = dt.timedelta(seconds=20)


def log_in(clinic: Clinic, *, email: str, password: str, address: str) -> tuple[str, Principal]:
    """Check the password and begin a web session: its secret (for the cookie) and the principal.

    Raises
    ------
    NotLoggedIn
        The same words for an unknown e-mail address, a wrong password and a disabled account.
    TooManyAttempts
    """
    attempt = attempts.begin(clinic, account=normal_email(email), address=address)
    with clinic.database.reading() as db:
        account = db.scalar(select(Account).where(Account.email == normal_email(email)))
    right, renewed = check_password(password, account.password_hash if account else None)
    if account is None or not right or account.disabled_at is not None:
        _note_refusal(clinic, account, address)
        raise NotLoggedIn(
            "wrong_credentials", "E-mail address or password is wrong.", "Check both and try again."
        )
    with clinic.database.writing() as db:
        attempts.succeeded(db, attempt)
        if renewed is not None:
            renew = update(Account).where(
                Account.id == account.id, Account.password_hash == account.password_hash
            )
            db.execute(renew.values(password_hash=renewed))
        return _begin_session(clinic, db, account, address)


def _begin_session(clinic: Clinic, db: Session, account: Account, address: str) -> tuple[str, Principal]:
    secret = secrets.token_urlsafe(_SECRET_BYTES)
    now = clinic.now()
    session = WebSession(
        id=new_id(),
        site_id=account.site_id,
        account_id=account.id,
        secret_sha256=_hash(secret),
        created_at=now,
        last_seen_at=now,
    )
    db.add(session)
    principal = _principal(account, session)
    clinic.record(db, actor_of(principal, address=address), [audit.Event("session.log_in", account.id)])
    return secret, principal


def _note_refusal(clinic: Clinic, account: Account | None, address: str) -> None:
    actor = audit.Actor(
        "anonymous", "", site_id=account.site_id if account else "", address=shortened(address)
    )
    details = {"code": "wrong_credentials"}
    event = audit.Event("session.log_in", account.id if account else "", details=details, outcome="refused")
    with clinic.database.writing() as db:
        clinic.record(db, actor, [event])


def principal_of_session(clinic: Clinic, secret: str, *, extend: bool = True) -> Principal | None:
    """Who this web session belongs to; None where it is unknown, ended, idle too long or too old.

    ``extend=False`` for requests that nobody made by hand (polling): they do not count as activity.
    """
    now = clinic.now()
    with clinic.database.reading() as db:
        found = db.execute(_alive(clinic, secret)).first()
    if found is None:
        return None
    session, account = found
    if extend and now - session.last_seen_at >= _NOTED_EVERY:
        with clinic.database.writing() as db:
            seen = update(WebSession).where(WebSession.id == session.id, WebSession.last_seen_at < now)
            db.execute(seen.values(last_seen_at=now))
    return _principal(account, session)


def log_out(clinic: Clinic, secret: str) -> None:
    """End a web session; unknown secrets are ignored."""
    with clinic.database.reading() as db:
        found = db.execute(_alive(clinic, secret)).first()
    if found is None:
        return
    session, account = found
    with clinic.database.writing() as db:
        db.execute(update(WebSession).where(WebSession.id == session.id).values(ended_at=clinic.now()))
        actor = actor_of(_principal(account, session))
        clinic.record(db, actor, [audit.Event("session.log_out", account.id)])


def end_sessions(db: Session, account_id: str, now: dt.datetime) -> None:
    """End all web sessions of an account."""
    alive = update(WebSession).where(WebSession.account_id == account_id, WebSession.ended_at.is_(None))
    db.execute(alive.values(ended_at=now))


def normal_email(email: str) -> str:
    """An e-mail address as it is compared; nobody's where it has characters that none can have."""
    plain = email.strip().casefold()
    return plain if plain.isprintable() else ""


def _alive(clinic: Clinic, secret: str) -> Select[WebSession, Account]:
    now = clinic.now()
    return (
        select(WebSession, Account)
        .join(Account, Account.id == WebSession.account_id)
        .where(
            WebSession.secret_sha256 == _hash(secret),
            WebSession.ended_at.is_(None),
            Account.disabled_at.is_(None),
            WebSession.last_seen_at > now - dt.timedelta(minutes=clinic.settings.idle_minutes),
            WebSession.created_at > now - dt.timedelta(hours=clinic.settings.absolute_hours),
        )
    )


def _hash(secret: str) -> str:
    return hashlib.sha256(secret.encode(errors="replace")).hexdigest()


def _principal(account: Account, session: WebSession) -> Principal:
    roles = frozenset(Role(role) for role in account.roles)
    return Principal(
        user_id=account.id,
        site_id=account.site_id,
        name=account.name,
        roles=roles,
        permissions=granted(roles),
        kind="person",
        credential_id=session.id,
    )
