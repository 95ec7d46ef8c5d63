"""How many packets a second: what the header says, what the time stamps say, what the user says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording.model import Finding, Floats
from gaitlab.recording.samples import Packets, Rates

DEFAULT_HZ = 100.0
SLOWEST_HZ, FASTEST_HZ = 10.0, 2000.0
_STAMP_MODULUS = 2.0**32
_STAMP_UNITS_HZ = (1e6, 1e4)  # microseconds; older firmware counts ticks of 0.1 ms
_PLAUSIBLE_HZ = (20.0, 2000.0)  # the two units differ by a factor of 100, so at most one of them fits
_SAME = 0.01


@dataclass(frozen=True)
class Rate:
    """The rate in use, where it came from (user, header, stamps, assumed) and what to say of it."""

    hz: float
    origin: str
    findings: tuple[Finding, ...] = ()


def rate_from_stamps(packet: Packets, stamp: Floats) -> float | None:
    """Packets per second from the device's stamps SampleTimeFine (n,); None where they are empty or still."""
    known = np.isfinite(stamp)
    if np.count_nonzero(known) < 3:
        return None
    packet, stamp = packet[known], stamp[known]
    step = np.diff(stamp)
    if step.min() < -_STAMP_MODULUS / 2:
        stamp = stamp + _STAMP_MODULUS * np.concatenate([[0], np.cumsum(step < -_STAMP_MODULUS / 2)])
        step = np.diff(stamp)
    per_packet = step / np.diff(packet)
    typical = float(np.median(per_packet))
    mean = float((stamp[-1] - stamp[0]) / (packet[-1] - packet[0]))
    if typical <= 0 or abs(mean - typical) > 0.02 * typical + 1:
        return None
    for unit_hz in _STAMP_UNITS_HZ:
        rate_hz = unit_hz / mean
        if _PLAUSIBLE_HZ[0] <= rate_hz < _PLAUSIBLE_HZ[1]:
            return round(rate_hz) if _same(rate_hz, round(rate_hz), 0.001) else rate_hz
    return None


def decide_rate(rates: Rates, user_hz: float | None = None) -> Rate | None:
    """The user's rate, else the time stamps' where they contradict the header, else the header's, else None.

    The time stamps come from the device; the header line may have been copied by a converter (a public file
    says 100 Hz over stamps of 60 Hz), so a contradiction is settled for the stamps and said.

    Raises
    ------
    InputError
        ``bad_rate``.
    """
    header_hz, stamps_hz = rates.header_hz, rates.stamps_hz
    if user_hz is not None:
        check_rate(user_hz)
        stated = stamps_hz or header_hz
        if stated is None or _same(stated, user_hz):
            return Rate(float(user_hz), "user")
        message = (
            f"The rate given, {user_hz:g} Hz, is used although the file says {stated:g} Hz; every time and length "
            "depends on it."
        )
        return Rate(float(user_hz), "user", (Finding("rate_overridden", message),))
    if header_hz and stamps_hz and not _same(header_hz, stamps_hz):
        message = (
            f"The header says {header_hz:g} Hz, the device's time stamps {stamps_hz:g} Hz; the time stamps are "
            "used. Every time and length depends on it: give the rate if you know it."
        )
        return Rate(stamps_hz, "stamps", (Finding("rate_contradiction", message),))
    if header_hz:
        return Rate(header_hz, "header")
    return Rate(stamps_hz, "stamps") if stamps_hz else None


def assumed_rate(other_hz: float | None = None, refused_hz: float | None = None) -> Rate:
    """The rate of the recording's other sensors, else the usual 100 Hz; said either way."""
    said = "The file does not say its rate"
    if refused_hz is not None:
        said = f"The file says that its rate is {refused_hz:g} Hz, which no sensor has"
    if other_hz is not None:
        message = f"{said}; {other_hz:g} Hz is taken from the other sensors."
        return Rate(other_hz, "assumed", (Finding("rate_assumed", message),))
    message = (
        f"{said}; {DEFAULT_HZ:g} Hz is assumed. If that is wrong, so is every time and length: give the rate."
    )
    return Rate(DEFAULT_HZ, "assumed", (Finding("rate_assumed", message),))


def check_rate(rate_hz: float) -> None:
    """Refuse a rate no inertial sensor has."""
    if not SLOWEST_HZ <= rate_hz <= FASTEST_HZ:
        raise InputError(
            "bad_rate",
            f"A rate of {rate_hz:g} Hz is not between {SLOWEST_HZ:g} and {FASTEST_HZ:g} Hz.",
            "Give the number of samples per second that the recording was made with.",
            column="rate",
        )


def same_rate(a_hz: float, b_hz: float) -> bool:
    """Equal but for rounding."""
    return _same(a_hz, b_hz, 0.001)


def _same(a_hz: float, b_hz: float, share: float = _SAME) -> bool:
    return abs(a_hz - b_hz) <= share * max(abs(a_hz), abs(b_hz))
