"""Numbers that carry their first two time derivatives: velocities and accelerations exact by the chain rule.

A ``Jet`` is a quantity x(t) at many instants together with dx/dt and d²x/dt² (a truncated Taylor expansion).
Sums, products and smooth functions of jets are jets again; nothing is ever differenced numerically.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from gaitlab.recording.model import Floats


@dataclass(frozen=True, eq=False, slots=True)
class Jet:
    """A quantity at n instants with its first and second time derivative, each shape (n,)."""

    value: Floats
    rate: Floats
    acceleration: Floats

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(
                self.value + other.value, self.rate + other.rate, self.acceleration + other.acceleration
            )
        return Jet(self.value + other, self.rate, self.acceleration)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.rate, -self.acceleration)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet | float | Floats) -> Jet:
        if isinstance(other, Jet):
            return Jet(
                self.value * other.value,
                self.rate * other.value + self.value * other.rate,
                self.acceleration * other.value
                + 2.0 * self.rate * other.rate
                + self.value * other.acceleration,
            )
        return Jet(self.value * other, self.rate * other, self.acceleration * other)

    __radd__ = __add__
    __rmul__ = __mul__

    def through(self, value: Floats, slope: Floats, curvature: Floats) -> Jet:
        """Return f(self), given f, f′ and f″ at ``self.value``."""
        return Jet(value, slope * self.rate, slope * self.acceleration + curvature * self.rate**2)


def sin_cos(angle: Jet) -> tuple[Jet, Jet]:
    """Return sine and cosine of an angle in radians."""
    sine, cosine = np.sin(angle.value), np.cos(angle.value)
    return angle.through(sine, cosine, -sine), angle.through(cosine, -sine, -cosine)


@dataclass(frozen=True, eq=False)
class Track:
    """A twice continuously differentiable function of time made of quintic pieces; constant before and after.

    Two knots may not share an instant. Outside the knots the value stays as at the nearest one, so the first
    and the last knot should be at rest.
    """

    polynomial: PPoly

    @staticmethod
    def through(knots_s: Floats, value: Floats, rate: Floats, acceleration: Floats) -> Track:
        """Return the track with given value, rate and acceleration at each knot (quintic Hermite pieces).

        All arguments have shape (k,); ``knots_s`` increases strictly.
        """
        h = np.diff(knots_s)
        a = acceleration
        gap = value[1:] - value[:-1] - rate[:-1] * h - 0.5 * a[:-1] * h**2
        slip = (rate[1:] - rate[:-1] - a[:-1] * h) * h
        bend = (a[1:] - a[:-1]) * h**2
        coefficients = np.array(
            [
                (6.0 * gap - 3.0 * slip + 0.5 * bend) / h**5,
                (-15.0 * gap + 7.0 * slip - bend) / h**4,
                (10.0 * gap - 4.0 * slip + 0.5 * bend) / h**3,
                0.5 * a[:-1],
                rate[:-1],
                value[:-1],
            ]
        )
        return Track(PPoly(coefficients, knots_s))

    def __call__(self, t_s: Floats) -> Jet:
        """Evaluate at the instants ``t_s``, shape (n,)."""
        knots = self.polynomial.x
        t = np.clip(t_s, knots[0], knots[-1])
        inside = t == t_s
        value, rate, acceleration = (self.polynomial(t, nu) for nu in range(3))
        return Jet(value, np.where(inside, rate, 0.0), np.where(inside, acceleration, 0.0))
