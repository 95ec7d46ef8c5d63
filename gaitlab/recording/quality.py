"""What the clock and the ranges of a recording say about how far its results can be trusted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Finding, Sensor
from gaitlab.recording.samples import Packets, Samples


@dataclass(frozen=True)
class QualityParams:
    """From when on losses are worth a word; about half of real trials lose more than 1 %."""

    lost_share: float = 0.01
    long_gap_s: float = 2.0
    """Longer than a gait cycle: whole strides are invented by filling."""
    most_lost_share: float = 0.5


PARAMS = QualityParams()


def clock_findings(samples: Samples, sensor: Sensor, params: QualityParams = PARAMS) -> tuple[Finding, ...]:
    """Findings on lost packets, long gaps and saturation of one sensor (the placement is set by the
    caller)."""
    found: list[Finding] = []
    lost = np.diff(samples.packet) - 1
    if sensor.n_lost:
        found += _loss_findings(lost, samples, sensor, params)
    if sensor.n_saturated:
        message = (
            f"{sensor.n_saturated} samples stood at the end of the sensor's range; the true values were larger, and "
            "strides with such samples are less certain."
        )
        found.append(Finding("saturated", message))
    return tuple(found)


def _loss_findings(lost: Packets, samples: Samples, sensor: Sensor, params: QualityParams) -> list[Finding]:
    found: list[Finding] = []
    share = sensor.n_lost / sensor.n_samples
    longest = int(np.argmax(lost))
    longest_s = float(lost[longest]) / sensor.rate_hz
    if share > params.lost_share:
        n_gaps = np.count_nonzero(lost)
        gaps = "1 gap" if n_gaps == 1 else f"{n_gaps} gaps"
        few = share <= params.most_lost_share
        what = "strides there are less certain" if few else "hardly any result can be trusted"
        message = (
            f"{share:.1%} of the samples were lost in {gaps}, the longest {longest_s:.2f} s;"
            f" they are filled, and {what}."
        )
        found.append(Finding("lost_samples", message))
    if longest_s > params.long_gap_s:
        start_s = float(samples.packet[longest] + 1 - samples.packet[0]) / sensor.rate_hz
        message = (
            f"A gap of {longest_s:.1f} s begins {start_s:.1f} s after the sensor's start; what was walked in it "
            "is not known, and lengths across it are not to be trusted."
        )
        found.append(Finding("long_gap", message))
    return found
