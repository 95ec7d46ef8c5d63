"""The audit trail: a chain of hashes over who did what, written in the transaction of the change itself.

Each event's hash is SHA-256 over the previous hash and the event as canonical JSON; the last one is
sealed with the installation's key. So an event that was edited, removed, inserted or moved breaks the
chain, and cutting the end off breaks the seal. Events hold ids, names of fields and hashes, never a
patient's data.
"""

from __future__ import annotations

import datetime as dt
import hashlib
import hmac
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from gaitlab.store.database import one_at_a_time
from gaitlab.store.tables import AuditEvent, AuditHead

START = "0" * 64
HEAD_MISMATCH = "audit.head_mismatch"
_HASHED = tuple(c.key for c in AuditEvent.__table__.columns if c.key not in ("hash", "prev_hash"))


@dataclass(frozen=True)
class Actor:
    """Who did it and from where; ``address`` is already shortened."""

    kind: str
    id: str
    roles: str = ""
    site_id: str = ""
    credential_id: str = ""
    address: str = ""
    request_id: str = ""


@dataclass(frozen=True)
class Event:
    """What was done. ``outcome`` is "done", "refused" or "failed"."""

    action: str
    object_id: str = ""
    patient_id: str = ""
    details: Mapping[str, Any] = field(default_factory=dict)
    outcome: str = "done"


@dataclass(frozen=True)
class ChainReport:
    """Whether the trail is as it was written.

    ``first_bad`` is the sequence number of the first break; ``head`` the last hash, to be noted
    elsewhere now and then: with it even someone who has the key cannot cut the trail unnoticed.
    """

    ok: bool
    n_events: int
    head: str
    first_bad: int | None = None
    problem: str = ""


def link(prev_hash: str, event: AuditEvent) -> str:
    """Hash of an event that follows ``prev_hash``."""
    content = {name: getattr(event, name) for name in _HASHED}
    content["at"] = event.at.astimezone(dt.UTC).isoformat(timespec="microseconds")
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256((prev_hash + text).encode()).hexdigest()


def _seal(key: bytes, seq: int, last_hash: str) -> str:
    return hmac.new(key, f"gaitlab audit head {seq} {last_hash}".encode(), hashlib.sha256).hexdigest()


def append(session: Session, key: bytes, now: dt.datetime, actor: Actor, events: list[Event]) -> None:
    """Add events at the end of the chain, within the session's write transaction.

    Where the seal does not fit the head, that itself becomes an event, so that going on does not cover it up.
    """
    one_at_a_time(session, "audit")
    head = session.get(AuditHead, 1, populate_existing=True)
    intact = head is not None and hmac.compare_digest(head.seal, _seal(key, head.seq, head.hash))
    if head is None:
        last = session.scalar(select(AuditEvent).order_by(AuditEvent.seq.desc()).limit(1))
        intact = last is None
        head = AuditHead(id=1, seq=last.seq if last else 0, hash=last.hash if last else START)
        session.add(head)
    if not intact:
        events = [Event(HEAD_MISMATCH, outcome="failed"), *events]
    for event in events:
        row = _row(head.seq + 1, now, actor, event)
        row.prev_hash = head.hash
        row.hash = link(head.hash, row)
        session.add(row)
        head.seq, head.hash = row.seq, row.hash
    head.seal = _seal(key, head.seq, head.hash)
    session.flush()


def _row(seq: int, now: dt.datetime, actor: Actor, event: Event) -> AuditEvent:
    return AuditEvent(
        seq=seq,
        at=now,
        site_id=actor.site_id,
        actor_kind=actor.kind,
        actor_id=actor.id,
        actor_roles=actor.roles,
        credential_id=actor.credential_id,
        action=event.action,
        patient_id=event.patient_id,
        object_id=event.object_id,
        details=json.dumps(dict(event.details), sort_keys=True, separators=(",", ":")),
        address=actor.address,
        request_id=actor.request_id,
        outcome=event.outcome,
    )


def verify(session: Session, key: bytes) -> ChainReport:
    """Recompute the chain over all events, oldest first."""
    one_at_a_time(session, "audit")
    seq, last = 0, START
    resealed: int | None = None
    in_order = select(AuditEvent).order_by(AuditEvent.seq).execution_options(yield_per=1000)
    for event in session.scalars(in_order):
        problem = _break(event, seq, last)
        if problem:
            return ChainReport(False, seq, last, seq + 1, problem)
        if event.action == HEAD_MISMATCH and resealed is None:
            resealed = event.seq
        seq, last = event.seq, event.hash
        session.expunge(event)
    if resealed is not None:
        return ChainReport(False, seq, last, resealed, f"The seal did not fit before event {resealed}.")
    problem = _broken_seal(session.get(AuditHead, 1, populate_existing=True), key, seq, last)
    return ChainReport(not problem, seq, last, seq + 1 if problem else None, problem)


def _broken_seal(head: AuditHead | None, key: bytes, seq: int, last: str) -> str:
    if head is None:
        return "The trail's seal is missing."
    if (head.seq, head.hash) != (seq, last):
        return f"The trail ends after event {seq}, but its seal is on event {head.seq}."
    if not hmac.compare_digest(head.seal, _seal(key, seq, last)):
        return "The trail's seal was not made with this installation's key."
    return ""


def _break(event: AuditEvent, seq: int, last: str) -> str:
    if event.seq != seq + 1:
        return f"Event {seq + 1} is missing."
    if event.prev_hash != last:
        return f"Event {event.seq} does not follow the event before it."
    if event.hash != link(last, event):
        return f"Event {event.seq} was changed."
    return ""
