"""Patients: add, look up, edit, hide."""

from __future__ import annotations

import base64
import hashlib
import json
import secrets
from collections.abc import Mapping
from typing import Any

from gaitlab.clinic.access import Permission
from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.desk import not_found
from gaitlab.clinic.showing import FORM_FIELDS, patient_view
from gaitlab.clinic.views import Page, PatientForm, PatientView, read_form
from gaitlab.errors import Conflict, InputError
from gaitlab.store import records
from gaitlab.store.base import new_id
from gaitlab.store.database import one_at_a_time
from gaitlab.store.records import Scope
from gaitlab.store.tables import Patient, PatientVersion

__all__ = [
    "PatientForm",
    "PatientView",
    "add_patient",
    "delete_patient",
    "edit_patient",
    "get_patient",
    "list_patients",
]

MOST_AT_ONCE = 200
_LONGEST_REASON = 500


def add_patient(desk: Desk, form: PatientForm) -> PatientView:
    """Add a patient; ``Conflict`` where the site has one of the same code."""
    scope = desk.writing(Permission.PATIENT_WRITE, "patient.add")
    now = desk.now()
    row = Patient(
        **form.model_dump(),
        id=new_id(),
        site_id=scope.site_id,
        code_key=records.code_key(form.code),
        pseudonym="P-" + base64.b32encode(secrets.token_bytes(5)).decode(),
        version=1,
        created_at=now,
        updated_at=now,
    )
    _require_free_code(scope, form.code)
    scope.db.add(row)
    sha256 = _keep_version(desk, scope, row, _typed(row))
    desk.changed("patient.add", object_id=row.id, patient_id=row.id, details={"version": 1, "sha256": sha256})
    return patient_view(desk, row, 0)


def edit_patient(
    desk: Desk, patient_id: str, form: PatientForm | Mapping[str, Any], *, version: int | None = None
) -> PatientView:
    """Change a patient: a whole form, or only the named fields of a mapping.

    ``version`` is the one the caller saw: ``Conflict`` where somebody was faster; None does not check.
    """
    scope = desk.writing(Permission.PATIENT_WRITE, "patient.edit", patient_id)
    row = _patient(scope, patient_id, lock=True)
    if version is not None and version != row.version:
        raise Conflict(
            "changed_meanwhile",
            "Somebody else changed this patient meanwhile.",
            "Look at the present record and enter your changes again.",
        )
    before = _typed(row)
    wanted = form if isinstance(form, PatientForm) else read_form(PatientForm, {**before, **form})
    after = wanted.model_dump()
    changed = sorted(field for field in FORM_FIELDS if after[field] != before[field])
    if changed:
        if "code" in changed and records.code_key(wanted.code) != row.code_key:
            _require_free_code(scope, wanted.code)
            row.code_key = records.code_key(wanted.code)
        for field in changed:
            setattr(row, field, after[field])
        _note_change(desk, scope, row, "patient.edit", after, {"fields": changed})
    return patient_view(desk, row, records.session_counts(scope, [row.id]).get(row.id, 0))


def get_patient(desk: Desk, patient_id: str) -> PatientView:
    """One patient."""
    scope = desk.reading(Permission.PATIENT_READ, "patient.view", patient_id)
    row = _patient(scope, patient_id)
    desk.looked("patient.view", object_id=row.id, patient_id=row.id)
    return patient_view(desk, row, records.session_counts(scope, [row.id]).get(row.id, 0))


def list_patients(desk: Desk, *, query: str = "", limit: int = 50, offset: int = 0) -> Page[PatientView]:
    """Patients of the site by code; ``query`` is a part of the code (or of the pseudonym).

    Raises
    ------
    InputError
        If ``limit`` is not from 1 to 200 or ``offset`` is negative.
    """
    scope = desk.reading(Permission.PATIENT_READ, "patient.list")
    require_page(limit, offset)
    if not query.isprintable():
        raise InputError("query", "A search must not contain control characters.", column="query")
    rows, total = records.patients(
        scope, query=query.strip(), by_pseudonym=not desk.sees_names, limit=limit, offset=offset
    )
    counts = records.session_counts(scope, [row.id for row in rows])
    desk.looked("patient.list", details={"patients": [row.id for row in rows]})
    items = [patient_view(desk, row, counts.get(row.id, 0)) for row in rows]
    return Page[PatientView](items=items, total=total, limit=limit, offset=offset)


def delete_patient(desk: Desk, patient_id: str, reason: str = "") -> None:
    """Hide a patient and all that belongs to them; nothing is erased."""
    scope = desk.writing(Permission.PATIENT_WRITE, "patient.delete", patient_id)
    row = _patient(scope, patient_id, lock=True)
    if len(reason) > _LONGEST_REASON:
        raise InputError("reason", f"A reason has at most {_LONGEST_REASON} characters.", column="reason")
    row.deleted_at = desk.now()
    _note_change(desk, scope, row, "patient.delete", {"deleted": True, "reason": reason}, {})


def require_page(limit: int, offset: int) -> None:
    """Refuse a part of a list that is too long or begins before its start."""
    if not 1 <= limit <= MOST_AT_ONCE:
        raise InputError("limit", f"A page holds 1 to {MOST_AT_ONCE} entries.", column="limit")
    if not 0 <= offset < 2**31:
        raise InputError("offset", "A list begins at 0.", column="offset")


def _patient(scope: Scope, patient_id: str, *, lock: bool = False) -> Patient:
    row = records.patient(scope, patient_id, lock=lock)
    if row is None:
        raise not_found()
    return row


def _typed(row: Patient) -> dict[str, Any]:
    return {field: getattr(row, field) for field in FORM_FIELDS}


def _note_change(
    desk: Desk,
    scope: Scope,
    row: Patient,
    action: str,
    content: Mapping[str, Any],
    details: Mapping[str, Any],
) -> None:
    row.version += 1
    row.updated_at = desk.now()
    sha256 = _keep_version(desk, scope, row, content)
    noted = {**details, "version": row.version, "sha256": sha256}
    desk.changed(action, object_id=row.id, patient_id=row.id, details=noted)


def _keep_version(desk: Desk, scope: Scope, row: Patient, content: Mapping[str, Any]) -> str:
    """Keep what the record says from now on, and return the salted hash that the audit trail holds of it."""
    salt = secrets.token_hex(32)
    text = json.dumps(dict(content), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    scope.db.add(
        PatientVersion(
            site_id=scope.site_id,
            patient_id=row.id,
            version=row.version,
            content=text,
            salt=salt,
            at=desk.now(),
            by=desk.principal.user_id,
        )
    )
    scope.db.flush()
    return hashlib.sha256((salt + text).encode()).hexdigest()


def _require_free_code(scope: Scope, code: str) -> None:
    if len(records.code_key(code)) > records.LONGEST_CODE_KEY:
        raise InputError("code", "The code has too many unusual characters.", column="code")
    one_at_a_time(scope.db, f"patient codes {scope.site_id}")
    if records.patient_with_code(scope, code) is not None:
        raise Conflict(
            "code_taken",
            "There is a patient with this code already.",
            "Look the patient up, or choose another code.",
        )
