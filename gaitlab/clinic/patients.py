"""Patients: add, look up, edit, hide."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.views import Page, PatientForm, PatientView

__all__ = [
    "PatientForm",
    "PatientView",
    "add_patient",
    "delete_patient",
    "edit_patient",
    "get_patient",
    "list_patients",
]


def add_patient(desk: Desk, form: PatientForm) -> PatientView:
    """Add a patient; ``Conflict`` where the site has one of the same code."""
    raise NotImplementedError


def edit_patient(
    desk: Desk, patient_id: str, form: PatientForm | Mapping[str, Any], *, version: int | None = None
) -> PatientView:
    """Change a patient: a whole form, or only the named fields of a mapping.

    ``version`` is the one the caller saw: ``Conflict`` where somebody was faster; None does not check.
    """
    raise NotImplementedError


def get_patient(desk: Desk, patient_id: str) -> PatientView:
    """One patient."""
    raise NotImplementedError


def list_patients(desk: Desk, *, query: str = "", limit: int = 50, offset: int = 0) -> Page[PatientView]:
    """Patients of the site by code; ``query`` is a part of the code. ``limit`` 1 to 200."""
    raise NotImplementedError


def delete_patient(desk: Desk, patient_id: str, reason: str = "") -> None:
    """Hide a patient and all that belongs to them; nothing is erased."""
    raise NotImplementedError
