from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from gaitlab.clinic import accounts
from gaitlab.clinic.access import Principal, Role
from gaitlab.clinic.clinic import Clinic, ClinicSettings
from tests.clinic.people import Clock, add_person, add_site
from tests.databases import migrated_url, postgresql_url, raw, sqlite_at_head

__all__ = ["migrated_url", "postgresql_url", "sqlite_at_head"]


@pytest.fixture
def clinic(migrated_url: str, tmp_path: Path) -> Iterator[Clinic]:
    """A clinic on a new database of each kind, with a clock that goes when told."""
    limits = {"attempts_per_account": 4, "attempts_per_address": 6}
    clinic = Clinic.open(ClinicSettings(tmp_path / "data", migrated_url, **limits))
    clinic.now = Clock()
    yield clinic
    clinic.close()


@pytest.fixture
def clock(clinic: Clinic) -> Clock:
    assert isinstance(clinic.now, Clock)
    return clinic.now


@dataclass(frozen=True)
class People:
    """Alice and Bob are clinicians, Erik engineer, Rita reader, Ada admin; Charlie is clinician elsewhere."""

    alice: Principal
    bob: Principal
    erik: Principal
    rita: Principal
    ada: Principal
    charlie: Principal
    console: Principal


@pytest.fixture
def people(clinic: Clinic) -> People:
    console = accounts.console(clinic)
    here, elsewhere = console.site_id, add_site(clinic, "elsewhere")
    return People(
        alice=add_person(clinic, here, "Alice", Role.CLINICIAN),
        bob=add_person(clinic, here, "Bob", Role.CLINICIAN),
        erik=add_person(clinic, here, "Erik", Role.ENGINEER),
        rita=add_person(clinic, here, "Rita", Role.READER),
        ada=add_person(clinic, here, "Ada", Role.ADMIN),
        charlie=add_person(clinic, elsewhere, "Charlie", Role.CLINICIAN, Role.ADMIN),
        console=console,
    )


@pytest.fixture
def sql(clinic: Clinic) -> Callable[..., list[tuple[object, ...]]]:
    """Raw SQL beside the program."""
    return raw(clinic.database.engine)


@pytest.fixture
def events(sql: Callable[..., list[tuple[object, ...]]]) -> Callable[[], list[tuple[object, ...]]]:
    """(action, outcome) of all audit events so far, in order."""
    return lambda: sql("SELECT action, outcome FROM audit_event ORDER BY seq")
