from __future__ import annotations

import json
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from gaitlab.analysis import Settings, analyze
from gaitlab.clinic import patients, sessions
from gaitlab.clinic.access import Principal
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.views import PatientForm, SessionForm, SessionView
from gaitlab.errors import GaitlabError, InputError, NotAllowed, NotFound, TooLarge
from gaitlab.recording import InputFile, Placement, read_files
from tests.clinic.conftest import People
from tests.clinic.people import Clock
from tests.recordings import short_walk

Sql = Callable[..., list[tuple[object, ...]]]
Files = dict[Placement, InputFile]
FORM = SessionForm.model_validate({"date": "2026-11-20", "test": "walk", "note": "in the corridor"})
RECORDS = ("session", "trial", "raw_file", "trial_file", "analysis", "idempotency")


@pytest.fixture
def patient_id(clinic: Clinic, people: People) -> str:
    with clinic.desk(people.alice) as desk:
        return patients.add_patient(desk, PatientForm(code="MS-07")).id


def add(
    clinic: Clinic,
    who: Principal,
    patient_id: str,
    files: Files | None = None,
    key: str | None = None,
    form: SessionForm = FORM,
) -> SessionView:
    with clinic.desk(who) as desk:
        return sessions.add_session(desk, patient_id, form, files or short_walk(), idempotency_key=key)


def counts(sql: Sql) -> dict[str, object]:
    return {table: sql(f"SELECT count(*) FROM {table}")[0][0] for table in RECORDS}


def contents(clinic: Clinic) -> list[Path]:
    return [path for path in (clinic.settings.data_dir / "files").rglob("*") if path.is_file()]


# Stored whole


def test_a_session_comes_back_as_it_was_sent(
    clinic: Clinic, people: People, patient_id: str, clock: Clock
) -> None:
    added = add(clinic, people.alice, patient_id)
    with clinic.desk(people.bob) as desk:
        found = sessions.get_session(desk, added.id)
        assert found == added
        assert sessions.get_trial(desk, added.trials[0].id) == added.trials[0]
        (listed,) = sessions.list_sessions(desk, patient_id)
        assert patients.get_patient(desk, patient_id).n_sessions == 1
    assert (found.patient_code, found.test, found.course_m, found.note) == (
        "MS-07",
        "walk",
        None,
        "in the corridor",
    )
    assert (found.created_by, found.created_at, found.n_trials) == ("Alice", clock.time, 1)
    assert listed.model_dump() == found.model_dump(exclude={"trials"})


def test_the_stored_result_is_what_the_same_analysis_gives(
    clinic: Clinic, people: People, patient_id: str
) -> None:
    files = short_walk(knees=True)
    (trial,) = add(clinic, people.alice, patient_id, files).trials
    expected = analyze(read_files(files), Settings()).result
    assert trial.result == expected
    assert [(one.placement, one.sha256) for one in trial.files] == [(p, files[p].sha256) for p in Placement]
    assert [(one.placement, one.sha256) for one in trial.result.provenance.inputs] == [
        (p.value, files[p].sha256) for p in Placement
    ]
    assert [one.current for one in trial.analyses] == [True]


def test_the_course_of_the_session_is_the_course_of_the_analysis(
    clinic: Clinic, people: People, patient_id: str
) -> None:
    form = SessionForm.model_validate({"date": "2026-11-20", "test": "t25fw"})
    session = add(clinic, people.alice, patient_id, form=form)
    assert session.trials[0].result.provenance.settings["course_m"] == 7.62
    with clinic.desk(people.alice) as desk:
        second = sessions.add_trial(desk, session.id, short_walk(7.0))
    assert second.result.provenance.settings["course_m"] == 7.62


def test_every_raw_file_and_series_lies_under_its_hash(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    (trial,) = add(clinic, people.alice, patient_id).trials
    series = str(sql("SELECT series_sha256 FROM analysis")[0][0])
    assert {path.name for path in contents(clinic)} == {one.sha256 for one in trial.files} | {series}
    assert clinic.files.get(trial.files[0].sha256) == short_walk()[trial.files[0].placement].content


def test_a_session_made_at_the_console_says_so(clinic: Clinic, people: People, patient_id: str) -> None:
    assert add(clinic, people.console, patient_id).created_by == "command line"


def test_one_foot_alone_is_a_session(clinic: Clinic, people: People, patient_id: str) -> None:
    files = {Placement.LEFT_FOOT: short_walk()[Placement.LEFT_FOOT]}
    (trial,) = add(clinic, people.alice, patient_id, files).trials
    assert [one.placement for one in trial.files] == [Placement.LEFT_FOOT]


def test_the_same_files_may_belong_to_two_sessions_and_lie_once(
    clinic: Clinic, people: People, patient_id: str
) -> None:
    first, second = add(clinic, people.alice, patient_id), add(clinic, people.alice, patient_id)
    assert first.id != second.id
    assert len(contents(clinic)) == 3


def test_trials_are_numbered_within_their_session(clinic: Clinic, people: People, patient_id: str) -> None:
    session = add(clinic, people.alice, patient_id)
    with clinic.desk(people.alice) as desk:
        second = sessions.add_trial(desk, session.id, short_walk(7.0))
    with clinic.desk(people.alice) as desk:
        found = sessions.get_session(desk, session.id)
    assert [one.number for one in found.trials] == [1, 2]
    assert found.trials[1] == second
    assert found.n_trials == 2


# Or not at all


@pytest.mark.parametrize(
    "spoil",
    [
        lambda f: {**f, Placement.LEFT_FOOT: InputFile("walk.txt", b"\x89PNG\r\n\x1a\n" + bytes(500))},
        lambda f: {**f, Placement.RIGHT_FOOT: InputFile("walk.txt", b"")},
        lambda f: {**f, Placement.RIGHT_FOOT: replace(f[Placement.LEFT_FOOT], name="again.txt")},
        lambda f: {Placement.LEFT_KNEE: f[Placement.LEFT_FOOT]},
        lambda f: {},
        lambda f: {p: InputFile(one.name, one.content.replace(b"\t0.", b"\tx.", 1)) for p, one in f.items()},
    ],
    ids=["binary", "empty", "two files for one placement", "no foot", "no file", "text in a number"],
)
def test_a_wrong_upload_stores_nothing(
    clinic: Clinic, people: People, patient_id: str, sql: Sql, spoil: Callable[[Files], Files]
) -> None:
    before = counts(sql)
    with pytest.raises(InputError) as refusal, clinic.desk(people.alice) as desk:
        sessions.add_session(desk, patient_id, FORM, spoil(short_walk()), idempotency_key="k1")
    assert refusal.value.message
    assert counts(sql) == before
    assert contents(clinic) == []
    assert add(clinic, people.alice, patient_id, key="k1").n_trials == 1


def test_files_over_the_limit_store_nothing(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    clinic.settings = replace(clinic.settings, max_upload_bytes=1000)
    with pytest.raises(TooLarge):
        add(clinic, people.alice, patient_id)
    assert counts(sql)["session"] == 0
    assert contents(clinic) == []


def test_a_failure_between_files_and_rows_leaves_no_rows(
    clinic: Clinic, people: People, patient_id: str, sql: Sql, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = counts(sql)

    def fail(*_args: object) -> None:
        raise OSError("the power goes")

    monkeypatch.setattr("gaitlab.clinic.trials.add_analysis", fail)
    with pytest.raises(OSError, match="power"):
        add(clinic, people.alice, patient_id)
    assert counts(sql) == before
    assert sql("SELECT count(*) FROM audit_event WHERE action = 'session.add'") == [(0,)]


def test_a_session_and_its_event_are_stored_together(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    session = add(clinic, people.alice, patient_id)
    ((object_id, patient, details),) = sql(
        "SELECT object_id, patient_id, details FROM audit_event WHERE action = 'session.add'"
    )
    assert (object_id, patient) == (session.id, patient_id)
    assert json.loads(str(details))["files"] == {p.value: f.sha256 for p, f in short_walk().items()}


# Retries


def test_a_repeated_request_gives_the_same_session_and_stores_nothing(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    first = add(clinic, people.alice, patient_id, key="k1")
    before = counts(sql)
    assert add(clinic, people.alice, patient_id, key="k1") == first
    assert counts(sql) == before


def test_a_key_with_another_content_is_refused(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    add(clinic, people.alice, patient_id, key="k1")
    others = (
        lambda desk: sessions.add_session(desk, patient_id, FORM, short_walk(7.0), idempotency_key="k1"),
        lambda desk: sessions.add_session(
            desk, patient_id, FORM.model_copy(update={"note": "x"}), short_walk(), idempotency_key="k1"
        ),
    )
    for other in others:
        with pytest.raises(InputError) as refusal, clinic.desk(people.alice) as desk:
            other(desk)
        assert refusal.value.code == "idempotency_key_reused"
    assert counts(sql)["session"] == 1


def test_two_people_may_use_the_same_key(clinic: Clinic, people: People, patient_id: str) -> None:
    first = add(clinic, people.alice, patient_id, key="k1")
    assert add(clinic, people.bob, patient_id, key="k1").id != first.id


def test_without_a_key_nothing_is_recognised(clinic: Clinic, people: People, patient_id: str) -> None:
    assert add(clinic, people.alice, patient_id).id != add(clinic, people.alice, patient_id).id


def test_a_key_is_forgotten_after_a_week(
    clinic: Clinic, people: People, patient_id: str, clock: Clock
) -> None:
    first = add(clinic, people.alice, patient_id, key="k1")
    clock.pass_by(days=7, minutes=1)
    second = add(clinic, people.alice, patient_id, key="k1")
    assert second.id != first.id
    assert add(clinic, people.alice, patient_id, key="k1").id == second.id


def test_an_impossible_key_is_refused(clinic: Clinic, people: People, patient_id: str) -> None:
    for key in ("", "x" * 65, "a b", "ключ", "a\n"):
        with pytest.raises(InputError) as refusal:
            add(clinic, people.alice, patient_id, key=key)
        assert refusal.value.code == "idempotency_key"


def test_one_key_sent_many_times_at_once_makes_one_session(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    outcomes: list[str] = []
    start = threading.Barrier(6)

    def work() -> None:
        start.wait(10)
        try:
            outcomes.append(add(clinic, people.alice, patient_id, key="k1").id)
        except BaseException as problem:
            outcomes.append(repr(problem))

    threads = [threading.Thread(target=work) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(outcomes) == 6
    assert len(set(outcomes)) == 1
    assert counts(sql) == {**dict.fromkeys(RECORDS, 1), "raw_file": 2, "trial_file": 2}
    assert sql("SELECT count(*) FROM audit_event WHERE action = 'session.add'") == [(1,)]


def test_a_repeated_trial_is_stored_once(clinic: Clinic, people: People, patient_id: str) -> None:
    session = add(clinic, people.alice, patient_id)
    made = []
    for _ in range(2):
        with clinic.desk(people.alice) as desk:
            made.append(sessions.add_trial(desk, session.id, short_walk(7.0), idempotency_key="k2"))
    assert made[0] == made[1]
    with clinic.desk(people.alice) as desk:
        assert sessions.get_session(desk, session.id).n_trials == 2


def test_trials_added_at_once_get_different_numbers(clinic: Clinic, people: People, patient_id: str) -> None:
    session = add(clinic, people.alice, patient_id)
    numbers: list[object] = []

    def work() -> None:
        try:
            with clinic.desk(people.alice) as desk:
                numbers.append(sessions.add_trial(desk, session.id, short_walk(7.0)).number)
        except BaseException as problem:
            numbers.append(repr(problem))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert sorted(map(str, numbers)) == ["2", "3", "4", "5"]


# Analysed again


def test_a_new_analysis_is_added_and_the_old_one_stays_as_it_was(
    clinic: Clinic, people: People, patient_id: str, sql: Sql, clock: Clock
) -> None:
    session = add(clinic, people.alice, patient_id)
    (trial,) = session.trials
    (before,) = sql("SELECT * FROM analysis")
    clock.pass_by(days=1)
    with clinic.desk(people.bob) as desk:
        again = sessions.reanalyse(desk, trial.id, Settings(method="ikizoglu2018"))
    assert [(one.method, one.current) for one in again.analyses] == [
        ("ikizoglu2018", True),
        ("gaitlab", False),
    ]
    assert again.result.provenance.method == "ikizoglu2018"
    assert again.analyses[1] == trial.analyses[0].model_copy(update={"current": False})
    assert before in sql("SELECT * FROM analysis")
    assert counts(sql)["analysis"] == 2
    with clinic.desk(people.bob) as desk:
        assert sessions.get_trial(desk, trial.id) == again


def test_the_same_analysis_again_gives_the_same_result_to_the_byte(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    (trial,) = add(clinic, people.alice, patient_id).trials
    with clinic.desk(people.alice) as desk:
        sessions.reanalyse(desk, trial.id)
    rows = sql("SELECT result_json, series_sha256 FROM analysis")
    assert len(rows) == 2
    assert rows[0] == rows[1]


def test_a_damaged_raw_file_is_noticed_and_not_analysed(
    clinic: Clinic, people: People, patient_id: str, sql: Sql
) -> None:
    (trial,) = add(clinic, people.alice, patient_id).trials
    path = Path(clinic.files.path(trial.files[0].sha256))
    content = bytearray(path.read_bytes())
    content[1000] ^= 1
    path.chmod(0o600)
    path.write_bytes(content)
    with pytest.raises(GaitlabError, match="not as it was stored"), clinic.desk(people.alice) as desk:
        sessions.reanalyse(desk, trial.id)
    assert counts(sql)["analysis"] == 1


# Who may


def test_an_engineer_uploads_and_never_sees_names(clinic: Clinic, people: People, patient_id: str) -> None:
    named = {p: InputFile(f"Smith_{f.name}", f.content) for p, f in short_walk().items()}
    session = add(clinic, people.alice, patient_id, named)
    with clinic.desk(people.erik) as desk:
        seen = sessions.get_session(desk, session.id)
        sessions.add_trial(desk, session.id, short_walk(7.0))
        listed = sessions.list_sessions(desk, patient_id)
        trial = sessions.get_trial(desk, session.trials[0].id)
    shown = (
        seen.model_dump_json() + trial.model_dump_json() + "".join(one.model_dump_json() for one in listed)
    )
    for word in ("MS-07", "Smith", "corridor"):
        assert word not in shown
    assert [one.name for one in trial.files] == ["left_foot", "right_foot"]
    assert trial.files[0].sha256 == session.trials[0].files[0].sha256
    assert "Smith" in session.model_dump_json()


def test_a_reader_looks_and_stores_nothing(clinic: Clinic, people: People, patient_id: str) -> None:
    session = add(clinic, people.alice, patient_id)
    with clinic.desk(people.rita) as desk:
        assert sessions.get_session(desk, session.id) == session
    for attempt in (
        lambda desk: sessions.add_session(desk, patient_id, FORM, short_walk()),
        lambda desk: sessions.add_trial(desk, session.id, short_walk()),
        lambda desk: sessions.reanalyse(desk, session.trials[0].id),
        lambda desk: sessions.inspect_upload(desk, list(short_walk().values())),
    ):
        with pytest.raises(NotAllowed), clinic.desk(people.rita) as desk:
            attempt(desk)


def test_a_deleted_patients_sessions_are_gone_too(clinic: Clinic, people: People, patient_id: str) -> None:
    session = add(clinic, people.alice, patient_id, key="k1")
    with clinic.desk(people.alice) as desk:
        patients.delete_patient(desk, patient_id)
    for look in (
        lambda desk: sessions.get_session(desk, session.id),
        lambda desk: sessions.get_trial(desk, session.trials[0].id),
        lambda desk: sessions.list_sessions(desk, patient_id),
        lambda desk: sessions.add_session(desk, patient_id, FORM, short_walk(), idempotency_key="k1"),
    ):
        with pytest.raises(NotFound), clinic.desk(people.alice) as desk:
            look(desk)


def test_analysing_keeps_nobody_from_writing(
    clinic: Clinic, people: People, patient_id: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While one upload is analysed, another person's change is stored."""
    from gaitlab.clinic import trials

    def analyse_while_bob_writes(recording: object, settings: Settings) -> object:
        with clinic.desk(people.bob) as desk:
            patients.edit_patient(desk, patient_id, {"weight_kg": 61})
        return analyze(recording, settings)  # type: ignore[arg-type]

    monkeypatch.setattr(trials, "analyze", analyse_while_bob_writes)
    with clinic.desk(people.alice) as desk:
        patients.get_patient(desk, patient_id)
        sessions.add_session(desk, patient_id, FORM, short_walk())
    with clinic.desk(people.alice) as desk:
        assert patients.get_patient(desk, patient_id).weight_kg == 61
