from __future__ import annotations

import datetime as dt
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from gaitlab.clinic import patients, sessions
from gaitlab.clinic.access import Principal
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.upkeep import Swept, sweep
from gaitlab.clinic.views import PatientForm, SessionForm
from tests.clinic.conftest import People
from tests.clinic.people import Clock
from tests.recordings import short_walk

DAY = dt.timedelta(days=1)


def add_session(clinic: Clinic, who: Principal) -> str:
    form = SessionForm.model_validate({"date": "2026-11-20", "test": "walk"})
    with clinic.desk(who) as desk:
        patient = patients.add_patient(desk, PatientForm(code=f"P{clinic.now().timestamp()}"))
        return sessions.add_session(desk, patient.id, form, short_walk()).trials[0].id


def test_contents_without_rows_go_and_those_with_rows_stay(
    clinic: Clinic, people: People, clock: Clock
) -> None:
    trial_id = add_session(clinic, people.alice)
    orphans = [clinic.files.put(content) for content in (b"left by a crash", b"another")]
    clock.pass_by(days=2)
    assert sweep(clinic, DAY) == Swept(contents=2, temporary=0)
    assert not any(clinic.files.has(orphan) for orphan in orphans)
    with clinic.desk(people.alice) as desk:
        sessions.reanalyse(desk, trial_id)
    assert sweep(clinic, DAY) == Swept(0, 0)


def test_a_young_content_may_still_get_its_rows(clinic: Clinic) -> None:
    orphan = clinic.files.put(b"being uploaded")
    assert sweep(clinic, DAY) == Swept(0, 0)
    assert clinic.files.has(orphan)


def test_leftovers_of_interrupted_writing_go(clinic: Clinic, clock: Clock) -> None:
    temporary = clinic.settings.data_dir / "files" / "tmp" / "0123"
    temporary.write_bytes(b"half")
    assert sweep(clinic, DAY).temporary == 0
    clock.pass_by(days=2)
    assert sweep(clinic, DAY).temporary == 1
    assert not temporary.exists()


def test_other_files_in_the_folder_are_not_touched(clinic: Clinic, clock: Clock) -> None:
    note = clinic.settings.data_dir / "files" / "README"
    note.write_text("do not delete")
    os.utime(note, (0, 0))
    clock.pass_by(days=2)
    assert sweep(clinic, DAY) == Swept(0, 0)
    assert note.exists()


def test_a_patient_who_was_hidden_keeps_their_files(clinic: Clinic, people: People, clock: Clock) -> None:
    add_session(clinic, people.alice)
    with clinic.desk(people.alice) as desk:
        patients.delete_patient(desk, patients.list_patients(desk).items[0].id)
    clock.pass_by(days=2)
    assert sweep(clinic, DAY) == Swept(0, 0)


def test_what_a_sweep_takes_from_under_an_upload_is_put_back(
    clinic: Clinic,
    people: People,
    clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
    sql: Callable[..., list[tuple[object, ...]]],
) -> None:
    """An old orphan becomes part of an upload just when a sweep runs between its files and its rows."""
    from gaitlab.clinic import idempotency

    claim = idempotency.claim

    def sweep_first(*args: object) -> str:
        for path in Path(clinic.settings.data_dir / "files").rglob("[0-9a-f]" * 64):
            path.unlink()
        return claim(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(idempotency, "claim", sweep_first)
    trial_id = add_session(clinic, people.alice)
    monkeypatch.undo()
    with clinic.desk(people.alice) as desk:
        assert sessions.reanalyse(desk, trial_id).analyses[0].current
