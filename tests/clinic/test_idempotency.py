"""A key that another request claims in the middle of ours: what it made stands, and ours makes nothing more."""

from __future__ import annotations

import pytest

from gaitlab.clinic import patients, sessions
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.views import PatientForm, SessionForm
from gaitlab.store import records
from gaitlab.store.records import Scope
from gaitlab.store.tables import Idempotency
from tests.clinic.conftest import People
from tests.clinic.test_sessions import Sql
from tests.recordings import short_walk

FORM = SessionForm.model_validate({"date": "2026-11-20", "test": "walk"})


@pytest.mark.parametrize("unseen", [1, 2])
def test_an_answer_that_is_committed_between_two_looks_is_given_and_kept(
    clinic: Clinic, people: People, sql: Sql, monkeypatch: pytest.MonkeyPatch, unseen: int
) -> None:
    """The first looks find nothing, as for who looks just before the other's commit."""
    with clinic.desk(people.alice) as desk:
        patient_id = patients.add_patient(desk, PatientForm(code="MS-07")).id
    files = short_walk()
    with clinic.desk(people.alice) as desk:
        first = sessions.add_session(desk, patient_id, FORM, files, idempotency_key="k1").id
    look, looks = records.earlier_answer, [0]

    def late(scope: Scope, owner_id: str, key: str) -> Idempotency | None:
        looks[0] += 1
        return None if looks[0] <= unseen else look(scope, owner_id, key)

    monkeypatch.setattr(records, "earlier_answer", late)
    with clinic.desk(people.alice) as desk:
        second = sessions.add_session(desk, patient_id, FORM, files, idempotency_key="k1").id
    assert second == first
    assert sql("SELECT count(*) FROM session") == [(1,)]
    assert sql("SELECT count(*) FROM idempotency") == [(1,)]
