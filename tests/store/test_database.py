from __future__ import annotations

import ast
import datetime as dt
import threading
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, func, select, update
from sqlalchemy.exc import StatementError

import gaitlab
from gaitlab.errors import GaitlabError, Misconfigured
from gaitlab.store import database, schema
from gaitlab.store.base import ID_PATTERN, new_id
from gaitlab.store.database import Database, journal_settings, normalised_url, open_engine
from gaitlab.store.people import Account, Site


def add_site(
    db: Database, name: str, created_at: dt.datetime = dt.datetime(2026, 1, 1, tzinfo=dt.UTC)
) -> str:
    with db.writing() as session:
        site = Site(id=new_id(), name=name, created_at=created_at)
        session.add(site)
    return site.id


def account(site_id: str, email: str) -> Account:
    now = dt.datetime(2026, 1, 1, tzinfo=dt.UTC)
    return Account(
        id=new_id(), site_id=site_id, email=email, name="A", password_hash="", roles=[], created_at=now
    )


@pytest.mark.parametrize(
    ("version", "mode"),
    [
        ((3, 40, 1), "TRUNCATE"),
        ((3, 44, 5), "TRUNCATE"),
        ((3, 44, 6), "WAL"),
        ((3, 45, 0), "TRUNCATE"),
        ((3, 50, 6), "TRUNCATE"),
        ((3, 50, 7), "WAL"),
        ((3, 51, 2), "TRUNCATE"),
        ((3, 51, 3), "WAL"),
        ((3, 53, 4), "WAL"),
    ],
)
def test_the_write_ahead_log_is_used_only_where_its_fault_is_mended(
    version: tuple[int, ...], mode: str
) -> None:
    assert journal_settings(version)[0] == mode


def test_every_sqlite_connection_is_set_up_for_safety(tmp_path: Path) -> None:
    engine = open_engine(None, tmp_path)
    expected = {
        "foreign_keys": 1,
        "secure_delete": 1,
        "trusted_schema": 0,
        "busy_timeout": 15000,
        "mmap_size": 0,
    }
    with engine.connect() as first, engine.connect() as second:
        for connection in (first, second):
            found = {name: connection.exec_driver_sql(f"PRAGMA {name}").scalar() for name in expected}
            assert {**expected, **{k: v for k, v in found.items() if v is not None}} == expected
            assert connection.exec_driver_sql("PRAGMA synchronous").scalar() in (2, 3)
    engine.dispose()


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_postgresql_addresses_mean_psycopg_3(scheme: str) -> None:
    assert normalised_url(f"{scheme}://u:p@h/d?x=1") == "postgresql+psycopg://u:p@h/d?x=1"


@pytest.mark.parametrize("url", ["mysql://h/d", "nonsense", "", "postgresql+asyncpg://h/d"])
def test_other_addresses_are_refused_without_repeating_them(url: str) -> None:
    with pytest.raises(Misconfigured) as refusal:
        normalised_url(url)
    assert not url or url not in str(refusal.value)


def test_an_engine_that_may_lose_what_it_confirmed_is_refused(engine: Engine) -> None:
    database.require_durable(engine)
    if engine.dialect.name == "sqlite":  # a file has no careless server; the pragma keeps it safe
        with engine.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA synchronous").scalar() in (2, 3)
        return
    careless = create_engine(engine.url.update_query_dict({"options": "-csynchronous_commit=off"}))
    with pytest.raises(Misconfigured, match="synchronous_commit"):
        database.require_durable(careless)
    careless.dispose()


def test_instants_come_back_aware_and_in_utc(db: Database) -> None:
    local = dt.datetime(2026, 7, 1, 12, 0, 0, 123456, tzinfo=dt.timezone(dt.timedelta(hours=2)))
    site_id = add_site(db, "a", local)
    with db.reading() as session:
        stored = session.scalar(select(Site.created_at).where(Site.id == site_id))
    assert stored == local
    assert stored is not None
    assert stored.tzinfo is dt.UTC


def test_an_instant_without_time_zone_is_refused(db: Database) -> None:
    with pytest.raises(StatementError, match="time zone"):
        add_site(db, "a", dt.datetime(2026, 7, 1, 12))  # noqa: DTZ001


def test_what_failed_halfway_leaves_nothing(db: Database) -> None:
    def fail() -> None:
        with db.writing() as session:
            session.add(Site(id=new_id(), name="half", created_at=dt.datetime(2026, 1, 1, tzinfo=dt.UTC)))
            session.flush()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    with db.reading() as session:
        assert session.scalar(select(func.count()).select_from(Site)) == 0


def test_writers_of_many_threads_all_get_through(db: Database) -> None:
    site_id = add_site(db, "0")
    problems: list[BaseException] = []

    def count_up() -> None:
        try:
            for _ in range(10):
                with db.writing() as session:
                    database.one_at_a_time(session, "count")
                    name = session.scalar(select(Site.name).where(Site.id == site_id))
                    session.execute(
                        update(Site).where(Site.id == site_id).values(name=str(int(name or 0) + 1))
                    )
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=count_up) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert problems == []
    with db.reading() as session:
        assert session.scalar(select(Site.name).where(Site.id == site_id)) == "60"


def test_a_second_writer_of_the_same_process_is_told_to_try_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "LOCK_TIMEOUT_S", 0.05)
    engine = open_engine(None, tmp_path)
    schema.migrate(engine)
    db = Database(engine)
    with db.writing(), pytest.raises(GaitlabError, match="busy"), db.writing():
        pytest.fail("two writers at once")
    with db.writing():
        pass
    engine.dispose()


def test_a_writer_of_another_process_is_told_to_try_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "LOCK_TIMEOUT_S", 0.05)
    first, second = open_engine(None, tmp_path), open_engine(None, tmp_path)
    schema.migrate(first)
    with Database(first).writing(), pytest.raises(GaitlabError, match="busy"), Database(second).writing():
        pytest.fail("two writers at once")
    with Database(second).writing():
        pass
    first.dispose()
    second.dispose()


def test_even_a_query_that_forgets_the_site_sees_only_its_own(db: Database) -> None:
    ours, theirs = add_site(db, "ours"), add_site(db, "theirs")
    with db.writing() as session:
        session.add_all([account(ours, "a@x"), account(theirs, "b@x")])
    transaction = db.transaction(ours)
    try:
        session = transaction.read()
        assert session.scalars(select(Account.email)).all() == ["a@x"]
        assert [one.email for one in session.scalars(select(Account))] == ["a@x"]
        assert session.scalar(select(func.count()).select_from(Account)) == 1
        assert session.execute(
            select(Account.email, Site.name).join(Site, Site.id == Account.site_id)
        ).all() == [("a@x", "ours")]
    finally:
        transaction.close()


def test_ids_are_all_different_and_speakable() -> None:
    ids = {new_id() for _ in range(1000)}
    assert len(ids) == 1000
    assert all(ID_PATTERN.fullmatch(one) for one in ids)


def test_the_clinic_knows_no_way_past_the_wall_between_sites() -> None:
    """Raw SQL, core tables and engines of one's own stay in the store."""
    barred = {"text", "__table__", "exec_driver_sql", "sessionmaker", "create_engine", "get"}
    offences = []
    for path in (Path(gaitlab.__file__).parent / "clinic").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("sqlalchemy"):
                offences += [f"{path.name} imports {one.name}" for one in node.names if one.name in barred]
            if isinstance(node, ast.Attribute) and node.attr in barred - {"text"} and _is_session(node.value):
                offences.append(f"{path.name}:{node.lineno} {node.attr}")
    assert offences == []


def _is_session(node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute | ast.Name) and (
        node.attr if isinstance(node, ast.Attribute) else node.id
    ) in {"db", "session", "engine"}
