from __future__ import annotations

import datetime as dt
import threading

import pytest

from gaitlab.store import audit
from gaitlab.store.audit import Actor, ChainReport, Event
from gaitlab.store.database import Database
from tests.databases import raw

KEY = b"k" * 32
NOW = dt.datetime(2026, 11, 21, 10, 0, 0, 5, tzinfo=dt.UTC)
ALICE = Actor("person", "alice", "clinician", "site", "c1", "192.0.2.0/24", "r1")


def write(db: Database, *actions: str, key: bytes = KEY) -> None:
    with db.writing() as session:
        audit.append(
            session, key, NOW, ALICE, [Event(action, "o", "p", {"é": [1, 2.5]}) for action in actions]
        )


def verify(db: Database, key: bytes = KEY) -> ChainReport:
    with db.reading() as session:
        return audit.verify(session, key)


def without_triggers(db: Database) -> None:
    """What an administrator of the database can do, the trail must still notice."""
    run = raw(db.engine)
    on = " ON audit_event" if db.engine.dialect.name == "postgresql" else ""
    for operation in ("update", "delete"):
        run(f"DROP TRIGGER audit_event_no_{operation}{on}")


def test_an_untouched_trail_is_whole(db: Database) -> None:
    write(db, "a", "b")
    write(db, "c")
    report = verify(db)
    assert (report.ok, report.n_events, report.first_bad) == (True, 3, None)


@pytest.mark.parametrize(
    "column",
    ["actor_id", "actor_kind", "actor_roles", "action", "details", "outcome", "address", "patient_id",
     "object_id", "site_id", "credential_id", "request_id", "prev_hash", "hash"],
)  # fmt: skip
def test_a_changed_value_is_found_where_it_is(db: Database, column: str) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    raw(db.engine)(f"UPDATE audit_event SET {column} = 'x' WHERE seq = 2")
    report = verify(db)
    assert (report.ok, report.first_bad) == (False, 2)


def test_a_changed_time_is_found(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    raw(db.engine)("UPDATE audit_event SET at = '2026-11-21 10:00:01' WHERE seq = 2")
    assert verify(db).first_bad == 2


def test_a_removed_event_is_found(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    raw(db.engine)("DELETE FROM audit_event WHERE seq = 2")
    assert verify(db).first_bad == 2


def test_a_removed_event_is_found_even_if_the_others_move_up(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    run = raw(db.engine)
    run("DELETE FROM audit_event WHERE seq = 2")
    run("UPDATE audit_event SET seq = 2 WHERE seq = 3")
    assert verify(db).first_bad == 2


def test_two_exchanged_events_are_found(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    run = raw(db.engine)
    for old, new in ((1, 9), (2, 1), (9, 2)):
        run(f"UPDATE audit_event SET seq = {new} WHERE seq = {old}")
    assert verify(db).first_bad == 1


def test_a_cut_end_is_found(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    raw(db.engine)("DELETE FROM audit_event WHERE seq = 3")
    report = verify(db)
    assert (report.ok, report.first_bad) == (False, 3)


def test_a_cut_end_is_found_even_if_the_head_is_set_back(db: Database) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    run = raw(db.engine)
    run("DELETE FROM audit_event WHERE seq = 3")
    run("UPDATE audit_head SET seq = 2, hash = (SELECT hash FROM audit_event WHERE seq = 2)")
    assert not verify(db).ok


@pytest.mark.parametrize("head", ["UPDATE audit_head SET seq = 2, hash = (SELECT hash FROM audit_event WHERE seq = 2)",
                                  "DELETE FROM audit_head"])  # fmt: skip
def test_going_on_after_a_cut_does_not_cover_it_up(db: Database, head: str) -> None:
    write(db, "a", "b", "c")
    without_triggers(db)
    run = raw(db.engine)
    run("DELETE FROM audit_event WHERE seq = 3")
    run(head)
    write(db, "d", "e")
    report = verify(db)
    assert (report.ok, report.first_bad) == (False, 3)


def test_a_trail_removed_as_a_whole_is_found(db: Database) -> None:
    write(db, "a")
    without_triggers(db)
    run = raw(db.engine)
    run("DELETE FROM audit_event")
    run("DELETE FROM audit_head")
    assert not verify(db).ok


def test_a_trail_rewritten_with_another_key_is_found(db: Database) -> None:
    write(db, "a", key=b"x" * 32)
    assert not verify(db).ok


def test_an_event_and_its_change_are_undone_together(db: Database) -> None:
    write(db, "a")

    def fail() -> None:
        with db.writing() as session:
            audit.append(session, KEY, NOW, ALICE, [Event("b")])
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    report = verify(db)
    assert (report.ok, report.n_events) == (True, 1)


def test_many_writers_make_one_chain(db: Database) -> None:
    problems: list[BaseException] = []

    def work() -> None:
        try:
            for _ in range(5):
                write(db, "a", "b")
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=work) for _ in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert problems == []
    report = verify(db)
    assert (report.ok, report.n_events) == (True, 50)
