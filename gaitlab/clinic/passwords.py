"""Passwords: which are good enough, and how they are kept (argon2id)."""

from __future__ import annotations

import re
import threading
import unicodedata
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from itertools import pairwise

from pwdlib import PasswordHash
from pwdlib.exceptions import PwdlibError
from pwdlib.hashers.argon2 import Argon2Hasher

from gaitlab.errors import InputError

MIN_LENGTH = 12
MAX_LENGTH = 128

# OWASP Password Storage Cheat Sheet: at least m = 19 MiB, t = 2, p = 1.
_MEMORY_KIB, _PASSES, _LANES = 32 * 1024, 2, 1
_HASHER = PasswordHash((Argon2Hasher(time_cost=_PASSES, memory_cost=_MEMORY_KIB, parallelism=_LANES),))
# A flood of log-ins must not use up the memory.
_TWO_AT_A_TIME = threading.BoundedSemaphore(2)

_LEET = str.maketrans("@4310$5!7", "aaeiossit")
_LEAST_OWN_CHARACTERS = 6
_LEAST_DIFFERENT = 5
_SHORTEST_WORD = 3
_CONTEXT = ("gaitlab", "gait", "lab", "clinic", "klinik")


def hash_password(password: str) -> str:
    """argon2id hash of a password, with its parameters and salt."""
    with _TWO_AT_A_TIME:
        return _HASHER.hash(unicodedata.normalize("NFC", password))


def check_password(password: str, kept: str | None) -> tuple[bool, str | None]:
    """Does the password fit the hash that is kept? Second, a new hash where the parameters have been raised.

    Without a hash (unknown account) the same work is done and the answer is no.
    """
    dummy = _dummy()
    typed = unicodedata.normalize("NFC", password) if len(password) <= MAX_LENGTH else ""
    with _TWO_AT_A_TIME:
        try:
            right, renewed = _HASHER.verify_and_update(typed, dummy if kept is None else kept)
        except PwdlibError:
            return False, None
    return (right, renewed) if kept is not None else (False, None)


def require_good_password(password: str, *, context: Iterable[str] = ()) -> None:
    """Refuse a password that is too short or easily guessed; ``context`` are words such as the person's name.

    Raises
    ------
    InputError
        ``weak_password``, with ``column`` "password".
    """
    length = len(unicodedata.normalize("NFC", password))
    if length < MIN_LENGTH:
        raise _weak(f"The password has {length} characters; at least {MIN_LENGTH} are needed.")
    if length > MAX_LENGTH:
        raise _weak(f"The password has {length} characters; at most {MAX_LENGTH} can be used.")
    if _is_guessable(password, context):
        raise _weak("The password is easily guessed: it is little more than common words or rows of keys.")


def _weak(message: str) -> InputError:
    return InputError(
        "weak_password",
        message,
        "Take four or five words that do not belong together; any characters may be used.",
        column="password",
    )


def _is_guessable(password: str, context: Iterable[str]) -> bool:
    spelled = unicodedata.normalize("NFKC", password).casefold()
    words = (part for word in (*context, *_CONTEXT) for part in re.split(r"[\W_]+", word.casefold()))
    personal = {word for word in words if len(word) >= _SHORTEST_WORD}
    return any(_own_part_is_small(text, personal) for text in (spelled, spelled.translate(_LEET)))


def _own_part_is_small(text: str, personal: set[str]) -> bool:
    """Is hardly anything left without personal words, two common words, rows of keys and repeats?"""
    for word in sorted(personal, key=len, reverse=True):
        text = text.replace(word, " ")
    for _ in range(2):
        common = max((word for word in _common_words() if word in text), key=len, default=" ")
        text = text.replace(common, " ")
    text = _without_rows(text)
    own = re.sub(r"[\W_]+", "", text)
    return len(own) < _LEAST_OWN_CHARACTERS or len(set(own)) < _LEAST_DIFFERENT


def _without_rows(text: str) -> str:
    """Drop each character that follows from the one before it: the same, or its neighbour in the alphabet."""
    kept = [text[:1]]
    for before, character in pairwise(text):
        if abs(ord(character) - ord(before)) > 1:
            kept.append(character)
    return "".join(kept)


@cache
def _common_words() -> frozenset[str]:
    text = files("gaitlab.clinic").joinpath("common_passwords.txt").read_text(encoding="utf-8")
    return frozenset(text.split())


@cache
def _dummy() -> str:
    return _HASHER.hash("no account has this password")
