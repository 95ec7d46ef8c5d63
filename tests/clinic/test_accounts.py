from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from gaitlab.clinic import accounts
from gaitlab.clinic.access import Permission, Principal, Role
from gaitlab.clinic.clinic import Clinic
from gaitlab.errors import (
    Conflict,
    GaitlabError,
    InputError,
    NotAllowed,
    NotFound,
    NotLoggedIn,
    TooManyAttempts,
)
from tests.clinic.conftest import People
from tests.clinic.people import PASSWORD, Clock

Sql = Callable[..., list[tuple[object, ...]]]
HERE = "192.0.2.7"


def set_up(clinic: Clinic, code: str, email: str = "alice@clinic.example") -> None:
    accounts.create_first_account(
        clinic, code=code, email=email, name="Alice", password=PASSWORD, address=HERE
    )


def log_in(
    clinic: Clinic, email: str = "alice@clinic.example", password: str = PASSWORD, address: str = HERE
) -> tuple[str, Principal]:
    return accounts.log_in(clinic, email=email, password=password, address=address)


# Set-up


def test_there_is_no_account_before_set_up(clinic: Clinic, sql: Sql) -> None:
    assert accounts.needs_setup(clinic)
    assert sql("SELECT count(*) FROM account") == [(0,)]


def test_the_code_makes_the_first_account_and_no_second_one(clinic: Clinic) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    set_up(clinic, code)
    assert not accounts.needs_setup(clinic)
    assert accounts.setup_code(clinic) is None
    _, alice = log_in(clinic)
    assert alice.roles == {Role.ADMIN, Role.CLINICIAN}
    with pytest.raises(Conflict):
        set_up(clinic, code, "bob@clinic.example")


def test_the_code_may_be_typed_in_other_case_and_without_dashes(clinic: Clinic) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    set_up(clinic, code.replace("-", " ").upper())


def test_the_code_is_not_in_the_database(clinic: Clinic, sql: Sql) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    assert code.replace("-", "") not in str(sql("SELECT * FROM setup_code"))


def test_a_code_is_valid_for_a_day(clinic: Clinic, clock: Clock) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    clock.pass_by(hours=24)
    with pytest.raises(NotAllowed):
        set_up(clinic, code)
    assert accounts.needs_setup(clinic)


def test_a_new_code_replaces_the_one_before(clinic: Clinic) -> None:
    old, new = accounts.setup_code(clinic), accounts.setup_code(clinic)
    assert old is not None
    assert new is not None
    with pytest.raises(NotAllowed):
        set_up(clinic, old)
    set_up(clinic, new)


def test_guessing_the_code_is_slowed(clinic: Clinic, clock: Clock) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    for _ in range(clinic.settings.attempts_per_account):
        with pytest.raises(NotAllowed):
            set_up(clinic, "guess")
    with pytest.raises(TooManyAttempts):
        set_up(clinic, code)
    clock.pass_by(minutes=15, seconds=1)
    set_up(clinic, code)


def test_a_weak_password_does_not_use_up_the_code(clinic: Clinic) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    with pytest.raises(InputError) as refusal:
        accounts.create_first_account(clinic, code=code, email="a@b.example", name="A", password="weak")
    assert refusal.value.column == "password"
    set_up(clinic, code)


def test_the_field_that_is_wrong_is_named(clinic: Clinic) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    for email, name, column in (
        ("nonsense", "A", "email"),
        ("a b@c", "A", "email"),
        ("", "A", "email"),
        ("a@" + "b" * 260, "A", "email"),
        ("a@b.example", " ", "name"),
        ("a@b.example", "A\nB", "name"),
        ("a@b.example", "x" * 101, "name"),
    ):
        with pytest.raises(InputError) as refusal:
            accounts.create_first_account(clinic, code=code, email=email, name=name, password=PASSWORD)
        assert refusal.value.column == column


def test_only_one_of_two_people_at_once_gets_the_first_account(clinic: Clinic, sql: Sql) -> None:
    code = accounts.setup_code(clinic)
    assert code is not None
    outcomes: list[str] = []

    def attempt(email: str) -> None:
        try:
            set_up(clinic, code, email)
            outcomes.append("done")
        except Conflict:
            outcomes.append("conflict")

    threads = [threading.Thread(target=attempt, args=(f"p{i}@clinic.example",)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert sorted(outcomes) == ["conflict", "done"]
    assert sql("SELECT count(*) FROM account") == [(1,)]


# Log-in


def test_the_right_password_begins_a_session(clinic: Clinic, people: People) -> None:
    secret, alice = log_in(clinic, "  ALICE@clinic.example ")
    assert (alice.user_id, alice.kind, alice.permissions) == (
        people.alice.user_id,
        "person",
        people.alice.permissions,
    )
    again = accounts.principal_of_session(clinic, secret)
    assert again == alice


def test_unknown_wrong_and_disabled_get_the_same_words(clinic: Clinic, people: People) -> None:
    with clinic.desk(people.ada) as desk:
        accounts.disable_user(desk, "bob@clinic.example")
    said = []
    for email, password in (
        ("nobody@clinic.example", PASSWORD),
        ("alice@clinic.example", "wrong"),
        ("bob@clinic.example", PASSWORD),
    ):
        with pytest.raises(NotLoggedIn) as refusal:
            log_in(clinic, email, password)
        said.append((refusal.value.code, str(refusal.value)))
    assert len(set(said)) == 1


def test_the_database_holds_no_usable_session_secret(clinic: Clinic, people: People, sql: Sql) -> None:
    secret, _ = log_in(clinic)
    assert len(secret) >= 43
    assert secret not in str(sql("SELECT * FROM web_session"))
    assert (
        accounts.principal_of_session(clinic, str(sql("SELECT secret_sha256 FROM web_session")[0][0])) is None
    )


def test_every_log_in_is_a_new_session(clinic: Clinic, people: People) -> None:
    assert log_in(clinic)[0] != log_in(clinic)[0]


def test_a_hash_with_older_parameters_is_renewed_at_log_in(clinic: Clinic, people: People, sql: Sql) -> None:
    from pwdlib import PasswordHash
    from pwdlib.hashers.argon2 import Argon2Hasher

    old = PasswordHash((Argon2Hasher(time_cost=1, memory_cost=8 * 1024, parallelism=1),)).hash(PASSWORD)
    sql("UPDATE account SET password_hash = :old WHERE id = :id", old=old, id=people.alice.user_id)
    log_in(clinic)
    assert sql("SELECT password_hash FROM account WHERE id = :id", id=people.alice.user_id) != [(old,)]
    log_in(clinic)


def test_guessing_one_account_is_slowed_but_never_locked_for_good(
    clinic: Clinic, people: People, clock: Clock
) -> None:
    for i in range(clinic.settings.attempts_per_account):
        with pytest.raises(NotLoggedIn):
            log_in(clinic, password="wrong", address=f"198.51.100.{i}")
    for _ in range(5):
        with pytest.raises(TooManyAttempts):
            log_in(clinic, address="198.51.100.99")
    log_in(clinic, "bob@clinic.example")
    clock.pass_by(minutes=15, seconds=1)
    log_in(clinic)


def test_guessing_many_accounts_from_one_address_is_slowed(clinic: Clinic, people: People) -> None:
    for i in range(clinic.settings.attempts_per_address):
        with pytest.raises(NotLoggedIn):
            log_in(clinic, f"nobody{i}@clinic.example")
    with pytest.raises(TooManyAttempts):
        log_in(clinic)
    log_in(clinic, address="198.51.100.1")


def test_the_right_password_forgives_the_mistakes_before_it(clinic: Clinic, people: People) -> None:
    for _ in range(3):
        for _ in range(clinic.settings.attempts_per_account - 1):
            with pytest.raises(NotLoggedIn):
                log_in(clinic, password="wrong")
        log_in(clinic)


def test_many_guesses_at_once_are_not_more_guesses(clinic: Clinic, people: People) -> None:
    outcomes: list[str] = []

    def guess() -> None:
        try:
            log_in(clinic, password="wrong")
        except GaitlabError as problem:
            outcomes.append(problem.code)

    threads = [threading.Thread(target=guess) for _ in range(clinic.settings.attempts_per_account + 4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert outcomes.count("wrong_credentials") == clinic.settings.attempts_per_account
    assert outcomes.count("too_many_attempts") == 4


def test_neither_addresses_nor_what_was_typed_are_kept_of_attempts(
    clinic: Clinic, people: People, sql: Sql
) -> None:
    with pytest.raises(NotLoggedIn):
        log_in(clinic, "my-secret-typed-in-the-wrong-field")
    kept = str(sql("SELECT * FROM login_attempt")) + str(sql("SELECT * FROM audit_event"))
    assert "my-secret-typed" not in kept
    assert HERE not in kept
    assert "192.0.2.0/24" in kept


# Web sessions


def test_a_session_ends_when_idle_too_long(clinic: Clinic, people: People, clock: Clock) -> None:
    secret, _ = log_in(clinic)
    clock.pass_by(minutes=14, seconds=59)
    assert accounts.principal_of_session(clinic, secret) is not None
    clock.pass_by(minutes=15)
    assert accounts.principal_of_session(clinic, secret) is None


def test_polling_does_not_keep_a_session_alive(clinic: Clinic, people: People, clock: Clock) -> None:
    secret, _ = log_in(clinic)
    clock.pass_by(minutes=14)
    assert accounts.principal_of_session(clinic, secret, extend=False) is not None
    clock.pass_by(minutes=1)
    assert accounts.principal_of_session(clinic, secret, extend=False) is None


def test_a_session_ends_after_ten_hours_however_busy(clinic: Clinic, people: People, clock: Clock) -> None:
    secret, _ = log_in(clinic)
    for _ in range(59):
        clock.pass_by(minutes=10)
        assert accounts.principal_of_session(clinic, secret) is not None
    clock.pass_by(minutes=10)
    assert accounts.principal_of_session(clinic, secret) is None


def test_log_out_ends_this_session_and_no_other(clinic: Clinic, people: People) -> None:
    first, second = log_in(clinic)[0], log_in(clinic)[0]
    accounts.log_out(clinic, first)
    accounts.log_out(clinic, "unknown")
    assert accounts.principal_of_session(clinic, first) is None
    assert accounts.principal_of_session(clinic, second) is not None


def test_disabling_an_account_ends_its_sessions_at_once(clinic: Clinic, people: People) -> None:
    secret, _ = log_in(clinic)
    with clinic.desk(people.ada) as desk:
        assert not accounts.disable_user(desk, "alice@clinic.example").active
    assert accounts.principal_of_session(clinic, secret) is None


def test_a_new_password_ends_sessions_and_the_old_password(clinic: Clinic, people: People) -> None:
    secret, _ = log_in(clinic)
    with clinic.desk(people.ada) as desk:
        accounts.set_password(desk, email="alice@clinic.example", password="orbit-lantern-mossy-58")
    assert accounts.principal_of_session(clinic, secret) is None
    with pytest.raises(NotLoggedIn):
        log_in(clinic)
    log_in(clinic, password="orbit-lantern-mossy-58")


def test_a_role_taken_away_counts_from_the_next_request(clinic: Clinic, people: People, sql: Sql) -> None:
    secret, _ = log_in(clinic)
    sql("UPDATE account SET roles = '[\"reader\"]' WHERE id = :id", id=people.alice.user_id)
    alice = accounts.principal_of_session(clinic, secret)
    assert alice is not None
    assert not alice.may(Permission.PATIENT_WRITE)


# Users


def test_an_admin_adds_a_user_who_can_log_in(clinic: Clinic, people: People) -> None:
    with clinic.desk(people.ada) as desk:
        user = accounts.add_user(
            desk, email="New@Clinic.example", name="New", password=PASSWORD, roles=[Role.READER]
        )
        assert user.email in [one.email for one in accounts.list_users(desk)]
    _, new = log_in(clinic, "new@clinic.example")
    assert new.roles == {Role.READER}


def test_an_e_mail_address_is_taken_even_by_another_site(clinic: Clinic, people: People) -> None:
    with pytest.raises(Conflict), clinic.desk(people.ada) as desk:
        accounts.add_user(
            desk, email="charlie@clinic.example", name="C", password=PASSWORD, roles=[Role.READER]
        )


def test_a_user_needs_a_role(clinic: Clinic, people: People) -> None:
    with pytest.raises(InputError) as refusal, clinic.desk(people.ada) as desk:
        accounts.add_user(desk, email="x@clinic.example", name="X", password=PASSWORD, roles=[])
    assert refusal.value.column == "roles"


def test_an_admin_sees_and_ends_only_accounts_of_their_site(clinic: Clinic, people: People) -> None:
    with clinic.desk(people.ada) as desk:
        assert "charlie@clinic.example" not in [one.email for one in accounts.list_users(desk)]
    with pytest.raises(NotFound), clinic.desk(people.ada) as desk:
        accounts.disable_user(desk, "charlie@clinic.example")
    log_in(clinic, "charlie@clinic.example")


def test_nobody_disables_themselves(clinic: Clinic, people: People) -> None:
    with pytest.raises(Conflict), clinic.desk(people.ada) as desk:
        accounts.disable_user(desk, "ada@clinic.example")


def test_the_console_may_do_everything_in_the_default_site(clinic: Clinic) -> None:
    console = accounts.console(clinic)
    assert (console.kind, console.permissions) == ("console", frozenset(Permission))
    with clinic.desk(console) as desk:
        accounts.add_user(desk, email="a@clinic.example", name="A", password=PASSWORD, roles=[Role.CLINICIAN])
    assert log_in(clinic, "a@clinic.example")[1].site_id == console.site_id
