"""The audit trail, for those who may read it."""

from __future__ import annotations

import json

from gaitlab.clinic.access import Permission, Principal
from gaitlab.clinic.clinic import Clinic, Desk
from gaitlab.clinic.desk import actor_of
from gaitlab.clinic.patients import require_page
from gaitlab.clinic.showing import CONSOLE_NAME
from gaitlab.clinic.views import EventView, Page
from gaitlab.store import audit, records
from gaitlab.store.audit import ChainReport
from gaitlab.store.tables import AuditEvent

__all__ = ["ChainReport", "list_events", "record_refusal", "verify_chain"]


def list_events(
    desk: Desk, *, limit: int = 100, offset: int = 0, patient_id: str | None = None
) -> Page[EventView]:
    """Events of the site, newest first (AUDIT_READ)."""
    scope = desk.reading(Permission.AUDIT_READ, "audit.list")
    require_page(limit, offset)
    rows, total = records.events(scope, patient_id=patient_id, limit=limit, offset=offset)
    names = {"console": CONSOLE_NAME, **records.account_names(scope, [row.actor_id for row in rows])}
    desk.looked("audit.list", details={"limit": limit, "offset": offset})
    items = [_view(row, names.get(row.actor_id, "")) for row in rows]
    return Page[EventView](items=items, total=total, limit=limit, offset=offset)


def record_refusal(
    clinic: Clinic,
    principal: Principal,
    permission: Permission | None,
    *,
    code: str = "not_allowed",
    request_id: str = "",
    address: str = "",
) -> None:
    """Note that a caller was turned away before reaching a desk: for want of a permission, or for ``code``."""
    actor = actor_of(principal, request_id=request_id, address=address)
    details = {"code": code, **({"permission": permission.value} if permission is not None else {})}
    with clinic.database.writing() as db:
        clinic.record(db, actor, [audit.Event("desk.enter", details=details, outcome="refused")])


def verify_chain(clinic: Clinic) -> ChainReport:
    """Recompute the chain of hashes over all events of all sites."""
    with clinic.database.reading() as db:
        return audit.verify(db, clinic.secret("audit"))


def _view(row: AuditEvent, actor: str) -> EventView:
    return EventView(
        seq=row.seq,
        at=row.at,
        actor_kind=row.actor_kind,
        actor=actor,
        credential_id=row.credential_id,
        patient_id=row.patient_id,
        action=row.action,
        object_id=row.object_id,
        details=json.loads(row.details),
        address=row.address,
        request_id=row.request_id,
        outcome=row.outcome,
    )
