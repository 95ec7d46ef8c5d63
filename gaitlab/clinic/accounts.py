"""Accounts: set-up of the first one, log-in, web sessions and API tokens."""

from __future__ import annotations

from collections.abc import Iterable

from gaitlab.clinic.access import Permission, Principal, Role
from gaitlab.clinic.clinic import Clinic, Desk
from gaitlab.clinic.views import TokenView, UserView


def setup_code(clinic: Clinic) -> str | None:
    """Make a one-time code for the first account (valid 24 h, replaces an earlier one); None where there are accounts."""
    raise NotImplementedError


def needs_setup(clinic: Clinic) -> bool:
    """Is there no account yet?"""
    raise NotImplementedError


def create_first_account(
    clinic: Clinic, *, code: str, email: str, name: str, password: str, address: str = ""
) -> None:
    """Create the first account (admin and clinician of the site "default") with the set-up code.

    Raises
    ------
    InputError
        With ``column`` "email", "name" or "password".
    NotAllowed
        If the code is wrong or out of date.
    Conflict
        If there is an account already.
    TooManyAttempts
    """
    raise NotImplementedError


def log_in(clinic: Clinic, *, email: str, password: str, address: str) -> tuple[str, Principal]:
    """Check the password and begin a web session: its secret (for the cookie) and the principal.

    Raises
    ------
    NotLoggedIn
        The same words for an unknown e-mail address, a wrong password and a disabled account.
    TooManyAttempts
    """
    raise NotImplementedError


def principal_of_session(clinic: Clinic, secret: str, *, extend: bool = True) -> Principal | None:
    """Who this web session belongs to; None where it is unknown, ended, idle too long or too old.

    ``extend=False`` for requests that nobody made by hand (polling): they do not count as activity.
    """
    raise NotImplementedError


def log_out(clinic: Clinic, secret: str) -> None:
    """End a web session; unknown secrets are ignored."""
    raise NotImplementedError


def principal_of_token(clinic: Clinic, token: str) -> Principal | None:
    """Who this API token stands for; None where it is unknown, revoked or expired, or its owner is disabled."""
    raise NotImplementedError


def add_token(
    desk: Desk, *, name: str, permissions: Iterable[Permission], days: int, owner_email: str | None = None
) -> tuple[str, TokenView]:
    """Make an API token ``gait_<id>_<secret>``: the text, shown this once, and its view.

    ``owner_email`` (needs USER_MANAGE; for the command line) makes it for another account of the site.

    Raises
    ------
    InputError
        No name, no permission, or ``days`` not from 1 to 365 (``column`` says which).
    NotAllowed
        If a permission is not the owner's own.
    """
    raise NotImplementedError


def list_tokens(desk: Desk) -> list[TokenView]:
    """The caller's tokens, newest first; with USER_MANAGE all of the site."""
    raise NotImplementedError


def revoke_token(desk: Desk, token_id: str) -> None:
    """End a token at once: the caller's own, with USER_MANAGE any of the site."""
    raise NotImplementedError


def add_user(desk: Desk, *, email: str, name: str, password: str, roles: Iterable[Role]) -> UserView:
    """Add an account to the site (USER_MANAGE).

    Raises
    ------
    InputError
        With ``column`` "email", "name", "password" or "roles".
    Conflict
        If there is an account with this e-mail address.
    """
    raise NotImplementedError


def list_users(desk: Desk) -> list[UserView]:
    """The accounts of the site (USER_MANAGE)."""
    raise NotImplementedError


def disable_user(desk: Desk, email: str) -> UserView:
    """Refuse an account from now on and end its sessions (USER_MANAGE)."""
    raise NotImplementedError


def set_password(desk: Desk, *, email: str, password: str) -> UserView:
    """Set a new password and end the account's sessions: one's own, or with USER_MANAGE any of the site."""
    raise NotImplementedError


def console(clinic: Clinic) -> Principal:
    """The operator at the command line: all permissions in the site "default"."""
    raise NotImplementedError
