"""What a reader hands over: the samples of one sensor as they were sent, before losses are filled."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Bools, Finding, Floats

Packets = NDArray[np.int64]


@dataclass(frozen=True)
class Rates:
    """What a file says of its rate; None where it says nothing.

    Attributes
    ----------
    header_hz : float or None
        The header's line.
    stamps_hz : float or None
        From the device's time stamps (SampleTimeFine) over the packet counter.
    refused_hz : float or None
        A number in the header's line that is no rate, such as 0.
    """

    header_hz: float | None = None
    stamps_hz: float | None = None
    refused_hz: float | None = None


@dataclass(frozen=True, eq=False)
class Samples:
    """Received samples of one sensor, n of them.

    Attributes
    ----------
    family : str
        Kind of file, for people.
    packet : ndarray (n,)
        Packet counter, unwrapped: strictly increasing.
    modulus : int or None
        Where the device's counter wraps; None if it does not.
    orientation_from : str or None
        How the file writes the device's orientation, for people.
    n_wraps : int
        How often the counter wrapped.
    averaged : bool
        See ``Sensor``.
    """

    file: InputFile
    family: str
    packet: Packets
    modulus: int | None
    rates: Rates
    device: str | None = None
    acc_mps2: Floats | None = None
    gyr_radps: Floats | None = None
    mag: Floats | None = None
    free_acc_mps2: Floats | None = None
    attitude: Floats | None = None
    pressure_pa: Floats | None = None
    orientation_from: str | None = None
    n_wraps: int = 0
    averaged: bool = True
    findings: tuple[Finding, ...] = field(default=())

    @property
    def saturated(self) -> Bools:
        from gaitlab.recording.saturation import find_saturation

        return find_saturation(self.packet, self.acc_mps2, self.gyr_radps)

    def with_findings(self, *findings: Finding) -> Samples:
        return replace(self, findings=self.findings + findings)
