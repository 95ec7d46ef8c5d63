"""Reading and adding records. Every function takes the ``Scope`` first: no row is reached but through its site.

A row of another site, of a deleted patient, or that does not exist is None, always the same.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Select, func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session as Database
from sqlalchemy.orm import contains_eager, selectinload

from gaitlab.store.base import ID_PATTERN, Base
from gaitlab.store.people import Account, Site
from gaitlab.store.tables import (
    Analysis,
    AuditEvent,
    Idempotency,
    Patient,
    Session,
    Trial,
    TrialFile,
)


@dataclass(frozen=True)
class Scope:
    """A database session and the only site it may show."""

    db: Database
    site_id: str


LONGEST_CODE_KEY = 256


def code_key(code: str) -> str:
    """A patient's code as it is compared: "ms-07" is "MS-07"."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", code).casefold())


def _patients(scope: Scope) -> Select[Patient]:
    return select(Patient).where(Patient.site_id == scope.site_id, Patient.deleted_at.is_(None))


def _sessions(scope: Scope) -> Select[Session]:
    return (
        select(Session)
        .join(Session.patient)
        .options(contains_eager(Session.patient))
        .where(Session.site_id == scope.site_id, Patient.deleted_at.is_(None))
    )


def _trials(scope: Scope) -> Select[Trial]:
    return (
        select(Trial)
        .join(Trial.session)
        .join(Session.patient)
        .options(contains_eager(Trial.session).contains_eager(Session.patient))
        .where(Trial.site_id == scope.site_id, Patient.deleted_at.is_(None))
    )


def patient(scope: Scope, patient_id: str, *, lock: bool = False) -> Patient | None:
    """One patient; ``lock`` keeps other writers waiting until the transaction ends."""
    if ID_PATTERN.fullmatch(patient_id) is None:
        return None
    query = _patients(scope).where(Patient.id == patient_id)
    return scope.db.scalar(query.with_for_update() if lock else query)


def patient_with_code(scope: Scope, code: str) -> Patient | None:
    """The patient of this code."""
    return scope.db.scalar(_patients(scope).where(Patient.code_key == code_key(code)))


def patients(
    scope: Scope, *, query: str, by_pseudonym: bool, limit: int, offset: int
) -> tuple[list[Patient], int]:
    """A page of patients whose code (or pseudonym) contains ``query``, and how many there are in all."""
    shown = Patient.pseudonym if by_pseudonym else Patient.code_key
    found = _patients(scope)
    if query:
        found = found.where(
            shown.contains(query.upper() if by_pseudonym else code_key(query), autoescape=True)
        )
    total = scope.db.scalar(select(func.count()).select_from(found.subquery())) or 0
    page = found.order_by(shown, Patient.id).limit(limit).offset(offset)
    return list(scope.db.scalars(page)), total


def session_counts(scope: Scope, patient_ids: Sequence[str]) -> dict[str, int]:
    """How many sessions each of these patients has."""
    rows = scope.db.execute(
        select(Session.patient_id, func.count())
        .where(Session.site_id == scope.site_id, Session.patient_id.in_(patient_ids))
        .group_by(Session.patient_id)
    )
    return dict(rows.all())


def session(scope: Scope, session_id: str, *, lock: bool = False) -> Session | None:
    """One session with its patient."""
    if ID_PATTERN.fullmatch(session_id) is None:
        return None
    query = _sessions(scope).where(Session.id == session_id)
    return scope.db.scalar(query.with_for_update(of=Session) if lock else query)


def sessions_of(scope: Scope, patient_id: str) -> list[Session]:
    """A patient's sessions, newest first."""
    newest_first = (Session.date.desc(), Session.created_at.desc(), Session.id)
    return list(
        scope.db.scalars(_sessions(scope).where(Session.patient_id == patient_id).order_by(*newest_first))
    )


def trial_counts(scope: Scope, session_ids: Sequence[str]) -> dict[str, int]:
    """How many trials each of these sessions has."""
    rows = scope.db.execute(
        select(Trial.session_id, func.count())
        .where(Trial.site_id == scope.site_id, Trial.session_id.in_(session_ids))
        .group_by(Trial.session_id)
    )
    return dict(rows.all())


def _whole(query: Select[Trial]) -> Select[Trial]:
    return query.options(selectinload(Trial.files).joinedload(TrialFile.raw), selectinload(Trial.analyses))


def trial(scope: Scope, trial_id: str, *, lock: bool = False) -> Trial | None:
    """One trial with session, patient, files and analyses."""
    if ID_PATTERN.fullmatch(trial_id) is None:
        return None
    query = _whole(_trials(scope).where(Trial.id == trial_id)).execution_options(populate_existing=True)
    return scope.db.scalar(query.with_for_update(of=Trial) if lock else query)


def trials_of(scope: Scope, session_id: str) -> list[Trial]:
    """A session's trials in their order, with files and analyses."""
    query = _whole(_trials(scope).where(Trial.session_id == session_id)).order_by(Trial.number)
    return list(scope.db.scalars(query.execution_options(populate_existing=True)))


def placements_of_devices(scope: Scope, devices: Sequence[str]) -> dict[str, str]:
    """Where each of these devices was worn when the site last used it."""
    rows = scope.db.execute(
        select(TrialFile.device, TrialFile.placement)
        .where(TrialFile.site_id == scope.site_id, TrialFile.device.in_(devices))
        .order_by(TrialFile.created_at, TrialFile.trial_id)
    )
    return {device: placement for device, placement in rows if device is not None}


def add_unless_there(scope: Scope, row: Base) -> bool:
    """Add a row, or leave the one of the same key that another writer was faster to add; was it added?"""
    try:
        with scope.db.begin_nested():
            scope.db.add(row)
    except IntegrityError:
        return False
    return True


def earlier_answer(scope: Scope, owner_id: str, key: str) -> Idempotency | None:
    """What this caller's request with this Idempotency-Key made."""
    return scope.db.get(Idempotency, (scope.site_id, owner_id, key), populate_existing=True)


def events(scope: Scope, *, patient_id: str | None, limit: int, offset: int) -> tuple[list[AuditEvent], int]:
    """A page of the site's audit events, newest first, and how many there are in all."""
    found = select(AuditEvent).where(AuditEvent.site_id == scope.site_id)
    if patient_id is not None:
        if ID_PATTERN.fullmatch(patient_id) is None:
            return [], 0
        found = found.where(AuditEvent.patient_id == patient_id)
    total = scope.db.scalar(select(func.count()).select_from(found.subquery())) or 0
    return list(scope.db.scalars(found.order_by(AuditEvent.seq.desc()).limit(limit).offset(offset))), total


def site_name(scope: Scope) -> str:
    """What the site is called."""
    return scope.db.scalars(select(Site.name).where(Site.id == scope.site_id)).one()


def account_names(scope: Scope, account_ids: Sequence[str]) -> dict[str, str]:
    """Names of these accounts of the site."""
    rows = scope.db.execute(
        select(Account.id, Account.name).where(
            Account.site_id == scope.site_id, Account.id.in_(set(account_ids))
        )
    )
    return dict(rows.all())


def current(trial: Trial) -> Analysis:
    """The newest of a trial's analyses."""
    return max(trial.analyses, key=lambda analysis: analysis.number)
