"""The result of an analysis as it is stored, sent and rendered: ``gaitlab.result/1``.

Everything after the analysis (report, store, web) knows a trial only through ``Result`` and its ``Series``; so an old
result renders as it was computed, whatever the algorithms do today.
"""

from __future__ import annotations

import hashlib
import json
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Input(_Part):
    """A raw file and its hash."""

    placement: str
    name: str
    sha256: str


class Provenance(_Part):
    """What made the result: version, method, settings, inputs."""

    gaitlab: str
    method: str
    settings: dict[str, object]
    settings_sha256: str
    inputs: tuple[Input, ...]


class Clock(_Part):
    """The packet clock; time 0 of the result is ``first_packet``."""

    rate_hz: float
    first_packet: int


class SensorQuality(_Part):
    """How complete a sensor's recording is, and what its heading rests on."""

    samples: int
    lost: int
    saturated: int
    device: str | None
    heading: str | None = None


Quality = Literal["valid", "attention", "invalid"]


class Rest(_Part):
    """An interval in which the foot rests, and the evidence of how good it was: the velocity before the reset, the
    acceleration error since the rest before that would explain it, and the spread of the signals within."""

    start_s: float
    end_s: float
    residual_velocity_mps: float
    gyr_sd_radps: float | None = None
    acc_sd_mps2: float | None = None
    implied_acc_error_mps2: float | None = None


class Events(_Part):
    """Instants at which the foot leaves and reaches the ground."""

    foot_off_s: tuple[float, ...]
    initial_contact_s: tuple[float, ...]


class Stride(_Part):
    """One stride: from one rest of the foot to the next. Invalid ones are left out of means; ``reason`` says why."""

    start_s: float
    end_s: float
    length_m: float
    length_sd_m: float
    duration_s: float
    speed_mps: float
    turning: bool
    quality: Quality = "valid"
    reason: str = ""


class Foot(_Part):
    """A foot: rests, events, strides and the distance it travelled."""

    rests: tuple[Rest, ...]
    events: Events
    strides: tuple[Stride, ...]
    distance_m: float
    distance_sd_m: float


class KneeStride(_Part):
    """The knee in one gait cycle: how far it went, and how far the foot's step length was from what it would have
    gone uncorrected."""

    start_s: float
    end_s: float
    length_m: float
    residual_m: float


class KneeSway(_Part):
    """Movement of the knee beside the line of walking while its foot rests."""

    lateral_sd_m: float | None
    lateral_range_m: float | None
    n: int


class Knee(_Part):
    """A knee: gait cycles and sway in stance; where on the leg its sensor is, as its movement shows, and the share of the
    foot's movement that the leg between them does not explain."""

    strides: tuple[KneeStride, ...]
    sway: KneeSway
    place: Literal["shank", "thigh", "unknown"] | None = None
    unexplained_share: float | None = None


class Interval(_Part):
    """A span of time."""

    start_s: float
    end_s: float


class Turn(Interval):
    """A change of walking direction; positive angle to the left."""

    angle_deg: float


class TimedWalk(_Part):
    """A walk over a course of known length, from first movement to the foot's crossing of the end."""

    course_m: float
    start_s: float
    end_s: float
    rule: str


class Walk(_Part):
    """The walk as a whole."""

    straights: tuple[Interval, ...]
    turns: tuple[Turn, ...]
    closing_error_m: dict[Literal["left", "right"], float]
    timed: TimedWalk | None = None


class Parameter(_Part):
    """A ``Measurement`` as stored; ``label``, ``group`` and ``decimals`` serve people, the rest is the interface."""

    name: str
    side: Literal["left", "right", "both"]
    unit: str
    value: float | None
    sd: float | None
    ci95: tuple[float, float] | None
    n: int
    status: Literal["ok", "attention", "not_determinable"]
    reason: str
    definition: str
    label: str
    group: str
    reference: str
    decimals: int


class StrideSpread(_Part):
    """Scatter of a quantity over one foot's steady strides, for pooling trials: standard deviations observed and added
    by the measurement, as shares of ``mean`` where that is 1."""

    name: str
    side: Literal["left", "right"]
    n: int
    freedom: int
    mean: float
    observed_sd: float
    measurement_sd: float


class ResultWarning(_Part):
    """Something the reader should know; ``placement`` where it concerns one sensor."""

    code: str
    message: str
    placement: str | None


class TrialQuality(_Part):
    """May the trial be used? ``reasons``: a sentence each, the gravest first."""

    status: Quality
    reasons: tuple[str, ...]


class Result(BaseModel):
    """One analysis of one trial. Times in seconds on the packet clock."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)

    schema_: Literal["gaitlab.result/1"] = Field("gaitlab.result/1", alias="schema")
    provenance: Provenance
    clock: Clock
    sensors: dict[str, SensorQuality]
    feet: dict[Literal["left", "right"], Foot]
    knees: dict[Literal["left", "right"], Knee]
    walk: Walk
    parameters: tuple[Parameter, ...]
    warnings: tuple[ResultWarning, ...]
    spreads: tuple[StrideSpread, ...] = ()
    quality: TrialQuality | None = None

    def to_json(self) -> str:
        """Canonical JSON: the same result always has the same bytes."""
        return (
            json.dumps(self.model_dump(mode="json", by_alias=True), sort_keys=True, indent=1, allow_nan=False)
            + "\n"
        )

    def parameter(self, name: str, side: str = "both") -> Parameter | None:
        """Return one parameter, or None where this result has none of that name and side."""
        return next((p for p in self.parameters if p.name == name and p.side == side), None)


def settings_sha256(settings: dict[str, object]) -> str:
    """Hash of settings, independent of the order of their keys."""
    return hashlib.sha256(json.dumps(settings, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
