"""Who may do what: the one policy table, and the principal every use case is called by."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Literal


class Permission(StrEnum):
    """One thing that can be allowed. The values are also the scopes of an API token."""

    PATIENT_READ = "patient:read"
    PATIENT_WRITE = "patient:write"
    PATIENT_NAMES = "patient:names"
    SESSION_READ = "session:read"
    SESSION_WRITE = "session:write"
    REPORT_READ = "report:read"
    TOKEN_MANAGE = "token:manage"  # noqa: S105
    USER_MANAGE = "user:manage"
    AUDIT_READ = "audit:read"


class Role(StrEnum):
    """What an account is for; an account can have several."""

    ADMIN = "admin"
    CLINICIAN = "clinician"
    ENGINEER = "engineer"
    READER = "reader"


_READ = frozenset({Permission.PATIENT_READ, Permission.SESSION_READ, Permission.REPORT_READ})

GRANTS: Mapping[Role, frozenset[Permission]] = MappingProxyType(
    {
        Role.READER: _READ | {Permission.PATIENT_NAMES},
        # An engineer uploads and re-analyses, and sees pseudonyms only.
        Role.ENGINEER: _READ | {Permission.SESSION_WRITE, Permission.TOKEN_MANAGE},
        Role.CLINICIAN: _READ
        | {
            Permission.PATIENT_NAMES,
            Permission.PATIENT_WRITE,
            Permission.SESSION_WRITE,
            Permission.TOKEN_MANAGE,
        },
        # An admin has no clinical content by default.
        Role.ADMIN: frozenset({Permission.USER_MANAGE, Permission.TOKEN_MANAGE, Permission.AUDIT_READ}),
    }
)

NEVER_FOR_TOKENS = frozenset({Permission.TOKEN_MANAGE, Permission.USER_MANAGE})
"""A token can make neither tokens nor users, whatever its scopes say."""

PrincipalKind = Literal["person", "token", "console"]


@dataclass(frozen=True)
class Principal:
    """The caller of a use case.

    Attributes
    ----------
    user_id : str
        The account; ``console`` for the operator at the command line.
    permissions : frozenset of Permission
        Of a person the grants of the roles; of a token its scopes as far as its owner has the right now, never
        ``NEVER_FOR_TOKENS``.
    credential_id : str
        Web session or token the caller came with, for the audit trail; not a secret.
    """

    user_id: str
    site_id: str
    name: str
    roles: frozenset[Role]
    permissions: frozenset[Permission]
    kind: PrincipalKind
    credential_id: str

    def may(self, permission: Permission) -> bool:
        """Does the caller have this permission?"""
        return permission in self.permissions


def granted(roles: Iterable[Role]) -> frozenset[Permission]:
    """All that these roles together allow."""
    return frozenset[Permission]().union(*(GRANTS[role] for role in roles))
