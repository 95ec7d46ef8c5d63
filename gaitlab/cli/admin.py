"""``gaitlab serve``, ``user``, ``token``, ``db`` and ``audit``: what the operator of the machine does."""

from __future__ import annotations

import argparse
import getpass
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from gaitlab.clinic import accounts, audit, tokens, upkeep
from gaitlab.clinic.access import Permission, Role
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.desk import Desk
from gaitlab.clinic.settings import ClinicSettings
from gaitlab.errors import InputError

REST_SCOPES = (
    Permission.PATIENT_READ,
    Permission.PATIENT_WRITE,
    Permission.PATIENT_NAMES,
    Permission.SESSION_READ,
    Permission.SESSION_WRITE,
    Permission.REPORT_READ,
)
"""What a token may do where nothing else is said: everything REST offers."""


@contextmanager
def _clinic() -> Iterator[Clinic]:
    clinic = Clinic.open(ClinicSettings.from_environment())
    try:
        yield clinic
    finally:
        clinic.close()


@contextmanager
def _desk() -> Iterator[Desk]:
    with _clinic() as clinic, clinic.desk(accounts.console(clinic)) as desk:
        yield desk


def serve(chosen: argparse.Namespace) -> int:
    """Serve until stopped."""
    from api.serving import serve as serve_pages

    serve_pages(ClinicSettings.from_environment(), chosen.host, chosen.port, chosen.behind_proxy)
    return 0


def _password() -> str:
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\r\n")
    password = getpass.getpass("Password (12 characters or more): ")
    if getpass.getpass("Once more: ") != password:
        raise InputError("password_differs", "The two passwords differ.", "Try again.", column="password")
    return password


def user_add(chosen: argparse.Namespace) -> int:
    """Add an account."""
    password = _password()
    with _desk() as desk:
        roles = [Role(role) for role in chosen.role]
        user = accounts.add_user(desk, email=chosen.email, name=chosen.name, password=password, roles=roles)
    print(f"added {user.email}")
    return 0


def user_list(_chosen: argparse.Namespace) -> int:
    """List the accounts."""
    with _desk() as desk:
        for user in accounts.list_users(desk):
            state = "active" if user.active else "disabled"
            print(f"{user.email}\t{user.name}\t{','.join(sorted(user.roles))}\t{state}")
    return 0


def user_disable(chosen: argparse.Namespace) -> int:
    """End an account."""
    with _desk() as desk:
        user = accounts.disable_user(desk, chosen.email)
    print(f"disabled {user.email}")
    return 0


def user_password(chosen: argparse.Namespace) -> int:
    """Set a new password."""
    password = _password()
    with _desk() as desk:
        user = accounts.set_password(desk, email=chosen.email, password=password)
    print(f"new password for {user.email}; all sessions of the account have ended")
    return 0


def token_add(chosen: argparse.Namespace) -> int:
    """Make a token and print it, this once, on standard output."""
    scopes = [_permission(text) for text in chosen.scope] if chosen.scope else list(REST_SCOPES)
    with _desk() as desk:
        text, view = tokens.add_token(
            desk, name=chosen.name, permissions=scopes, days=chosen.days, owner_email=chosen.email
        )
    print(text)
    print(f"expires {view.expires_at:%Y-%m-%d}; it is not shown again", file=sys.stderr)
    return 0


def _permission(text: str) -> Permission:
    try:
        return Permission(text)
    except ValueError:
        choice = ", ".join(REST_SCOPES)
        raise InputError(
            "scope", f"There is no permission {text!r}.", f"Choose of {choice}.", column="scope"
        ) from None


def token_list(_chosen: argparse.Namespace) -> int:
    """List the tokens, without their secrets."""
    with _desk() as desk:
        for token in tokens.list_tokens(desk):
            state = "revoked" if token.revoked else f"until {token.expires_at:%Y-%m-%d}"
            print(f"{token.id}\t{token.name}\t{token.owner}\t{','.join(sorted(token.permissions))}\t{state}")
    return 0


def token_revoke(chosen: argparse.Namespace) -> int:
    """End a token."""
    with _desk() as desk:
        tokens.revoke_token(desk, chosen.id)
    print(f"revoked {chosen.id}")
    return 0


def db_upgrade(_chosen: argparse.Namespace) -> int:
    """Bring the tables to this version: opening does it."""
    with _clinic() as clinic:
        print(f"up to date: {clinic.database.engine.url.render_as_string(hide_password=True)}")
    return 0


def db_status(_chosen: argparse.Namespace) -> int:
    """Say whether the records can be used."""
    with _clinic() as clinic:
        ready = clinic.ready()
    print(
        "ready" if ready else "not ready: the database does not answer or the data folder cannot be written"
    )
    return 0 if ready else 1


def db_sweep(_chosen: argparse.Namespace) -> int:
    """Remove what crashes left behind."""
    with _clinic() as clinic:
        swept = upkeep.sweep(clinic)
    print(f"removed {swept.contents} contents without a row and {swept.temporary} interrupted writes")
    return 0


def audit_verify(_chosen: argparse.Namespace) -> int:
    """Recompute the chain of hashes; 1 if it is broken."""
    with _clinic() as clinic:
        report = audit.verify_chain(clinic)
    if report.ok:
        print(f"{report.n_events} events, unbroken; head {report.head}")
        return 0
    print(f"broken at event {report.first_bad}: {report.problem}")
    return 1
