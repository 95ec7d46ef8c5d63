"""The clinic: opened once per process; every use case happens at one of its desks."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from gaitlab.clinic.access import Permission, Principal
from gaitlab.clinic.settings import ClinicSettings

__all__ = ["Clinic", "ClinicSettings", "Desk"]


class Desk:
    """Where one caller's use cases happen, in one transaction that commits when the desk is left.

    Leave the desk before the answer is sent: with ``with clinic.desk(principal) as desk:`` inside the route, not in
    a dependency that ends after the response. Only then is nothing answered that was not stored and audited.
    """

    principal: Principal

    def require(self, permission: Permission) -> None:
        """Raise ``NotAllowed`` unless the principal has the permission."""
        raise NotImplementedError


class Clinic:
    """Database, files and secret key of one installation. Safe to use from many threads."""

    settings: ClinicSettings

    @classmethod
    def open(cls, settings: ClinicSettings) -> Clinic:
        """Make the data folder (0700) and key (0600) where missing, and bring the database to head.

        Raises
        ------
        Misconfigured
            If folder, key or database cannot be used, or the database is newer than this program.
        """
        raise NotImplementedError

    @contextmanager
    def desk(self, principal: Principal, *, request_id: str = "", address: str = "") -> Iterator[Desk]:
        """Open a desk for a caller. On an error nothing is stored but the refusal itself, in the audit trail."""
        raise NotImplementedError
        yield

    def close(self) -> None:
        """Let go of the database."""
        raise NotImplementedError

    def ready(self) -> bool:
        """Does the database answer, is it at head, and can the data folder be written?"""
        raise NotImplementedError

    def form_key(self) -> bytes:
        """Secret for the HMAC of form tokens (CSRF), 32 bytes, the same in every process of this installation."""
        raise NotImplementedError
