"""Files that read well and yet tell nothing of a walk: too short, stuck, or without rotation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Bools, Finding, Floats
from gaitlab.recording.samples import Samples


@dataclass(frozen=True)
class UseParams:
    """A gait cycle lasts about 1 s; noise alone changes the last digits of a working sensor much sooner."""

    shortest_s: float = 1.0
    stuck_s: float = 1.0


PARAMS = UseParams()


def use_findings(samples: Samples, rate_hz: float, params: UseParams = PARAMS) -> tuple[Finding, ...]:
    """``too_short``, ``sensor_stuck`` and ``gyr_zero``, each with what it means for a result."""
    found: list[Finding] = []
    span_s = float(samples.packet[-1] - samples.packet[0] + 1) / rate_hz
    if span_s < params.shortest_s:
        message = (
            f"The recording lasts only {span_s:.2f} s, less than one gait cycle; no parameter of gait can be "
            "determined from it."
        )
        found.append(Finding("too_short", message))
    start_s, stuck_s = _longest_repeat(samples, rate_hz)
    if stuck_s > params.stuck_s:
        message = (
            f"Accelerometer and gyroscope repeat one and the same reading for {stuck_s:.1f} s from {start_s:.1f} s "
            "on; the sensor or its link stood still, and what was walked then is not known."
        )
        found.append(Finding("sensor_stuck", message))
    if samples.gyr_radps is not None and not samples.gyr_radps.any():
        message = (
            "The gyroscope is zero throughout; a working one never is. Rests, foot contacts and orientation cannot "
            "be told from it, and no result can be trusted."
        )
        found.append(Finding("gyr_zero", message))
    return tuple(found)


def _longest_repeat(samples: Samples, rate_hz: float) -> tuple[float, float]:
    """Start and length (s) of the longest run of rows that equal the one before; lengths 0 without any."""
    signals = [one for one in (samples.acc_mps2, samples.gyr_radps) if one is not None]
    if not signals or len(samples.packet) < 2:
        return 0.0, 0.0
    same = np.logical_and.reduce([_repeats(one) for one in signals])
    edge = np.flatnonzero(np.diff(np.concatenate([[False], same, [False]])))
    if not len(edge):
        return 0.0, 0.0
    first, last = samples.packet[edge[::2]], samples.packet[edge[1::2]]
    longest = int(np.argmax(last - first))
    return (
        float(first[longest] - samples.packet[0]) / rate_hz,
        float(last[longest] - first[longest] + 1) / rate_hz,
    )


def _repeats(signal: Floats) -> Bools:
    """Which rows of a signal (n, k) equal the one before; shape (n - 1,)."""
    return np.asarray((signal[1:] == signal[:-1]).all(axis=1))
