"""Movement of points on rigid segments, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from gaitlab.recording.model import Floats
from gaitlab.simulation.jet import Jet, sin_cos

Place = tuple[Jet | float, Jet | float, Jet | float]


@dataclass(frozen=True, eq=False)
class Motion:
    """Movement of one point of a segment at n instants; exact, not differenced.

    Attributes
    ----------
    position_m, velocity_mps, acceleration_mps2 : ndarray (n, 3)
        Of the point, in the world, z up.
    yaw_pitch_roll_rad : ndarray (n, 3)
        Turn of the segment: about z, then about the new y, then about the new x.
    angular_rate_radps : ndarray (n, 3)
        In segment coordinates.
    """

    position_m: Floats
    velocity_mps: Floats
    acceleration_mps2: Floats
    yaw_pitch_roll_rad: Floats
    angular_rate_radps: Floats

    @cached_property
    def rotation(self) -> Rotation:
        """Turns segment coordinates (forward, left, up) into world coordinates."""
        half = 0.5 * self.yaw_pitch_roll_rad.T
        (sy, sp, sr), (cy, cp, cr) = np.sin(half), np.cos(half)
        w, x = cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy
        y, z = cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy
        return Rotation.from_quat(np.column_stack([x, y, z, w]))


@dataclass(frozen=True, eq=False)
class Pose:
    """A rigid segment: its origin and its turn.

    First yaw about z, then pitch about the new y (nose down), then roll about the new x, in radians.
    """

    x: Jet
    y: Jet
    z: Jet
    yaw: Jet
    pitch: Jet
    roll: Jet

    @cached_property
    def _trigonometry(self) -> tuple[tuple[Jet, Jet], tuple[Jet, Jet], tuple[Jet, Jet]]:
        return sin_cos(self.yaw), sin_cos(self.pitch), sin_cos(self.roll)

    def point(self, place: Place) -> tuple[Jet, Jet, Jet]:
        """World coordinates of a point given in segment coordinates (forward, left, up), in metres."""
        (sin_yaw, cos_yaw), (sin_pitch, cos_pitch), (sin_roll, cos_roll) = self._trigonometry
        a, b, c = place
        left, upward = cos_roll * b - sin_roll * c, sin_roll * b + cos_roll * c
        forward, up = cos_pitch * a + sin_pitch * upward, cos_pitch * upward - sin_pitch * a
        x = cos_yaw * forward - sin_yaw * left
        y = sin_yaw * forward + cos_yaw * left
        return self.x + x, self.y + y, self.z + up

    def motion(self, place: Place) -> Motion:
        """Movement of a point given in segment coordinates."""
        axes = self.point(place)
        (_, _), (sin_pitch, cos_pitch), (sin_roll, cos_roll) = self._trigonometry
        yaw, pitch = self.yaw.rate, self.pitch.rate
        rate = (
            self.roll.rate - yaw * sin_pitch.value,
            pitch * cos_roll.value + yaw * cos_pitch.value * sin_roll.value,
            yaw * cos_pitch.value * cos_roll.value - pitch * sin_roll.value,
        )
        return Motion(
            position_m=np.column_stack([axis.value for axis in axes]),
            velocity_mps=np.column_stack([axis.rate for axis in axes]),
            acceleration_mps2=np.column_stack([axis.acceleration for axis in axes]),
            yaw_pitch_roll_rad=np.column_stack([self.yaw.value, self.pitch.value, self.roll.value]),
            angular_rate_radps=np.column_stack(rate),
        )
