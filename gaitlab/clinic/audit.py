"""The audit trail, for those who may read it."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.clinic.clinic import Clinic, Desk
from gaitlab.clinic.views import EventView, Page


@dataclass(frozen=True)
class ChainReport:
    """Whether the audit trail is as it was written; ``first_bad`` is the sequence number of the first break."""

    ok: bool
    n_events: int
    head: str
    first_bad: int | None
    problem: str


def list_events(
    desk: Desk, *, limit: int = 100, offset: int = 0, patient_id: str | None = None
) -> Page[EventView]:
    """Events of the site, newest first (AUDIT_READ)."""
    raise NotImplementedError


def verify_chain(clinic: Clinic) -> ChainReport:
    """Recompute the chain of hashes over all events."""
    raise NotImplementedError
