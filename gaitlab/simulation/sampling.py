"""From the movement of a point to the exact samples of a sensor there.

Row k of a sensor covers the interval from the packet before it to its own, integrated on board. Two kinds of
device:

``strapdown`` (MTw and Awinda, which integrate at 1800 Hz) sends the turn over the interval as a rotation
vector, and the change of velocity in the sensor's frame at the START of the interval, each divided by the
interval's length. Adding them up again gives the exact movement, however long the interval, and so however many packets
were lost.

``mean`` sends the mean of specific force and of angular rate in the moving frame of the sensor.

Which of the two a real MTw is, recordings do not settle: with gravity's size taken as it is, the vertical velocity over
a stride closes better with the orientation at the interval's start (``strapdown``); with its excess taken for an offset,
and for stride lengths against optical markers, better with that at its middle (``mean``), which the analysis uses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from gaitlab.recording.model import Bools, Floats
from gaitlab.simulation.motion import Motion
from gaitlab.simulation.sensors import SensorErrors

Sampling = Literal["strapdown", "mean"]

GRAVITY_MPS2 = 9.80665
#: Acceleration of free fall in the world.
FREE_FALL = np.array([0.0, 0.0, -GRAVITY_MPS2])
FREE_FALL.setflags(write=False)

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
_BLOCK_ROWS = 32768


@dataclass(frozen=True, eq=False)
class Ticks:
    """The packets of one sensor: n rows, row k at ``(start + k) / rate_hz`` seconds."""

    rate_hz: float
    start: int
    received: Bools

    @property
    def rows(self) -> NDArray[np.int_]:
        """Rows that were received, shape (m,)."""
        return np.flatnonzero(self.received)

    @property
    def previous(self) -> NDArray[np.int_]:
        """For each received row the received row before it; −1 for the first."""
        return np.concatenate([[-1], self.rows[:-1]])

    def at_s(self, rows: NDArray[np.int_]) -> Floats:
        """Instants of rows in seconds."""
        return (self.start + rows) / self.rate_hz

    def gap_mean(self, values: Floats) -> Floats:
        """Mean of ``values`` (n, k) over each received row and the lost rows before it, shape (m, k)."""
        spans = np.diff(self.rows, prepend=-1)
        total: Floats = np.add.reduceat(values, self.previous + 1, axis=0)
        return total / spans[:, None]


def draw_ticks(
    n: int, rate_hz: float, errors: SensorErrors, rng: np.random.Generator, *, may_be_late: bool
) -> Ticks:
    """Draw when a sensor starts and ends within a recording of n packets, and which rows are lost."""
    late, early = (int(rng.integers(0, most + 1)) for most in (errors.late_start, errors.early_end))
    start = late if may_be_late else 0
    rows = max(n - start - early, 2)
    received = np.ones(rows, dtype=np.bool_)
    if errors.lost_share > 0.0:
        between = errors.lost_burst * (1.0 / errors.lost_share - 1.0)
        runs = rng.geometric([1.0 / between, 1.0 / errors.lost_burst], size=(rows // 2 + 1, 2))
        received = np.repeat(np.tile([True, False], len(runs)), runs.ravel())[:rows]
        received[-1] = True
    return Ticks(rate_hz, start, received)


def exact_samples(
    motion: Callable[[Floats], Motion], ends: Motion, ticks: Ticks, sampling: Sampling
) -> tuple[Floats, Floats]:
    """Specific force (m/s²) and angular rate (rad/s) in the frame of the moving segment, each (m, 3).

    ``ends`` is the motion at the start of the first row's interval and at the end of each of the m received
    rows'.
    """
    if sampling == "mean":
        force, rate = _means(motion, ticks)
        return ticks.gap_mean(force), ticks.gap_mean(rate)
    length_s = (np.diff(ticks.rows, prepend=-1) / ticks.rate_hz)[:, None]
    start = ends.rotation[:-1].inv()
    force = start.apply(np.diff(ends.velocity_mps, axis=0) / length_s - FREE_FALL)
    return force, (start * ends.rotation[1:]).as_rotvec() / length_s


def _means(motion: Callable[[Floats], Motion], ticks: Ticks) -> tuple[Floats, Floats]:
    """Means over every single interval, by Gauss's rule."""
    n = len(ticks.received)
    force, rate = np.empty((n, 3)), np.empty((n, 3))
    within = 0.5 * (_NODES - 1.0)
    for first in range(0, n, _BLOCK_ROWS):
        rows = np.arange(first, min(first + _BLOCK_ROWS, n))
        t_s = (ticks.start + rows[:, None] + within) / ticks.rate_hz
        at = motion(t_s.ravel())
        felt = at.rotation.inv().apply(at.acceleration_mps2 - FREE_FALL)
        for target, values in ((force, felt), (rate, at.angular_rate_radps)):
            target[rows] = 0.5 * np.einsum("knc,n->kc", values.reshape(len(rows), -1, 3), _WEIGHTS)
    return force, rate
