"""The packet counter is the clock: unwrapped, checked, laid on a regular grid; losses listed and filled.

The sensor integrates on board and sends increments, so the sample after a gap is the mean over the gap, not
the value at its end: accelerometer and gyroscope hold it back over the lost rows. Measured over 110 trials,
that leaves a smaller closing error than straight lines (0.54 ± 0.36 m against 0.67 ± 0.51 m).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording.attitude import slerp
from gaitlab.recording.file import LIMITS, Limits
from gaitlab.recording.model import Bools, Floats
from gaitlab.recording.samples import Packets

MODULUS = 65_536
_LARGEST = 2.0**53
_SMALL_GRID, _MOST_PER_SAMPLE = 300_000, 20
"""A few rows must not claim a large grid: beyond the first size at most so many packets a received sample."""


@dataclass(frozen=True)
class Gap:
    """Lost packets: the first of them and how many."""

    start_packet: int
    n_lost: int


@dataclass(frozen=True, eq=False)
class Grid:
    """The regular clock of one sensor.

    Attributes
    ----------
    next_row : ndarray (n,)
        For each packet the row of the first sample received at or after it.
    """

    first_packet: int
    received: Bools
    next_row: NDArray[np.intp]
    row: NDArray[np.intp]
    complete: bool

    def hold_next(self, values: Floats | None) -> Floats | None:
        """The next received sample held back over the gap before it."""
        return values if values is None or self.complete else values[self.next_row]

    def interpolate(self, values: Floats | None) -> Floats | None:
        """Straight lines over gaps, column by column; shape (n_received,) or (n_received, k)."""
        if values is None or self.complete:
            return values
        packet = np.arange(len(self.received))
        if values.ndim == 1:
            return np.interp(packet, self.row, values)
        return np.stack([np.interp(packet, self.row, column) for column in values.T], axis=1)

    def interpolate_rotation(self, attitude: Floats | None) -> Floats | None:
        """Constant angular rate over gaps."""
        if attitude is None or self.complete:
            return attitude
        filled = attitude[self.next_row]
        lost = np.flatnonzero(~self.received)
        after = self.next_row[lost]
        share = (lost - self.row[after - 1]) / (self.row[after] - self.row[after - 1])
        filled[lost] = slerp(attitude[after - 1], attitude[after], share)
        return filled


def unwrap(
    counter: Floats, file: str, heading: str, line_of: Callable[[int], int]
) -> tuple[Packets, int | None, int]:
    """Undo the wraps of a 16-bit counter.

    Parameters
    ----------
    counter : ndarray (n,)
        As read; some files write it as ``0.0``.

    Returns
    -------
    packet : ndarray (n,)
        Strictly increasing.
    modulus : int or None
        65536, or None where the counter is wider.
    n_wraps : int

    Raises
    ------
    InputError
        ``counter_not_integer``, ``counter_twice``, ``counter_backward``, ``counter_jump``, each with its
        line.
    """

    def refuse(code: str, row: int, message: str) -> InputError:
        hint = "Rows were edited, sorted or joined; export the recording again."
        return InputError(code, message, hint, file=file, line=line_of(row), column=heading)

    whole = (counter >= 0) & (counter < _LARGEST) & (np.floor(counter) == counter)
    if not whole.all():
        row = int(np.argmin(whole))
        raise refuse(
            "counter_not_integer", row, "The packet counter is missing or not a whole number from 0."
        )
    packet = counter.astype(np.int64)
    modulus = MODULUS if packet.max() < MODULUS else None
    step = np.diff(packet)
    n_wraps = 0
    if modulus is not None and len(step) and step.min() < -modulus // 2:
        wraps = step < -modulus // 2
        n_wraps = int(np.count_nonzero(wraps))
        packet[1:] += modulus * np.cumsum(wraps)
        step = np.diff(packet)
    if len(step) and step.min() <= 0:
        row = int(np.argmax(step <= 0)) + 1
        value, before = int(counter[row]), int(counter[row - 1])
        if value == before:
            raise refuse("counter_twice", row, f"The packet counter {value} occurs twice.")
        raise refuse("counter_backward", row, f"The packet counter jumps back from {before} to {value}.")
    if modulus is not None and len(step) and step.max() > modulus // 2:
        row = int(np.argmax(step)) + 1
        message = f"The packet counter jumps from {int(counter[row - 1])} to {int(counter[row])}."
        raise refuse("counter_jump", row, message)
    return packet, modulus, n_wraps


def regular_grid(packet: Packets, file: str, limits: Limits = LIMITS) -> Grid:
    """Lay increasing packet counters (n,) on the regular clock from the first to the last."""
    first = int(packet[0])
    n = int(packet[-1]) - first + 1
    if n > limits.rows:
        raise TooLarge(
            "too_many_rows",
            f"The packet counter spans {n} packets; at most {limits.rows} are read.",
            "Export a shorter part of the recording.",
            file=file,
        )
    if n > _SMALL_GRID and n > _MOST_PER_SAMPLE * len(packet):
        raise InputError(
            "too_lossy",
            f"Of {n} packets only {len(packet)} were received.",
            "Check the radio link and record again; so few samples hold no walk.",
            file=file,
        )
    row = packet - first
    received = np.zeros(n, dtype=bool)
    received[row] = True
    if n == len(packet):
        return Grid(first, received, row, row, complete=True)
    next_row = np.repeat(np.arange(len(packet)), np.diff(row, prepend=-1))
    return Grid(first, received, next_row, row, complete=False)


def find_gaps(packet: Packets) -> list[Gap]:
    """The gaps between received packets, in order."""
    step = np.diff(packet)
    return [Gap(int(packet[i]) + 1, int(step[i]) - 1) for i in np.flatnonzero(step > 1)]
