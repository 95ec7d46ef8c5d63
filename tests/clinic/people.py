"""Who comes to the clinic in tests: Alice and Bob work at one site, Charlie at another."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass, field
from functools import cache

from gaitlab.clinic.access import Principal, Role, granted
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.passwords import hash_password
from gaitlab.store.base import new_id
from gaitlab.store.people import Account, Site

PASSWORD = "violet-tractor-hums-94"


@dataclass
class Clock:
    """A clock that goes when told."""

    time: dt.datetime = field(default_factory=lambda: dt.datetime.now(dt.UTC).replace(microsecond=0))

    def __call__(self) -> dt.datetime:
        return self.time

    def pass_by(self, **duration: float) -> None:
        self.time += dt.timedelta(**duration)


@cache
def _hashed() -> str:
    return hash_password(PASSWORD)


def add_site(clinic: Clinic, name: str) -> str:
    """A further site."""
    with clinic.database.writing() as db:
        site = Site(id=new_id(), name=name, created_at=clinic.now())
        db.add(site)
    return site.id


def add_person(clinic: Clinic, site_id: str, name: str, *roles: Role) -> Principal:
    """An account with ``PASSWORD``, and the principal as if logged in."""
    with clinic.database.writing() as db:
        account = Account(
            id=new_id(),
            site_id=site_id,
            email=f"{name.lower()}@clinic.example",
            name=name,
            password_hash=_hashed(),
            roles=[role.value for role in roles],
            created_at=clinic.now(),
        )
        db.add(account)
    held = frozenset(roles)
    return Principal(account.id, site_id, name, held, granted(held), "person", new_id())
