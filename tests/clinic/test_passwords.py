from __future__ import annotations

import threading

import pytest

from gaitlab.clinic import passwords
from gaitlab.clinic.passwords import check_password, hash_password, require_good_password
from gaitlab.errors import InputError

WORDS = ("Alice Weber", "alice.weber@clinic.example")


@pytest.mark.parametrize(
    "password",
    ["short-one-1", "Password1234!", "P@ssw0rd!2026", "passwordpassword", "aaaaaaaaaaaaaa", "123456789012345",
     "abcdefghijklmnop", "qwertyuiop123", "qwerty-azerty-2020", "Summer2026!!!!", "gaitlab-clinic-2026",
     "Alice Weber 1984", "aliceweberalice", "correcthorsebatterystaple", "            ", "x" * 129],
)  # fmt: skip
def test_a_password_that_is_easily_guessed_or_of_wrong_length_is_refused(password: str) -> None:
    with pytest.raises(InputError) as refusal:
        require_good_password(password, context=WORDS)
    assert (refusal.value.code, refusal.value.column) == ("weak_password", "password")
    assert password not in str(refusal.value) or not password.strip()


@pytest.mark.parametrize(
    "password", ["tolle Lampe grau Kette", "correct horse battery", "xk3!vT9q-Lm2", "пять зелёных сомов", "ab9$kq2mz" * 14]
)  # fmt: skip
def test_any_other_password_will_do(password: str) -> None:
    require_good_password(password[:128], context=WORDS)


def test_the_hash_is_argon2id_with_at_least_19_mib() -> None:
    kind, memory = hash_password("violet-tractor-hums").split("$")[1], hash_password("x" * 12).split("$")[3]
    assert kind == "argon2id"
    assert int(memory.split(",")[0].removeprefix("m=")) >= 19 * 1024


def test_the_right_password_fits_and_another_does_not() -> None:
    kept = hash_password("violet-tractor-hums")
    assert check_password("violet-tractor-hums", kept) == (True, None)
    assert check_password("violet-tractor-hum", kept) == (False, None)


def test_the_same_letters_fit_however_they_are_encoded() -> None:
    assert check_password("u\N{COMBINING DIAERESIS}ber-den-Wolken", hash_password("über-den-Wolken"))[0]


def test_an_account_that_does_not_exist_costs_the_same_work(monkeypatch: pytest.MonkeyPatch) -> None:
    verified: list[str] = []
    verify = passwords._HASHER.verify_and_update

    def counted(password: str, kept: str) -> tuple[bool, str | None]:
        verified.append(kept.split("$")[3])
        return verify(password, kept)

    monkeypatch.setattr(passwords._HASHER, "verify_and_update", counted)
    assert check_password("violet-tractor-hums", None) == (False, None)
    assert not check_password("wrong", hash_password("violet-tractor-hums"))[0]
    assert len(verified) == 2
    assert verified[0] == verified[1]


def test_a_hash_with_older_parameters_is_renewed() -> None:
    from pwdlib import PasswordHash
    from pwdlib.hashers.argon2 import Argon2Hasher

    old = PasswordHash((Argon2Hasher(time_cost=1, memory_cost=8 * 1024, parallelism=1),)).hash(
        "violet-tractor-hums"
    )
    right, renewed = check_password("violet-tractor-hums", old)
    assert right
    assert renewed is not None
    assert check_password("violet-tractor-hums", renewed) == (True, None)


def test_at_most_two_passwords_are_hashed_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    working, most, lock = 0, 0, threading.Lock()
    arrived = threading.Barrier(2)

    def slow(_password: str, *, salt: bytes | None = None) -> str:
        nonlocal working, most
        with lock:
            working += 1
            most = max(most, working)
        arrived.wait(10)  # goes on once two are here; a third would be counted before either leaves
        with lock:
            working -= 1
        return ""

    monkeypatch.setattr(passwords._HASHER, "hash", slow)
    threads = [threading.Thread(target=hash_password, args=("x",)) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    assert most == 2
