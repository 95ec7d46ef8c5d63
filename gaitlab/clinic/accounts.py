"""Accounts: set-up of the first one, and their management; log-in and tokens are at hand here too."""

from __future__ import annotations

import datetime as dt
import hashlib
import re
import secrets
import unicodedata
from base64 import b32encode
from collections.abc import Iterable

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from gaitlab.clinic import attempts
from gaitlab.clinic.access import Permission, Principal, Role
from gaitlab.clinic.clinic import DEFAULT_SITE, Clinic
from gaitlab.clinic.desk import Desk, not_found, shortened
from gaitlab.clinic.logins import end_sessions, log_in, log_out, normal_email, principal_of_session
from gaitlab.clinic.passwords import hash_password, require_good_password
from gaitlab.clinic.tokens import add_token, list_tokens, principal_of_token, revoke_token
from gaitlab.clinic.views import UserView
from gaitlab.errors import Conflict, InputError, NotAllowed
from gaitlab.store import audit
from gaitlab.store.base import new_id
from gaitlab.store.database import one_at_a_time
from gaitlab.store.people import Account, SetupCode, Site
from gaitlab.store.records import Scope, add_unless_there

__all__ = [
    "add_token",
    "add_user",
    "console",
    "create_first_account",
    "disable_user",
    "list_tokens",
    "list_users",
    "log_in",
    "log_out",
    "needs_setup",
    "principal_of_session",
    "principal_of_token",
    "revoke_token",
    "set_password",
    "setup_code",
]

_CODE_BYTES = 20
_CODE_GROUP = 4
_EMAIL = re.compile(r"[^\s@<>\"'(),:;\\]+@[^\s@<>\"'(),:;\\]+")
_LONGEST_EMAIL, _LONGEST_NAME = 254, 100


def needs_setup(clinic: Clinic) -> bool:
    """Is there no account yet?"""
    with clinic.database.reading() as db:
        return _is_empty(db)


def setup_code(clinic: Clinic) -> str | None:
    """Make a one-time code for the first account; None where there are accounts.

    It is valid 24 h and replaces an earlier one.
    """
    code = b32encode(secrets.token_bytes(_CODE_BYTES)).decode().lower()
    now = clinic.now()
    with clinic.database.writing() as db:
        if not _is_empty(db):
            return None
        db.execute(delete(SetupCode).where(SetupCode.used_at.is_(None)))
        expires_at = now + dt.timedelta(hours=clinic.settings.setup_code_hours)
        db.add(SetupCode(id=new_id(), code_sha256=_hash(code), created_at=now, expires_at=expires_at))
        actor = audit.Actor("console", "console", site_id=_default_site(db).id)
        clinic.record(db, actor, [audit.Event("setup.code")])
    return "-".join(code[i : i + _CODE_GROUP] for i in range(0, len(code), _CODE_GROUP))


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
    email, name = _checked_person(email, name)
    require_good_password(password, context=(email, name))
    attempt = attempts.begin(clinic, account="the first account", address=address)
    with clinic.database.writing() as db:
        one_at_a_time(db, "setup")
        site = _default_site(db)
        actor = audit.Actor("anonymous", "", site_id=site.id, address=shortened(address))
        refusal = _setup_refusal(clinic, db, code)
        if refusal is None:
            account = _new_account(clinic, site.id, email, name, password, (Role.ADMIN, Role.CLINICIAN))
            db.add(account)
            attempts.succeeded(db, attempt)
            event = audit.Event("setup.account", account.id)
        else:
            event = audit.Event("setup.account", details={"code": refusal.code}, outcome="refused")
        clinic.record(db, actor, [event])
    if refusal is not None:
        raise refusal


def _setup_refusal(clinic: Clinic, db: Session, code: str) -> Conflict | NotAllowed | None:
    """Why the code does not open the clinic; None where it does, and then it is used up."""
    if not _is_empty(db):
        return Conflict("setup_done", "The first account has been created already.", "Log in with it.")
    now = clinic.now()
    plain = re.sub(r"[\s-]", "", code).lower()
    kept = db.scalar(select(SetupCode).where(SetupCode.code_sha256 == _hash(plain)))
    if kept is None or kept.used_at is not None or kept.expires_at <= now:
        return NotAllowed(
            "wrong_setup_code",
            "The set-up code is wrong or out of date.",
            "Copy it from the terminal in which gaitlab serve runs; a new start prints a new one.",
        )
    kept.used_at = now
    return None


def add_user(desk: Desk, *, email: str, name: str, password: str, roles: Iterable[Role]) -> UserView:
    """Add an account to the site (USER_MANAGE).

    Raises
    ------
    InputError
        With ``column`` "email", "name", "password" or "roles".
    Conflict
        If there is an account with this e-mail address.
    """
    desk.attempt(Permission.USER_MANAGE, "user.add")
    email, name = _checked_person(email, name)
    chosen = frozenset(roles)
    if not chosen:
        raise InputError("user_roles", "An account needs at least one role.", column="roles")
    require_good_password(password, context=(email, name))
    account = _new_account(desk.clinic, desk.principal.site_id, email, name, password, chosen)
    scope = desk.writing(Permission.USER_MANAGE, "user.add")
    if not add_unless_there(scope, account):  # e-mail addresses are unique over all sites
        raise Conflict("email_taken", "There is an account with this e-mail address.", "Use another one.")
    desk.changed("user.add", object_id=account.id, details={"roles": account.roles})
    return _view(account)


def list_users(desk: Desk) -> list[UserView]:
    """The accounts of the site (USER_MANAGE)."""
    scope = desk.reading(Permission.USER_MANAGE, "user.list")
    found = select(Account).where(Account.site_id == scope.site_id).order_by(Account.email)
    return [_view(account) for account in scope.db.scalars(found)]


def disable_user(desk: Desk, email: str) -> UserView:
    """Refuse an account from now on and end its sessions (USER_MANAGE)."""
    scope = desk.writing(Permission.USER_MANAGE, "user.disable")
    account = _account(scope, email)
    if account.id == desk.principal.user_id:
        raise Conflict("own_account", "Nobody can disable their own account.", "Ask another administrator.")
    if account.disabled_at is None:
        account.disabled_at = desk.now()
        end_sessions(scope.db, account.id, desk.now())
        desk.changed("user.disable", object_id=account.id)
    return _view(account)


def set_password(desk: Desk, *, email: str, password: str) -> UserView:
    """Set a new password and end the account's sessions (USER_MANAGE).

    Raises
    ------
    InputError
        With ``column`` "password".
    """
    desk.attempt(Permission.USER_MANAGE, "user.password")
    require_good_password(password, context=(email,))
    hashed = hash_password(password)
    scope = desk.writing(Permission.USER_MANAGE, "user.password")
    account = _account(scope, email)
    account.password_hash = hashed
    end_sessions(scope.db, account.id, desk.now())
    desk.changed("user.password", object_id=account.id)
    return _view(account)


def console(clinic: Clinic) -> Principal:
    """The operator at the command line: all permissions in the site "default"."""
    with clinic.database.reading() as db:
        site = _default_site(db)
    return Principal(
        user_id="console",
        site_id=site.id,
        name="command line",
        roles=frozenset(Role),
        permissions=frozenset(Permission),
        kind="console",
        credential_id="",
    )


def _is_empty(db: Session) -> bool:
    return db.scalar(select(Account.id).limit(1)) is None


def _default_site(db: Session) -> Site:
    return db.scalars(select(Site).where(Site.name == DEFAULT_SITE)).one()


def _account(scope: Scope, email: str) -> Account:
    account = scope.db.scalar(
        select(Account).where(Account.site_id == scope.site_id, Account.email == normal_email(email))
    )
    if account is None:
        raise not_found()
    return account


def _checked_person(email: str, name: str) -> tuple[str, str]:
    email, name = normal_email(email), unicodedata.normalize("NFC", name).strip()
    if len(email) > _LONGEST_EMAIL or _EMAIL.fullmatch(email) is None:
        raise InputError("email", "This is not an e-mail address.", column="email")
    if not name or len(name) > _LONGEST_NAME or not name.isprintable():
        raise InputError("name", "A name of 1 to 100 characters is needed.", column="name")
    return email, name


def _new_account(
    clinic: Clinic, site_id: str, email: str, name: str, password: str, roles: Iterable[Role]
) -> Account:
    return Account(
        id=new_id(),
        site_id=site_id,
        email=email,
        name=name,
        password_hash=hash_password(password),
        roles=sorted(roles),
        created_at=clinic.now(),
    )


def _view(account: Account) -> UserView:
    return UserView(
        id=account.id,
        email=account.email,
        name=account.name,
        roles=[Role(role) for role in account.roles],
        created_at=account.created_at,
        active=account.disabled_at is None,
    )


def _hash(code: str) -> str:
    return hashlib.sha256(code.encode(errors="replace")).hexdigest()
