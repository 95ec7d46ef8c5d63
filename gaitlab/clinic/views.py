"""What goes into the use cases and what comes out: forms (untrusted, strict) and views (what a caller may see)."""

from __future__ import annotations

import datetime as dt
import re
import unicodedata
from collections.abc import Mapping
from typing import Annotated, Any, Generic, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)

from gaitlab.clinic.access import Permission, Role
from gaitlab.errors import InputError
from gaitlab.recording.model import Placement
from gaitlab.result import Result

FIRST_DAY = dt.date(1990, 1, 1)
"""No walk was recorded with such sensors before."""
_DAY = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}")

T = TypeVar("T")
FormT = TypeVar("FormT", bound="Form")


def _one_line(text: str) -> str:
    if any(unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") for c in text):
        raise ValueError("must not contain control characters or line breaks")
    return text


def _plain_text(text: str) -> str:
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if any(unicodedata.category(c) in ("Cc", "Cs") and c not in "\n\t" for c in text):
        raise ValueError("must not contain control characters")
    return text


def _not_in_the_future(year: int) -> int:
    if year > dt.datetime.now(dt.UTC).year:
        raise ValueError("must not be in the future")
    return year


def _written_as_a_day(value: Any) -> Any:
    """Without this a bare number would be taken as seconds since 1970."""
    if isinstance(value, dt.date) or (isinstance(value, str) and _DAY.fullmatch(value.strip())):
        return value
    raise ValueError("must be a day, such as 2026-11-21")


def _past_or_today(date: dt.date) -> dt.date:
    if date < FIRST_DAY:
        raise ValueError(f"must not be before {FIRST_DAY}")
    # The day after today in UTC has begun somewhere.
    if date > dt.datetime.now(dt.UTC).date() + dt.timedelta(days=1):
        raise ValueError("must not be in the future")
    return date


Line = Annotated[str, AfterValidator(_one_line)]
Text = Annotated[str, AfterValidator(_plain_text)]
WalkDay = Annotated[dt.date, BeforeValidator(_written_as_a_day), AfterValidator(_past_or_today)]
Sex = Literal["female", "male", "other", "unknown"]
Test = Literal["t25fw", "10mwt", "walk"]

T25FW_M = 7.62
"""25 feet."""
COURSE_M: Mapping[Test, float | None] = {"t25fw": T25FW_M, "10mwt": 10.0, "walk": None}


class Form(BaseModel):
    """Base of what a person fills in; unknown fields are refused."""

    model_config = ConfigDict(extra="forbid", str_strip_whitespace=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _left_empty(cls, data: Any) -> Any:
        """A field left empty on a page is a field left out, where it may be."""
        if not isinstance(data, Mapping):
            return data
        optional = {name for name, field in cls.model_fields.items() if field.default is None}
        return {name: None if name in optional and value == "" else value for name, value in data.items()}


class PatientForm(Form):
    """A patient as typed in. ``code`` identifies them in the clinic and is unique within the site."""

    code: Line = Field(min_length=1, max_length=64)
    sex: Sex = "unknown"
    birth_year: Annotated[int, Field(ge=1890), AfterValidator(_not_in_the_future)] | None = None
    height_m: float | None = Field(default=None, ge=0.4, le=2.6)
    weight_kg: float | None = Field(default=None, ge=2, le=400)
    leg_length_m: float | None = Field(default=None, ge=0.2, le=1.5)
    diagnosis: Line = Field(default="", max_length=200)
    note: Text = Field(default="", max_length=2000)


class SessionForm(Form):
    """A session as typed in. ``course_m`` is set to the test's own length where it is left out."""

    date: WalkDay
    test: Test
    course_m: float | None = Field(default=None, ge=1, le=1000)
    note: Text = Field(default="", max_length=2000)

    @model_validator(mode="before")
    @classmethod
    def _course_of_the_test(cls, data: Any) -> Any:
        if isinstance(data, Mapping) and data.get("course_m") in (None, ""):
            return {**data, "course_m": COURSE_M.get(data.get("test", ""))}
        return data


class View(BaseModel):
    """Base of what a caller may see."""

    model_config = ConfigDict(frozen=True)


class PatientView(PatientForm):
    """A patient as stored. Without ``PATIENT_NAMES``, ``code`` is a pseudonym, and diagnosis and note are empty."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: str
    created_at: dt.datetime
    updated_at: dt.datetime
    version: int
    n_sessions: int


class FileView(View):
    """A raw file of a trial. Without ``PATIENT_NAMES``, ``name`` is made from the placement."""

    placement: Placement
    name: str
    device: str | None
    sha256: str
    size_bytes: int


class AnalysisView(View):
    """One analysis of a trial; the newest is current."""

    id: str
    created_at: dt.datetime
    gaitlab: str
    method: str
    settings_sha256: str
    current: bool


class TrialView(View):
    """A trial with its current result."""

    id: str
    session_id: str
    number: int
    created_at: dt.datetime
    files: list[FileView]
    analyses: list[AnalysisView]
    result: Result


class SessionSummary(View):
    """A session as listed."""

    id: str
    patient_id: str
    patient_code: str
    date: dt.date
    test: Test
    course_m: float | None
    note: str
    created_at: dt.datetime
    created_by: str
    n_trials: int


class SessionView(SessionSummary):
    """A session with its trials."""

    trials: list[TrialView]


class TokenView(View):
    """An API token without its secret."""

    id: str
    name: str
    owner: str
    permissions: list[Permission]
    created_at: dt.datetime
    expires_at: dt.datetime
    last_used_at: dt.datetime | None
    revoked: bool


class UserView(View):
    """An account without its password."""

    id: str
    email: str
    name: str
    roles: list[Role]
    created_at: dt.datetime
    active: bool


class EventView(View):
    """An audit event as listed."""

    seq: int
    at: dt.datetime
    actor_kind: str
    actor: str
    credential_id: str
    patient_id: str
    action: str
    object_id: str
    details: dict[str, Any]
    address: str
    request_id: str
    outcome: str


class Page(View, Generic[T]):
    """A part of a list, and how long the whole of it is."""

    items: list[T]
    total: int
    limit: int
    offset: int


def read_form(form: type[FormT], data: Mapping[str, Any]) -> FormT:
    """Check what was typed in; the first problem becomes an ``InputError`` whose ``column`` is the field."""
    try:
        return form.model_validate(dict(data))
    except ValidationError as problem:
        first = problem.errors(include_url=False, include_input=False)[0]
        field = ".".join(str(part) for part in first["loc"]) or None
        unknown = first["type"] == "extra_forbidden"
        said = first["msg"].removeprefix("Value error, ")
        message = f"There is no field of the name {field}." if unknown else f"{said[:1].upper()}{said[1:]}."
        raise InputError("invalid_field", message, column=field) from None
