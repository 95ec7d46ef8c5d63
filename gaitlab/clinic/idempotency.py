"""A request that is sent twice is done once: Idempotency-Key, kept with what it made."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from gaitlab.analysis import Settings
from gaitlab.clinic.desk import Desk
from gaitlab.errors import InputError
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Placement
from gaitlab.store import records
from gaitlab.store.records import Scope
from gaitlab.store.tables import Idempotency

_KEY = re.compile(r"[\x21-\x7e]{1,64}")


@dataclass(frozen=True)
class Request:
    """A request as it is recognised when it comes again; without ``key`` it never is."""

    key: str | None
    sha256: str


def request(
    key: str | None,
    action: str,
    parent_id: str,
    form: Mapping[str, object],
    files: Mapping[Placement, InputFile],
    settings: Settings | None,
) -> Request:
    """The request's key and the hash of all it says.

    Raises
    ------
    InputError
        ``idempotency_key`` where the key is not 1 to 64 visible ASCII characters.
    """
    if key is not None and _KEY.fullmatch(key) is None:
        raise InputError(
            "idempotency_key",
            "An Idempotency-Key has 1 to 64 visible characters of ASCII.",
            "Use a new random key for each upload, such as a UUID.",
            column="Idempotency-Key",
        )
    content = {
        "action": action,
        "parent": parent_id,
        "form": dict(form),
        "files": {placement: [file.name, file.sha256] for placement, file in files.items()},
        "settings": None if settings is None else asdict(settings),
    }
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), default=str)
    return Request(key, hashlib.sha256(text.encode()).hexdigest())


def earlier(desk: Desk, scope: Scope, asked: Request) -> str | None:
    """Id of what the same request made before; None where it is new.

    Raises
    ------
    InputError
        ``idempotency_key_reused`` where the key came with another content.
    """
    if asked.key is None:
        return None
    row = records.earlier_answer(scope, desk.principal.user_id, asked.key)
    return None if row is None or _outdated(desk, row) else _answer(row, asked)


def _outdated(desk: Desk, row: Idempotency) -> bool:
    return row.created_at <= desk.now() - dt.timedelta(days=desk.clinic.settings.idempotency_days)


def _answer(row: Idempotency, asked: Request) -> str:
    if row.request_sha256 != asked.sha256:
        raise InputError(
            "idempotency_key_reused",
            "This Idempotency-Key came with another content before.",
            "Use a new key for a new upload.",
            column="Idempotency-Key",
        )
    return row.object_id


def claim(desk: Desk, scope: Scope, asked: Request, object_id: str) -> str:
    """Note what the request makes: ``object_id``, or the id that the same request made a moment earlier."""
    if asked.key is None:
        return object_id
    there = records.earlier_answer(
        scope, desk.principal.user_id, asked.key
    )  # once: another may commit at any moment
    if there is not None:
        if not _outdated(desk, there):
            return _answer(there, asked)
        scope.db.delete(there)
        scope.db.flush()
    row = Idempotency(
        site_id=scope.site_id,
        owner_id=desk.principal.user_id,
        key=asked.key,
        request_sha256=asked.sha256,
        object_id=object_id,
        created_at=desk.now(),
    )
    if records.add_unless_there(scope, row):
        return object_id
    return earlier(desk, scope, asked) or claim(desk, scope, asked, object_id)
