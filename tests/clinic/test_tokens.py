from __future__ import annotations

from collections.abc import Callable

import pytest

from gaitlab.clinic import accounts, patients
from gaitlab.clinic.access import GRANTS, NEVER_FOR_TOKENS, Permission, Principal, Role
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.views import PatientForm
from gaitlab.errors import InputError, NotAllowed, NotFound
from tests.clinic.conftest import People
from tests.clinic.people import Clock

Sql = Callable[..., list[tuple[object, ...]]]
READ = (Permission.PATIENT_READ, Permission.PATIENT_NAMES)


def make(clinic: Clinic, owner: Principal, *permissions: Permission, days: int = 30) -> str:
    with clinic.desk(owner) as desk:
        text, _ = accounts.add_token(desk, name="pipeline", permissions=permissions or READ, days=days)
    return text


def use(clinic: Clinic, token: str) -> Principal:
    principal = accounts.principal_of_token(clinic, token)
    assert principal is not None
    return principal


def test_a_token_acts_for_its_owner_within_its_scopes(clinic: Clinic, people: People) -> None:
    program = use(clinic, make(clinic, people.alice))
    assert (program.user_id, program.site_id, program.kind) == (
        people.alice.user_id,
        people.alice.site_id,
        "token",
    )
    assert program.permissions == set(READ)
    with pytest.raises(NotAllowed), clinic.desk(program) as desk:
        patients.add_patient(desk, PatientForm(code="P1"))


def test_a_token_can_be_recognised_and_is_not_in_the_database(
    clinic: Clinic, people: People, sql: Sql
) -> None:
    token = make(clinic, people.alice)
    prefix, _, secret = token.split("_", 2)
    assert prefix == "gait"
    assert len(secret) >= 43
    assert secret not in str(sql("SELECT * FROM api_token"))
    assert secret not in str(sql("SELECT * FROM audit_event"))


def test_a_token_ends_when_it_expires(clinic: Clinic, people: People, clock: Clock) -> None:
    token = make(clinic, people.alice, days=1)
    clock.pass_by(hours=23, minutes=59)
    assert accounts.principal_of_token(clinic, token) is not None
    clock.pass_by(minutes=1)
    assert accounts.principal_of_token(clinic, token) is None


def test_a_revoked_token_ends_at_once(clinic: Clinic, people: People) -> None:
    token = make(clinic, people.alice)
    with clinic.desk(people.alice) as desk:
        accounts.revoke_token(desk, use(clinic, token).credential_id)
    assert accounts.principal_of_token(clinic, token) is None
    with clinic.desk(people.alice) as desk:
        assert [one.revoked for one in accounts.list_tokens(desk)] == [True]


def test_a_token_ends_with_its_owners_account(clinic: Clinic, people: People) -> None:
    token = make(clinic, people.alice)
    with clinic.desk(people.ada) as desk:
        accounts.disable_user(desk, "alice@clinic.example")
    assert accounts.principal_of_token(clinic, token) is None


def test_a_right_taken_from_the_owner_is_taken_from_the_token(
    clinic: Clinic, people: People, sql: Sql
) -> None:
    token = make(clinic, people.alice, Permission.PATIENT_WRITE, Permission.PATIENT_READ)
    sql("UPDATE account SET roles = '[\"reader\"]' WHERE id = :id", id=people.alice.user_id)
    assert use(clinic, token).permissions == {Permission.PATIENT_READ}


def test_a_token_never_manages_tokens_or_users_even_if_the_database_says_so(
    clinic: Clinic, people: People, sql: Sql
) -> None:
    token = make(clinic, people.alice)
    sql("UPDATE api_token SET scopes = :all", all=str([p.value for p in Permission]).replace("'", '"'))
    assert not use(clinic, token).permissions & NEVER_FOR_TOKENS


@pytest.mark.parametrize("permission", sorted(NEVER_FOR_TOKENS))
def test_management_is_refused_as_a_scope(clinic: Clinic, people: People, permission: Permission) -> None:
    with pytest.raises(InputError) as refusal:
        make(clinic, people.ada, permission)
    assert refusal.value.column == "permissions"


def test_nobody_gives_a_token_more_than_they_have(clinic: Clinic, people: People) -> None:
    with pytest.raises(NotAllowed):
        make(clinic, people.erik, Permission.PATIENT_WRITE)


def test_a_token_must_expire_within_a_year(clinic: Clinic, people: People) -> None:
    for days in (0, -1, 366, 10_000):
        with pytest.raises(InputError) as refusal:
            make(clinic, people.alice, days=days)
        assert refusal.value.column == "days"


def test_a_token_needs_name_and_permission(clinic: Clinic, people: People) -> None:
    with clinic.desk(people.alice) as desk:
        for name, permissions, column in (
            (" ", READ, "name"),
            ("x", (), "permissions"),
            ("a\nb", READ, "name"),
        ):
            with pytest.raises(InputError) as refusal:
                accounts.add_token(desk, name=name, permissions=permissions, days=1)
            assert refusal.value.column == column


def test_anything_but_the_token_itself_is_nobody(clinic: Clinic, people: People) -> None:
    token = make(clinic, people.alice)
    token_id, secret = token.split("_", 2)[1:]
    for other in (
        "",
        token[:-1],
        token + "x",
        f"goat_{token_id}_{secret}",
        f"gait_{token_id}_",
        f"gait_{token_id}_\ud800",
        f"gait_{token_id}",
        f"gait_{'a' * 26}_{secret}",
        "gait__",
        "é" * 40,
        token.upper(),
        secret,
    ):
        assert accounts.principal_of_token(clinic, other) is None
    assert accounts.principal_of_token(clinic, token) is not None


def test_everyone_sees_their_own_tokens_and_an_admin_those_of_the_site(
    clinic: Clinic, people: People
) -> None:
    token = make(clinic, people.alice)
    make(clinic, people.charlie)

    def listed(principal: Principal) -> list[str]:
        with clinic.desk(principal) as desk:
            return [one.owner for one in accounts.list_tokens(desk)]

    assert listed(people.alice) == ["Alice"]
    assert listed(people.bob) == []
    assert listed(people.ada) == ["Alice"]
    for stranger in (people.bob, people.charlie):
        with pytest.raises(NotFound), clinic.desk(stranger) as desk:
            accounts.revoke_token(desk, use(clinic, token).credential_id)
    with clinic.desk(people.ada) as desk:
        accounts.revoke_token(desk, use(clinic, token).credential_id)
    assert accounts.principal_of_token(clinic, token) is None


def test_the_console_makes_tokens_for_accounts_of_the_site_only(clinic: Clinic, people: People) -> None:
    with clinic.desk(people.console) as desk:
        text, view = accounts.add_token(
            desk, name="x", permissions=READ, days=1, owner_email="ALICE@clinic.example"
        )
        assert view.owner == "Alice"
        for nobody in ("charlie@clinic.example", "unknown@clinic.example", None):
            with pytest.raises(InputError):
                accounts.add_token(desk, name="x", permissions=READ, days=1, owner_email=nobody)
    assert use(clinic, text).user_id == people.alice.user_id


def test_only_who_manages_users_makes_tokens_for_others(clinic: Clinic, people: People) -> None:
    with pytest.raises(NotAllowed), clinic.desk(people.alice) as desk:
        accounts.add_token(desk, name="x", permissions=READ, days=1, owner_email="bob@clinic.example")


def test_use_is_noted_with_its_time(clinic: Clinic, people: People, clock: Clock) -> None:
    token = make(clinic, people.alice)
    clock.pass_by(hours=1)
    use(clinic, token)
    with clinic.desk(people.alice) as desk:
        (view,) = accounts.list_tokens(desk)
    assert view.last_used_at == clock.time


def test_refused_tokens_enter_the_trail_but_cannot_flood_it(
    clinic: Clinic, people: People, clock: Clock, events: Callable[[], list[tuple[str, str]]]
) -> None:
    token = make(clinic, people.alice, days=1)
    clock.pass_by(days=2)
    for _ in range(5):
        assert accounts.principal_of_token(clinic, token) is None
    assert events().count(("token.use", "refused")) == 1
    clock.pass_by(minutes=1)
    accounts.principal_of_token(clinic, token)
    assert events().count(("token.use", "refused")) == 2


def test_the_policy_is_what_was_decided() -> None:
    """Who sees names, who writes, who manages: a change here is a decision, not a slip."""
    names = {role for role in Role if Permission.PATIENT_NAMES in GRANTS[role]}
    write = {role for role in Role if Permission.PATIENT_WRITE in GRANTS[role]}
    clinical = {p for p in Permission if p.value.split(":")[0] in ("patient", "session", "report")}
    assert names == {Role.CLINICIAN, Role.READER}
    assert write == {Role.CLINICIAN}
    assert not GRANTS[Role.ADMIN] & clinical
    assert all(GRANTS[role].isdisjoint({Permission.USER_MANAGE}) for role in Role if role is not Role.ADMIN)
