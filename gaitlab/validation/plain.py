"""Recordings out of files that are no sensor's own export, laid on the packet clock like any other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gaitlab.recording import InputFile, Placement, Recording
from gaitlab.recording.model import Floats
from gaitlab.recording.quality import clock_findings
from gaitlab.recording.rates import Rate
from gaitlab.recording.reading import to_sensor
from gaitlab.recording.samples import Packets, Rates, Samples


def samples_of(file: InputFile, packet: Packets, rate: Rate, acc_mps2: Floats, gyr_radps: Floats) -> Samples:
    """Samples of one sensor, taken at instants: none of these devices says that it integrates on board."""
    return Samples(
        file,
        "table of a public data set",
        packet.astype(np.int64),
        None,
        Rates(header_hz=rate.hz),
        acc_mps2=acc_mps2,
        gyr_radps=gyr_radps,
        averaged=False,
    )


def recording_of(samples: Mapping[Placement, Samples], rate: Rate) -> Recording:
    """Sensors that share a clock."""
    sensors = {placement: to_sensor(placement, one, rate) for placement, one in samples.items()}
    findings = [
        replace(finding, placement=placement)
        for placement, one in samples.items()
        for finding in clock_findings(one, sensors[placement])
    ]
    return Recording(sensors, tuple(findings))
