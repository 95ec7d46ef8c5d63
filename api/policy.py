"""Who may use a route: each one says it in one object, read before anything else of the request.

There is no default. A route without a policy stops the start (``api.guard.audit``), and is refused if it is
ever reached.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, TypeVar

from gaitlab.clinic.access import Permission

Endpoint = TypeVar("Endpoint", bound=Callable[..., Any])

_ATTRIBUTE = "__gaitlab_policy__"


class Credential(StrEnum):
    """How a caller says who they are."""

    COOKIE = "cookie"
    BEARER = "bearer"


@dataclass(frozen=True)
class Policy:
    """Who may use a route, and how much they may send.

    Attributes
    ----------
    credentials : frozenset of Credential
        What is accepted; empty: open to everyone.
    permission : Permission or None
        What the caller must hold; None: being known is enough.
    reason : str
        Why the route is open to everyone; empty for the others.
    upload : bool
        The body may be as large as an upload; otherwise it is held to the small limit.
    """

    credentials: frozenset[Credential]
    permission: Permission | None = None
    reason: str = ""
    upload: bool = False

    @property
    def is_open(self) -> bool:
        return not self.credentials


def open_to_all(reason: str) -> Callable[[Endpoint], Endpoint]:
    """The route needs no account, for the stated reason."""
    if not reason:
        raise ValueError("An open route must say why it is open.")
    return _carry(Policy(frozenset(), reason=reason))


def person(permission: Permission | None = None, *, upload: bool = False) -> Callable[[Endpoint], Endpoint]:
    """The route is a page: for somebody logged in, who holds ``permission`` if one is named."""
    return _carry(Policy(frozenset({Credential.COOKIE}), permission, upload=upload))


def token(permission: Permission, *, upload: bool = False) -> Callable[[Endpoint], Endpoint]:
    """The route is REST: for a bearer token that holds ``permission``."""
    return _carry(Policy(frozenset({Credential.BEARER}), permission, upload=upload))


def person_or_token() -> Callable[[Endpoint], Endpoint]:
    """The route is for everybody with an account or a token; it must show nothing of any patient."""
    return _carry(Policy(frozenset(Credential)))


def policy_of(endpoint: Callable[..., Any]) -> Policy | None:
    """The policy an endpoint carries, or None."""
    found = getattr(endpoint, _ATTRIBUTE, None)
    return found if isinstance(found, Policy) else None


def _carry(policy: Policy) -> Callable[[Endpoint], Endpoint]:
    def decorate(endpoint: Endpoint) -> Endpoint:
        setattr(endpoint, _ATTRIBUTE, policy)
        return endpoint

    return decorate
