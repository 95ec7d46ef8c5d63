"""What the motion stages hand on: offsets, rests, and how a foot or a knee moved.

World frame: z up. Until ``frame.py`` has turned it, its heading is that of the orientation estimate, which is
arbitrary.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from gaitlab.motion.quaternions import multiply, turn_to_left
from gaitlab.recording.model import Bools, Floats, Placement

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Offsets:
    """Static offsets of one sensor, found while the person stood.

    Attributes
    ----------
    start, end : int
        Rows of the longest stretch of standing, ``[start, end)``, at least a second; the quietest second where nobody
        stands still.
    acc_mps2, gyr_radps : tuple of 3 floats
        Subtracted from the sensor's readings, sensor frame.
    standing : bool
        False where nobody stood still for a second; the offsets are then the best that is known.
    gravity_mps2 : float
        Size of the specific force while standing, before any correction.
    drift_sd_radps : float
        Standard uncertainty of the gyroscope's offset about the vertical.
    as_in_paper : bool
        It stands from 2 s to 3 s after the sensor's start, the second that the paper takes.
    """

    start: int
    end: int
    acc_mps2: tuple[float, float, float]
    gyr_radps: tuple[float, float, float]
    standing: bool
    gravity_mps2: float
    drift_sd_radps: float
    as_in_paper: bool = False


@dataclass(frozen=True, eq=False)
class Rests:
    """Intervals ``[start, end)`` of rows in which a foot rests, in order of time.

    Attributes
    ----------
    start, end, moment : ndarray (k,)
        First row, row after the last, and the quietest row of each rest.
    residual_mps : ndarray (k, 3)
        What the velocity had drifted to at ``start`` since the end of the rest before; 0 for the first.
    """

    start: Indices
    end: Indices
    moment: Indices
    residual_mps: Floats

    def __len__(self) -> int:
        return len(self.start)

    def mask(self, n: int) -> Bools:
        """True in every rest, shape (n,)."""
        edges = np.zeros(n + 1, dtype=np.int64)
        np.add.at(edges, self.start, 1)
        np.add.at(edges, self.end, -1)
        return np.cumsum(edges)[:n] > 0


@dataclass(frozen=True, eq=False)
class Motion:
    """How one sensor moved, row by row, in the world frame.

    Attributes
    ----------
    time_s : ndarray (n,)
        Seconds since the recording's first packet.
    attitude : ndarray (n, 4)
        Sensor to world, scalar first.
    rate_radps : ndarray (n, 3)
        Angular rate, offset removed, world axes.
    acceleration_mps2 : ndarray (n, 3)
        Free acceleration, offset removed.
    raw_velocity_mps, raw_position_m : ndarray (n, 3)
        Its integrals without any reset.
    velocity_mps, position_m : ndarray (n, 3)
        Corrected.
    """

    placement: Placement
    rate_hz: float
    time_s: Floats
    received: Bools
    saturated: Bools
    attitude: Floats
    rate_radps: Floats
    acceleration_mps2: Floats
    raw_velocity_mps: Floats
    raw_position_m: Floats
    velocity_mps: Floats
    position_m: Floats
    offsets: Offsets

    @property
    def n_samples(self) -> int:
        return len(self.time_s)

    def turned(self, yaw_rad: float) -> Self:
        """The same movement seen from a world turned about the vertical by ``yaw_rad`` (positive to the left)."""
        turn = np.array([np.cos(yaw_rad / 2), 0.0, 0.0, np.sin(yaw_rad / 2)])
        vectors = (
            "rate_radps",
            "acceleration_mps2",
            "raw_velocity_mps",
            "raw_position_m",
            "velocity_mps",
            "position_m",
        )
        changed: dict[str, Any] = {name: turn_to_left(getattr(self, name), yaw_rad) for name in vectors}
        return replace(self, attitude=multiply(turn, self.attitude), **changed)

    def moved(self, shift_m: Floats) -> Self:
        """The same movement with its path shifted, shape (3,)."""
        return replace(self, position_m=self.position_m + shift_m)


@dataclass(frozen=True)
class FieldEvidence:
    """What the magnetic field at the rests of a foot shows, and what came of it.

    Attributes
    ----------
    used : bool
        The heading's drift was corrected by it.
    scatter_rad, strength_spread : float
        About a steady drift of the heading; as a share of the mean.
    drift_radps, drift_sd_radps : float
        Drift of the gyroscope's heading against the field.
    """

    used: bool
    scatter_rad: float
    strength_spread: float
    drift_radps: float
    drift_sd_radps: float


@dataclass(frozen=True, eq=False)
class FootMotion(Motion):
    """A foot: its rests are where its velocity is known.

    Attributes
    ----------
    rests : Rests
    displacement_sd_m : ndarray (k − 1,)
        Standard uncertainty of the length of the horizontal displacement from each rest to the next.
    scale_sd : float
        Part of it that all displacements share, as a share of their length.
    doubtful_share : ndarray (k − 1,)
        Share of lost or saturated rows in the movement between.
    step_covariance_m2 : ndarray (k − 1, 3, 3)
        Of the sensor's displacement from each rest to the next.
    place_covariance_m2 : ndarray (k, 3, 3)
        Of its place at each rest against the first, drift of the heading included.
    velocity_var_m2ps2 : ndarray (k − 1,)
        Variance per axis that doubtful samples give the velocity over the movement between.
    level : ndarray of bool (k − 1,)
        The floor was taken to be level between the two rests.
    turn_rad : ndarray (k − 1,)
        Turn of the foot about the vertical from each rest to the next, positive to the left.
    restlessness : float or None
        How near to rest it ever comes, see ``rest.restlessness``.
    heading_from : str
        What its orientation was taken from: ``gyroscope``, ``VQF`` or ``device``.
    field : FieldEvidence or None
        What the magnetometer said of the heading; None where it said nothing.
    """

    rests: Rests
    displacement_sd_m: Floats
    scale_sd: float
    doubtful_share: Floats
    step_covariance_m2: Floats
    place_covariance_m2: Floats
    velocity_var_m2ps2: Floats
    level: Bools
    turn_rad: Floats
    restlessness: float | None = None
    heading_from: str = "gyroscope"
    field: FieldEvidence | None = None

    def turned(self, yaw_rad: float) -> Self:
        """As ``Motion.turned``; residual velocities and covariances turn with it."""
        residual = turn_to_left(self.rests.residual_mps, yaw_rad)
        c, s = np.cos(yaw_rad), np.sin(yaw_rad)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return replace(
            super().turned(yaw_rad),
            rests=replace(self.rests, residual_mps=residual),
            step_covariance_m2=turn @ self.step_covariance_m2 @ turn.T,
            place_covariance_m2=turn @ self.place_covariance_m2 @ turn.T,
        )

    def redirected(self, yaw_rad: Floats) -> Self:
        """The same movement with its heading corrected by ``yaw_rad``, shape (n,), which changes slowly.

        The covariances stay: it is a matter of a degree.
        """
        c, s = np.cos(yaw_rad), np.sin(yaw_rad)

        def turn(vectors: Floats) -> Floats:
            turned = vectors.copy()
            turned[:, 0] = c * vectors[:, 0] - s * vectors[:, 1]
            turned[:, 1] = s * vectors[:, 0] + c * vectors[:, 1]
            return turned

        step = np.diff(self.position_m, axis=0, prepend=self.position_m[:1])
        half = np.zeros((self.n_samples, 4))
        half[:, 0], half[:, 3] = np.cos(0.5 * yaw_rad), np.sin(0.5 * yaw_rad)
        return replace(
            self,
            turn_rad=self.turn_rad + np.diff(yaw_rad[self.rests.moment]),
            attitude=multiply(half, self.attitude),
            rate_radps=turn(self.rate_radps),
            acceleration_mps2=turn(self.acceleration_mps2),
            velocity_mps=turn(self.velocity_mps),
            position_m=self.position_m[0] + np.cumsum(turn(step), axis=0),
        )

    @property
    def rest_position_m(self) -> Floats:
        """Where the foot stands at each rest, shape (k, 3)."""
        return self.position_m[self.rests.moment]


class LegPlace(StrEnum):
    """Where on the leg a sensor is worn, as its movement against its foot shows."""

    SHANK = "shank"
    THIGH = "thigh"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class LegLink:
    """What joins a knee's sensor to its foot.

    Attributes
    ----------
    place : LegPlace
        ``UNKNOWN`` where neither a shank nor a thigh above this foot moves so: the sensor is on the other leg, on the
        trunk, or loose.
    unexplained : float
        What the link to the foot leaves of the movement, as a share of the foot's.
    """

    place: LegPlace
    unexplained: float


@dataclass(frozen=True, eq=False)
class KneeMotion(Motion):
    """A knee: it never rests, so its path is tied to its foot's by the leg between them.

    Attributes
    ----------
    cycle_start, cycle_end : ndarray (m,)
        Rows between which each cycle ran: from the foot's leaving one rest to its leaving the next.
    residual_m : ndarray (m,)
        Horizontal distance between the knee's uncorrected displacement in the cycle and the foot's.
    link : LegLink or None
        None where the foot made no gait cycle.
    """

    cycle_start: Indices
    cycle_end: Indices
    residual_m: Floats
    link: LegLink | None = None
