"""Keeping house: clear away what crashes left behind."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass

from sqlalchemy import select

from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.trials import FILES_LOCK
from gaitlab.store.database import one_at_a_time
from gaitlab.store.tables import Analysis, TrialFile

A_DAY = dt.timedelta(days=1)


@dataclass(frozen=True)
class Swept:
    """How many contents without rows, and how many leftovers of interrupted writing, were removed."""

    contents: int
    temporary: int


def sweep(clinic: Clinic, older_than: dt.timedelta = A_DAY) -> Swept:
    """Remove contents that no trial and no analysis names, once they are older than ``older_than``.

    While it looks and removes, nobody can add rows for contents, so none that is named is ever taken.
    """
    instant = clinic.now() - older_than
    removed = 0
    for sha256 in list(clinic.files.older_than(instant)):
        with clinic.database.writing() as db:
            one_at_a_time(db, FILES_LOCK)
            used = db.scalar(
                select(TrialFile.sha256).where(TrialFile.sha256 == sha256).limit(1)
            ) or db.scalar(select(Analysis.series_sha256).where(Analysis.series_sha256 == sha256).limit(1))
            if used is None:
                clinic.files.delete(sha256)
                removed += 1
    return Swept(removed, clinic.files.clear_temporary(instant))
