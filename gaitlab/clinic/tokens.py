"""API tokens: for programs, within scopes, for a time, on behalf of an account."""

from __future__ import annotations

import datetime as dt
import hashlib
import hmac
import secrets
from collections.abc import Iterable

from sqlalchemy import select, update

from gaitlab.clinic.access import NEVER_FOR_TOKENS, Permission, Principal, Role, granted
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.desk import Desk, not_found
from gaitlab.clinic.logins import normal_email
from gaitlab.clinic.views import TokenView
from gaitlab.errors import InputError, NotAllowed
from gaitlab.store import audit
from gaitlab.store.base import ID_PATTERN, new_id
from gaitlab.store.people import Account, ApiToken
from gaitlab.store.records import Scope

PREFIX = "gait"
_SECRET_BYTES = 32
_NOTED_EVERY = dt.timedelta(minutes=1)
_LONGEST_NAME = 100


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
    scope = desk.writing(Permission.TOKEN_MANAGE, "token.add")
    scopes = _checked(desk, name, permissions, days)
    owner = _owner(desk, scope, owner_email)
    _require_own(scopes, owner)
    secret = secrets.token_urlsafe(_SECRET_BYTES)
    now = desk.now()
    token = ApiToken(
        id=new_id(),
        site_id=scope.site_id,
        account_id=owner.id,
        name=name.strip(),
        secret_sha256=_hash(secret),
        scopes=sorted(scopes),
        created_at=now,
        expires_at=now + dt.timedelta(days=days),
    )
    scope.db.add(token)
    scope.db.flush()
    desk.changed(
        "token.add", object_id=token.id, details={"owner": owner.id, "scopes": token.scopes, "days": days}
    )
    return f"{PREFIX}_{token.id}_{secret}", _view(token, owner)


def list_tokens(desk: Desk) -> list[TokenView]:
    """The caller's tokens, newest first; with USER_MANAGE all of the site."""
    scope = desk.reading(Permission.TOKEN_MANAGE, "token.list")
    found = (
        select(ApiToken, Account)
        .join(Account, Account.id == ApiToken.account_id)
        .where(ApiToken.site_id == scope.site_id)
        .order_by(ApiToken.created_at.desc(), ApiToken.id)
    )
    if not desk.principal.may(Permission.USER_MANAGE):
        found = found.where(ApiToken.account_id == desk.principal.user_id)
    return [_view(token, owner) for token, owner in scope.db.execute(found)]


def revoke_token(desk: Desk, token_id: str) -> None:
    """End a token at once: the caller's own, with USER_MANAGE any of the site."""
    scope = desk.writing(Permission.TOKEN_MANAGE, "token.revoke", token_id)
    if ID_PATTERN.fullmatch(token_id) is None:
        raise not_found()
    token = scope.db.scalar(
        select(ApiToken).where(ApiToken.site_id == scope.site_id, ApiToken.id == token_id)
    )
    own = token is not None and token.account_id == desk.principal.user_id
    if token is None or not (own or desk.principal.may(Permission.USER_MANAGE)):
        raise not_found()
    if token.revoked_at is None:
        token.revoked_at = desk.now()
        desk.changed("token.revoke", object_id=token.id)


def principal_of_token(clinic: Clinic, token: str) -> Principal | None:
    """Who this API token stands for.

    None where it is unknown, revoked or expired, or its owner is disabled.
    """
    prefix, _, rest = token.partition("_")
    token_id, _, secret = rest.partition("_")
    if prefix != PREFIX or ID_PATTERN.fullmatch(token_id) is None:
        return None
    with clinic.database.reading() as db:
        found = db.execute(
            select(ApiToken, Account)
            .join(Account, Account.id == ApiToken.account_id)
            .where(ApiToken.id == token_id)
        ).first()
    if found is None:
        return None
    row, owner = found
    now = clinic.now()
    refusal = _refusal(row, owner, secret, now)
    if refusal:
        _note_refusal(clinic, row, refusal, now)
        return None
    if row.last_used_at is None or now - row.last_used_at >= _NOTED_EVERY:
        with clinic.database.writing() as db:
            db.execute(update(ApiToken).where(ApiToken.id == row.id).values(last_used_at=now))
    return _principal(row, owner)


def _refusal(token: ApiToken, owner: Account, secret: str, now: dt.datetime) -> str:
    if not hmac.compare_digest(token.secret_sha256, _hash(secret)):
        return "wrong_secret"
    if token.revoked_at is not None:
        return "revoked"
    if token.expires_at <= now:
        return "expired"
    return "owner_disabled" if owner.disabled_at is not None else ""


def _note_refusal(clinic: Clinic, token: ApiToken, why: str, now: dt.datetime) -> None:
    """Note the refusal, at most once a minute per token, so that nobody can flood the audit trail."""
    if token.last_refused_at is not None and now - token.last_refused_at < _NOTED_EVERY:
        return
    with clinic.database.writing() as db:
        db.execute(update(ApiToken).where(ApiToken.id == token.id).values(last_refused_at=now))
        actor = audit.Actor("token", token.account_id, site_id=token.site_id, credential_id=token.id)
        event = audit.Event("token.use", token.id, details={"code": why}, outcome="refused")
        clinic.record(db, actor, [event])


def _checked(desk: Desk, name: str, permissions: Iterable[Permission], days: int) -> frozenset[Permission]:
    longest = desk.clinic.settings.max_token_days
    if not name.strip() or len(name) > _LONGEST_NAME or not name.isprintable():
        raise InputError("token_name", "A token needs a name of 1 to 100 characters.", column="name")
    if not 1 <= days <= longest:
        raise InputError("token_days", f"A token is valid for 1 to {longest} days.", column="days")
    scopes = frozenset(permissions)
    if not scopes:
        raise InputError("token_permissions", "A token needs at least one permission.", column="permissions")
    never = scopes & NEVER_FOR_TOKENS
    if never:
        raise InputError("token_permissions", f"A token cannot have {min(never)}.", column="permissions")
    return scopes


def _owner(desk: Desk, scope: Scope, email: str | None) -> Account:
    accounts = select(Account).where(Account.site_id == scope.site_id, Account.disabled_at.is_(None))
    if email is None:
        owner = scope.db.scalar(accounts.where(Account.id == desk.principal.user_id))
    else:
        desk.require(Permission.USER_MANAGE)
        owner = scope.db.scalar(accounts.where(Account.email == normal_email(email)))
    if owner is None:
        raise InputError(
            "token_owner",
            "A token needs an account that it belongs to, and there is none of this e-mail address.",
            "Name an account; add one with: gaitlab user add",
            column="owner_email",
        )
    return owner


def _require_own(scopes: frozenset[Permission], owner: Account) -> None:
    missing = scopes - granted(Role(role) for role in owner.roles)
    if missing:
        raise NotAllowed(
            "not_allowed",
            f"The account itself does not have the permission {min(missing)}.",
            "Choose fewer permissions for the token.",
        )


def _view(token: ApiToken, owner: Account) -> TokenView:
    return TokenView(
        id=token.id,
        name=token.name,
        owner=owner.name,
        permissions=[Permission(scope) for scope in token.scopes],
        created_at=token.created_at,
        expires_at=token.expires_at,
        last_used_at=token.last_used_at,
        revoked=token.revoked_at is not None,
    )


def _principal(token: ApiToken, owner: Account) -> Principal:
    roles = frozenset(Role(role) for role in owner.roles)
    scopes = frozenset(Permission(scope) for scope in token.scopes)
    return Principal(
        user_id=owner.id,
        site_id=token.site_id,
        name=owner.name,
        roles=roles,
        permissions=(scopes & granted(roles)) - NEVER_FOR_TOKENS,
        kind="token",
        credential_id=token.id,
    )


def _hash(secret: str) -> str:
    return hashlib.sha256(secret.encode(errors="replace")).hexdigest()
