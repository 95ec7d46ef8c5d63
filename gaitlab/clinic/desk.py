"""A desk: one caller, one transaction, and the audit events that go with it."""

from __future__ import annotations

import datetime as dt
import ipaddress
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gaitlab.clinic.access import Permission, Principal
from gaitlab.errors import GaitlabError, NotAllowed, NotFound
from gaitlab.store import audit
from gaitlab.store.base import ID_PATTERN
from gaitlab.store.records import Scope

if TYPE_CHECKING:
    from gaitlab.clinic.clinic import Clinic


class Desk:
    """Where one caller's use cases happen, in one transaction that commits when the desk is left.

    Leave the desk before the answer is sent: ``with clinic.desk(principal) as desk:`` inside the route, not
    in a dependency that ends after the response. Only then nothing is answered that was not stored and
    audited. A desk belongs to one thread.

    Attributes
    ----------
    principal : Principal
    clinic : Clinic
    """

    def __init__(self, clinic: Clinic, principal: Principal, *, request_id: str, address: str) -> None:
        self.clinic = clinic
        self.principal = principal
        self._actor = actor_of(principal, request_id=request_id, address=address)
        self._transaction = clinic.database.transaction(principal.site_id)
        self._looks: list[audit.Event] = []
        self._changes: list[audit.Event] = []
        self._attempt = ("desk", "")

    @property
    def sees_names(self) -> bool:
        """May the caller see codes, diagnoses, notes and file names?"""
        return self.principal.may(Permission.PATIENT_NAMES)

    def now(self) -> dt.datetime:
        """The clinic's clock."""
        return self.clinic.now()

    def require(self, permission: Permission) -> None:
        """Raise ``NotAllowed`` unless the principal has the permission."""
        if not self.principal.may(permission):
            raise NotAllowed(
                "not_allowed",
                "This account or token may not do this.",
                f"It needs the permission {permission}; an administrator can give it.",
            )

    def attempt(self, permission: Permission, action: str, target: str = "") -> None:
        """Begin a use case: what it is called in the trail if it is refused, and what it needs."""
        self._attempt = (action, target)
        self.require(permission)

    def reading(self, permission: Permission, action: str, target: str = "") -> Scope:
        """Begin a use case that only looks."""
        self.attempt(permission, action, target)
        return Scope(self._transaction.read(), self.principal.site_id)

    def writing(self, permission: Permission, action: str, target: str = "") -> Scope:
        """Begin a use case that changes something."""
        self.attempt(permission, action, target)
        return Scope(self._transaction.write(), self.principal.site_id)

    def pause(self) -> None:
        """Let go of what was read before lengthy work."""
        self._transaction.pause()

    def looked(
        self,
        action: str,
        *,
        object_id: str = "",
        patient_id: str = "",
        details: Mapping[str, Any] | None = None,
    ) -> None:
        """Note a look at identifiable data; it stays in the trail whatever happens after."""
        self._looks.append(audit.Event(action, object_id, patient_id, details or {}))

    def changed(
        self,
        action: str,
        *,
        object_id: str = "",
        patient_id: str = "",
        details: Mapping[str, Any] | None = None,
    ) -> None:
        """Note a change; it enters the trail with the change itself or not at all."""
        self._changes.append(audit.Event(action, object_id, patient_id, details or {}))

    def finish(self) -> None:
        """Commit the changes, the looks and their events."""
        self._record(self._looks + self._changes)

    def refuse(self, problem: GaitlabError) -> None:
        """Undo the changes; keep the looks, and a refusal where the caller reached for what is not theirs."""
        self._transaction.rollback()
        events = self._looks
        if isinstance(problem, (NotAllowed, NotFound)):
            action, target = self._attempt
            known = target if ID_PATTERN.fullmatch(target) else ""
            details = {"code": problem.code}
            events = [*events, audit.Event(action, known, details=details, outcome="refused")]
        self._record(events)

    def abandon(self) -> None:
        """Undo the changes and keep the looks, after a fault of the program."""
        self._transaction.rollback()
        self._record(self._looks)

    def close(self) -> None:
        """Give back the database connection."""
        self._transaction.close()

    def _record(self, events: list[audit.Event]) -> None:
        if events:
            self.clinic.record(self._transaction.write(), self._actor, events)
        if self._transaction.writing:
            self._transaction.commit()
        self._looks, self._changes = [], []


def not_found() -> NotFound:
    """The same words for what does not exist and for what is another site's."""
    return NotFound("not_found", "There is nothing here under this address.", "Check the link or go back.")


def actor_of(principal: Principal, *, request_id: str = "", address: str = "") -> audit.Actor:
    """The principal as the audit trail knows them."""
    return audit.Actor(
        kind=principal.kind,
        id=principal.user_id,
        roles=",".join(sorted(principal.roles)),
        site_id=principal.site_id,
        credential_id=principal.credential_id,
        address=shortened(address),
        request_id=request_id[:64],
    )


def shortened(address: str) -> str:
    """The network an address belongs to (/24 or /48): enough to see where from, not which device."""
    try:
        ip = ipaddress.ip_address(address)
    except ValueError:
        return ""
    return str(ipaddress.ip_network(f"{ip}/{24 if ip.version == 4 else 48}", strict=False))
