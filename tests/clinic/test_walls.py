"""The wall between sites, and the trail behind everybody: held for every function of the clinic that there is.

``CASES`` names each public function that works at a desk. A new one without a case fails the first test.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import pytest

from gaitlab.analysis import Settings
from gaitlab.clinic import accounts, audit, patients, reports, sessions
from gaitlab.clinic.access import Permission, Principal
from gaitlab.clinic.audit import verify_chain
from gaitlab.clinic.clinic import Clinic, Desk
from gaitlab.clinic.views import PatientForm, SessionForm
from gaitlab.errors import InputError, NotAllowed, NotFound, NotLoggedIn
from gaitlab.store.base import new_id
from tests.clinic.conftest import People
from tests.clinic.people import PASSWORD
from tests.recordings import short_walk

MODULES: tuple[ModuleType, ...] = (accounts, audit, patients, reports, sessions)
FORM = SessionForm.model_validate({"date": "2026-11-20", "test": "walk"})
READ = (Permission.PATIENT_READ,)


@dataclass(frozen=True)
class Case:
    """A call of one function.

    Attributes
    ----------
    call : callable
        Takes the desk and the id (of a patient, session or trial) that ``of`` names.
    who : str
        Somebody who may do it.
    action : str
        The event it leaves; empty where it shows nothing of a patient and changes nothing.
    """

    call: Callable[[Desk, str], Any]
    of: str
    who: str
    action: str


CASES: Mapping[str, Case] = {
    "add_patient": Case(lambda d, _: patients.add_patient(d, PatientForm(code="X")), "", "alice", "patient.add"),
    "edit_patient": Case(lambda d, i: patients.edit_patient(d, i, {"note": "x"}), "patient", "alice", "patient.edit"),
    "get_patient": Case(patients.get_patient, "patient", "alice", "patient.view"),
    "list_patients": Case(lambda d, _: patients.list_patients(d), "", "alice", "patient.list"),
    "delete_patient": Case(patients.delete_patient, "patient", "alice", "patient.delete"),
    "inspect_upload": Case(lambda d, _: sessions.inspect_upload(d, list(short_walk().values())), "", "alice", ""),
    "add_session": Case(lambda d, i: sessions.add_session(d, i, FORM, short_walk()), "patient", "alice", "session.add"),
    "add_trial": Case(lambda d, i: sessions.add_trial(d, i, short_walk()), "session", "alice", "trial.add"),
    "get_session": Case(sessions.get_session, "session", "alice", "session.view"),
    "list_sessions": Case(sessions.list_sessions, "patient", "alice", "session.list"),
    "get_trial": Case(sessions.get_trial, "trial", "alice", "trial.view"),
    "reanalyse": Case(lambda d, i: sessions.reanalyse(d, i, Settings()), "trial", "alice", "trial.reanalyse"),
    "session_report_html": Case(reports.session_report_html, "session", "alice", "report.html"),
    "session_report_pdf": Case(reports.session_report_pdf, "session", "alice", "report.pdf"),
    "trial_figures": Case(reports.trial_figures, "trial", "alice", "trial.figures"),
    "trial_result_json": Case(reports.trial_result_json, "trial", "alice", "trial.result"),
    "trial_series_csv": Case(reports.trial_series_csv, "trial", "alice", "trial.series"),
    "add_token": Case(lambda d, _: accounts.add_token(d, name="x", permissions=READ, days=1), "", "alice", "token.add"),
    "list_tokens": Case(lambda d, _: accounts.list_tokens(d), "", "alice", ""),
    "revoke_token": Case(accounts.revoke_token, "token", "alice", "token.revoke"),
    "add_user": Case(lambda d, _: accounts.add_user(d, email="n@x.example", name="N", password=PASSWORD,
                                                    roles=["reader"]), "", "ada", "user.add"),
    "list_users": Case(lambda d, _: accounts.list_users(d), "", "ada", ""),
    "disable_user": Case(accounts.disable_user, "email", "ada", "user.disable"),
    "set_password": Case(lambda d, i: accounts.set_password(d, email=i, password=PASSWORD), "email", "ada", "user.password"),
    "list_events": Case(lambda d, _: audit.list_events(d), "", "ada", "audit.list"),
}  # fmt: skip
BY_ID = sorted(name for name, case in CASES.items() if case.of)


@pytest.fixture
def ours(clinic: Clinic, people: People) -> dict[str, str]:
    """Ids of one thing of each kind, belonging to Alice's site."""
    with clinic.desk(people.alice) as desk:
        patient = patients.add_patient(desk, PatientForm(code="canary-code", diagnosis="canary-diagnosis"))
        session = sessions.add_session(desk, patient.id, FORM, short_walk())
        _, token = accounts.add_token(desk, name="x", permissions=READ, days=1)
    return {
        "": "",
        "patient": patient.id,
        "session": session.id,
        "trial": session.trials[0].id,
        "token": token.id,
        "email": "bob@clinic.example",
    }


@pytest.fixture
def stranger(people: People) -> Principal:
    """Charlie, who may do everything, but elsewhere."""
    everything = frozenset(Permission)
    return Principal(**{**vars(people.charlie), "permissions": everything})


def test_every_function_at_a_desk_has_a_case() -> None:
    found = {
        name
        for module in MODULES
        for name, function in inspect.getmembers(module, inspect.isfunction)
        if name in module.__all__ and next(iter(inspect.signature(function).parameters), "") == "desk"
    }
    assert found == set(CASES)


@pytest.mark.parametrize("name", BY_ID)
def test_anothers_thing_looks_like_no_thing(
    clinic: Clinic, people: People, stranger: Principal, ours: dict[str, str], name: str
) -> None:
    case = CASES[name]
    nothing = {"email": "nobody@x.example"}.get(case.of, new_id())
    said = []
    for target in (ours[case.of], nothing):
        with pytest.raises(NotFound) as refusal, clinic.desk(stranger) as desk:
            case.call(desk, target)
        said.append((type(refusal.value), refusal.value.code, refusal.value.message, refusal.value.hint))
    assert said[0] == said[1]
    with clinic.desk(getattr(people, case.who)) as desk:
        case.call(desk, ours[case.of])


@pytest.mark.parametrize("name", BY_ID)
def test_ids_that_were_never_ids_are_found_nowhere(
    clinic: Clinic, people: People, ours: dict[str, str], name: str
) -> None:
    for target in (
        "",
        "0",
        "' OR 1=1 --",
        "../" * 5,
        "\x00",
        "\ud800",
        "é",
        "x" * 5000,
    ):
        with pytest.raises(NotFound), clinic.desk(getattr(people, CASES[name].who)) as desk:
            CASES[name].call(desk, target)


def test_lists_show_nothing_of_another_site(
    clinic: Clinic, stranger: Principal, ours: dict[str, str]
) -> None:
    with clinic.desk(stranger) as desk:
        shown = str(
            [
                patients.list_patients(desk),
                patients.list_patients(desk, query="canary"),
                accounts.list_tokens(desk),
                accounts.list_users(desk),
                audit.list_events(desk),
                sessions.inspect_upload(desk, list(short_walk().values())),
            ]
        )
    for secret in (*filter(None, ours.values()), "canary", "Alice"):
        assert secret not in shown


@pytest.mark.parametrize("name", sorted(CASES))
def test_without_permission_nothing_happens_but_a_note_in_the_trail(
    clinic: Clinic,
    people: People,
    ours: dict[str, str],
    events: Callable[[], list[tuple[str, str]]],
    name: str,
) -> None:
    nobody = Principal(**{**vars(people.alice), "permissions": frozenset()})
    before = events()
    with pytest.raises(NotAllowed), clinic.desk(nobody) as desk:
        CASES[name].call(desk, ours[CASES[name].of])
    (event,) = events()[len(before) :]
    assert event[1] == "refused"
    assert event[0] == CASES[name].action or not CASES[name].action


@pytest.mark.parametrize("name", sorted(CASES))
def test_every_look_and_change_leaves_exactly_one_event(
    clinic: Clinic,
    people: People,
    ours: dict[str, str],
    events: Callable[[], list[tuple[str, str]]],
    sql: Callable[..., list[tuple[object, ...]]],
    name: str,
) -> None:
    case, before = CASES[name], events()
    who: Principal = getattr(people, case.who)
    with clinic.desk(who, request_id="r-1", address="192.0.2.7") as desk:
        case.call(desk, ours[case.of])
    assert events()[len(before) :] == ([(case.action, "done")] if case.action else [])
    if case.action:
        (row,) = sql(
            "SELECT actor_kind, actor_id, credential_id, site_id, request_id, address, patient_id FROM audit_event "
            "ORDER BY seq DESC LIMIT 1"
        )
        assert row[:6] == ("person", who.user_id, who.credential_id, who.site_id, "r-1", "192.0.2.0/24")
        assert row[6] == (ours["patient"] if case.of in ("patient", "session", "trial") else row[6])
    assert verify_chain(clinic).ok


def test_characters_that_no_database_takes_are_looked_for_in_vain(clinic: Clinic, people: People) -> None:
    for odd in ("\x00", "a\x00b", "\ud800"):
        assert accounts.principal_of_token(clinic, odd) is None
        assert accounts.principal_of_session(clinic, odd.encode("utf-8", "replace").decode()) is None
        with pytest.raises(InputError), clinic.desk(people.alice) as desk:
            patients.list_patients(desk, query=odd)
        with clinic.desk(people.ada) as desk:
            assert audit.list_events(desk, patient_id=odd).total == 0
    with pytest.raises(NotLoggedIn):
        accounts.log_in(clinic, email="\x00", password="\x00", address="\x00")


def test_a_reach_across_the_wall_is_in_the_trail(
    clinic: Clinic, stranger: Principal, ours: dict[str, str], sql: Callable[..., list[tuple[object, ...]]]
) -> None:
    with pytest.raises(NotFound), clinic.desk(stranger) as desk:
        sessions.get_session(desk, ours["session"])
    assert sql("SELECT action, object_id, outcome, site_id FROM audit_event ORDER BY seq DESC LIMIT 1") == [
        ("session.view", ours["session"], "refused", stranger.site_id)
    ]


def test_what_was_looked_at_stays_in_the_trail_even_if_the_rest_fails(
    clinic: Clinic, people: People, ours: dict[str, str], events: Callable[[], list[tuple[str, str]]]
) -> None:
    before = events()

    def look_and_fail(fault: Exception) -> None:
        with clinic.desk(people.alice) as desk:
            patients.get_patient(desk, ours["patient"])
            patients.add_patient(desk, PatientForm(code="never"))
            raise fault

    for fault in (ZeroDivisionError(), NotFound("x", "x")):
        with pytest.raises(type(fault)):
            look_and_fail(fault)
    assert events()[len(before) :] == [
        ("patient.view", "done"),
        ("patient.view", "done"),
        ("patient.add", "refused"),
    ]
    with clinic.desk(people.alice) as desk:
        assert patients.list_patients(desk, query="never").total == 0


def test_a_refusal_before_the_desk_can_be_noted(
    clinic: Clinic, people: People, sql: Callable[..., list[tuple[object, ...]]]
) -> None:
    audit.record_refusal(clinic, people.rita, Permission.PATIENT_WRITE, request_id="r", address="2001:db8::1")
    assert sql("SELECT actor_id, outcome, address FROM audit_event ORDER BY seq DESC LIMIT 1") == [
        (people.rita.user_id, "refused", "2001:db8::/48")
    ]


def test_the_trail_names_people_for_those_who_may_read_it(
    clinic: Clinic, people: People, ours: dict[str, str]
) -> None:
    with clinic.desk(people.alice) as desk:
        patients.get_patient(desk, ours["patient"])
    with clinic.desk(people.ada) as desk:
        page = audit.list_events(desk, limit=1)
        of_patient = audit.list_events(desk, patient_id=ours["patient"])
    assert (page.items[0].actor, page.items[0].action) == ("Alice", "patient.view")
    assert {one.patient_id for one in of_patient.items} == {ours["patient"]}
    assert of_patient.total < page.total
