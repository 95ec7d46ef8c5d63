from __future__ import annotations

import shutil
import threading
from pathlib import Path

import pytest
from sqlalchemy import Engine, inspect
from sqlalchemy.exc import DatabaseError

from gaitlab import paths
from gaitlab.errors import Misconfigured
from gaitlab.store import schema
from gaitlab.store.database import open_engine
from tests.databases import raw


def test_an_empty_database_is_brought_to_head(engine: Engine) -> None:
    assert not schema.at_head(engine)
    schema.migrate(engine)
    assert schema.at_head(engine)


def test_migrations_make_exactly_what_the_classes_say(engine: Engine) -> None:
    schema.migrate(engine)
    assert schema.differences(engine) == []


@pytest.mark.parametrize(
    "change", ["ALTER TABLE patient ADD COLUMN surplus INTEGER", "DROP INDEX uq_patient_site_id_code_key"]
)
def test_a_difference_would_be_seen(engine: Engine, change: str) -> None:
    schema.migrate(engine)
    raw(engine)(change)
    assert schema.differences(engine) != []


def test_migrating_again_changes_nothing(engine: Engine) -> None:
    schema.migrate(engine)
    tables = inspect(engine).get_table_names()
    schema.migrate(engine)
    assert inspect(engine).get_table_names() == tables


def test_two_processes_may_start_on_an_empty_database_at_once(database_url: str, tmp_path: Path) -> None:
    problems: list[BaseException] = []
    start = threading.Barrier(2)

    def begin() -> None:
        own = open_engine(database_url, tmp_path)
        try:
            start.wait(10)
            schema.migrate(own)
        except BaseException as problem:
            problems.append(problem)
        finally:
            own.dispose()

    threads = [threading.Thread(target=begin) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert problems == []


def test_a_database_of_a_newer_version_is_refused_with_what_to_do(engine: Engine) -> None:
    schema.migrate(engine)
    raw(engine)("UPDATE alembic_version SET version_num = '9999'")
    with pytest.raises(Misconfigured, match="9999") as refusal:
        schema.migrate(engine)
    assert refusal.value.code == "database_newer"
    assert "newer version" in refusal.value.hint


def test_a_database_that_does_not_answer_is_misconfigured(tmp_path: Path) -> None:
    engine = open_engine("postgresql://nobody@127.0.0.1:1/none", tmp_path)
    with pytest.raises(Misconfigured):
        schema.migrate(engine)


def test_a_file_that_is_no_database_is_misconfigured(tmp_path: Path) -> None:
    (tmp_path / "gaitlab.sqlite3").write_bytes(b"this is a letter, not a database" * 100)
    engine = open_engine(None, tmp_path)
    with pytest.raises(Misconfigured):
        schema.migrate(engine)


def test_migrations_run_from_inside_an_installed_package(
    engine: Engine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed = tmp_path / "100% site" / "gaitlab" / "_data" / "migrations"
    shutil.copytree(paths.data_folder("migrations"), packed, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(schema, "data_folder", lambda name: packed.parent / name)
    schema._revisions.cache_clear()
    schema.migrate(engine)
    assert schema.at_head(engine)


@pytest.mark.parametrize("table", ["audit_event", "analysis", "patient_version"])
def test_the_database_itself_refuses_to_overwrite(engine: Engine, table: str) -> None:
    schema.migrate(engine)
    run = raw(engine)
    _fill(run)
    column = {"audit_event": "action", "analysis": "result_json", "patient_version": "content"}[table]
    with pytest.raises(DatabaseError, match="refused"):
        run(f"UPDATE {table} SET {column} = 'forged'")
    assert run(f"SELECT count(*) FROM {table} WHERE {column} = 'forged'") == [(0,)]


def test_the_database_itself_refuses_to_delete_from_the_trail(engine: Engine) -> None:
    schema.migrate(engine)
    run = raw(engine)
    _fill(run)
    with pytest.raises(DatabaseError, match="refused"):
        run("DELETE FROM audit_event")
    assert run("SELECT count(*) FROM audit_event") == [(1,)]


def test_a_row_cannot_point_at_a_parent_of_another_site(engine: Engine) -> None:
    schema.migrate(engine)
    run = raw(engine)
    _fill(run)
    run("INSERT INTO site (id, name, created_at) VALUES ('other', 'other', :now)", now=NOW)
    with pytest.raises(DatabaseError):
        run(
            "INSERT INTO session (id, site_id, patient_id, date, test, note, created_at, created_by) "
            "VALUES ('s2', 'other', 'p1', '2026-01-01', 'walk', '', :now, 'a')",
            now=NOW,
        )


NOW = "2026-11-21 10:00:00"


def _fill(run) -> None:  # type: ignore[no-untyped-def]
    """One row of everything down to an analysis, and one event."""
    run("INSERT INTO site (id, name, created_at) VALUES ('a', 'a', :now)", now=NOW)
    run(
        "INSERT INTO patient (id, site_id, code, code_key, pseudonym, sex, diagnosis, note, version, created_at, "
        "updated_at) VALUES ('p1', 'a', 'c', 'c', 'P', 'other', '', '', 1, :now, :now)",
        now=NOW,
    )
    run(
        "INSERT INTO patient_version (patient_id, version, site_id, content, salt, at, by) "
        "VALUES ('p1', 1, 'a', '{}', '', :now, 'x')",
        now=NOW,
    )
    run(
        "INSERT INTO session (id, site_id, patient_id, date, test, note, created_at, created_by) "
        "VALUES ('s1', 'a', 'p1', '2026-01-01', 'walk', '', :now, 'x')",
        now=NOW,
    )
    run(
        "INSERT INTO trial (id, site_id, session_id, number, created_at, created_by) "
        "VALUES ('t1', 'a', 's1', 1, :now, 'x')",
        now=NOW,
    )
    run(
        "INSERT INTO analysis (id, site_id, trial_id, number, gaitlab, method, settings, settings_sha256, "
        "result_json, series_sha256, created_at, created_by) "
        "VALUES ('n1', 'a', 't1', 1, '0', 'm', '{}', '', '{}', '', :now, 'x')",
        now=NOW,
    )
    run(
        "INSERT INTO audit_event (seq, at, site_id, actor_kind, actor_id, actor_roles, credential_id, action, "
        "patient_id, object_id, details, address, request_id, outcome, prev_hash, hash) "
        "VALUES (1, :now, 'a', 'person', 'x', '', '', 'look', '', '', '{}', '', '', 'done', '', '')",
        now=NOW,
    )
