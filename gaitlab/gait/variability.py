"""How much a person's strides vary: the observed scatter without the part that the measurement adds."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gaitlab.gait import definitions as d
from gaitlab.gait.lengths import NO_FOOT, ONE_FOOT, independent_sd
from gaitlab.gait.measurement import (
    TWO_SIDED_95,
    Definition,
    MeasuredSide,
    Measurement,
    measured,
    not_determinable,
)
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timing import EventErrors, double_supports, phases_of, runs_of
from gaitlab.recording.model import Bools, Floats, Side


@dataclass(frozen=True)
class VariabilityParams:
    """When a scatter is given as a person's variability.

    Attributes
    ----------
    min_strides : int
        Of each foot. A coefficient of variation is stable from about 20 strides on (Front Aging Neurosci 2018 00435);
        one timed 25-foot walk has 5 or 6, so trials are pooled.
    edge_strides : int
        Strides left out at either end of a straight part. In ``mtw-10m-walk`` the second stride from standing takes
        7 % longer than those in the middle and the last but one before a stop is 6 % shorter; the third from either
        end differs by 1 % or less.
    jitter_spread : float
        Relative standard uncertainty of the measurement's own standard deviation: between the people of ``mtw-10m-walk``
        the scatter of initial contact against the hand-checked ones differs by this much.
    """

    min_strides: int = 20
    edge_strides: int = 2
    jitter_spread: float = 0.33


@dataclass(frozen=True)
class Spread:
    """Scatter of one quantity over the strides of a foot: all that pooling needs.

    Attributes
    ----------
    n, freedom : int
        Strides, and degrees of freedom of the variance: n − 1 in one trial.
    mean : float
        Mean of the strides; 1 where the variances are relative to it.
    variance : float
        Observed variance.
    measurement_variance : float
        What the measurement is expected to have added to it.
    """

    n: int
    freedom: int
    mean: float
    variance: float
    measurement_variance: float

    @property
    def relative(self) -> Spread:
        """The same with variances relative to the square of the mean."""
        square = self.mean**2 or 1.0
        return Spread(self.n, self.freedom, 1.0, self.variance / square, self.measurement_variance / square)


Spreads = Mapping[str, Mapping[Side, Spread]]
"""By the parameter's name and the side."""
PARAMETERS = (d.STRIDE_TIME_CV, d.STRIDE_LENGTH_CV, d.STRIDE_VELOCITY_CV, d.DOUBLE_SUPPORT_SD)


def spread_of(values: Floats, sd: Floats | float, mean_sd: float | None = None) -> Spread:
    """Scatter of ``values`` (n,) whose measurement errors have the standard deviations ``sd``, (n,) or one for all.

    Errors eᵢ are expected to add n/(n − 1)·(mean of uᵢ² − u²(mean of e)) to the variance: what moves all values alike
    scatters none. ``mean_sd`` is u(mean of e); by default that of errors that do not know of each other, which add the
    mean of uᵢ².
    """
    n = len(values)
    if n < 2:
        return Spread(n, 0, float(values.mean()) if n else 0.0, 0.0, 0.0)
    own = float(np.mean(np.broadcast_to(np.asarray(sd, dtype=np.float64) ** 2, (n,))))
    of_mean = own / n if mean_sd is None else mean_sd**2
    added = max(own - of_mean, 0.0) * n / (n - 1)
    return Spread(n, n - 1, float(values.mean()), float(values.var(ddof=1)), added)


def pooled(spreads: Sequence[Spread]) -> Spread:
    """The same quantity of the same foot in several trials: variances weighted by their degrees of freedom.

    Each trial scatters around its own mean; how far the trials lie apart is no variability of strides.
    """
    known = [one for one in spreads if one.freedom > 0]
    freedom = sum(one.freedom for one in known)
    if not freedom:
        return Spread(sum(one.n for one in spreads), 0, 0.0, 0.0, 0.0)
    n = sum(one.n for one in known)
    return Spread(
        n,
        freedom,
        sum(one.n * one.mean for one in known) / n,
        sum(one.freedom * one.variance for one in known) / freedom,
        sum(one.freedom * one.measurement_variance for one in known) / freedom,
    )


def pooled_cv(trials: Sequence[tuple[Floats, Floats | float]]) -> Spread:
    """Scatter relative to each trial's mean, pooled over trials of (values, standard deviations of their errors)."""
    return pooled([spread_of(values, sd).relative for values, sd in trials])


def of_feet(left: Spread, right: Spread) -> Spread:
    """Both feet together, √((SD_L² + SD_R²)/2), with the counts of the foot that has fewer strides.

    Strides of the two feet overlap in time; that the second foot adds nothing new keeps the interval on the safe side.
    """
    return Spread(
        min(left.n, right.n),
        min(left.freedom, right.freedom),
        0.5 * (left.mean + right.mean),
        0.5 * (left.variance + right.variance),
        0.5 * (left.measurement_variance + right.measurement_variance),
    )


def variance_interval(spread: Spread, level: float, params: VariabilityParams) -> tuple[float, float]:
    """Interval of the person's own variance at a two-sided level: the observed one's (χ²) less the measurement's.

    The two uncertainties are joined by the method of variance estimates recovery (Zou and Donner 2008, Stat Med
    27:1693): distances of the limits from the estimate are added in squares.
    """
    from scipy.special import chdtri, ndtri  # heavy; most recordings have too few strides for it

    tail, nu = 0.5 * (1.0 - level), spread.freedom
    low, high = (nu * spread.variance / float(chdtri(nu, share)) for share in (tail, 1.0 - tail))
    relative = 2.0 * params.jitter_spread * float(ndtri(1.0 - tail))
    own = spread.measurement_variance
    estimate = spread.variance - own
    below = math.hypot(spread.variance - low, relative * own)
    above = math.hypot(high - spread.variance, relative * own)
    return estimate - below, estimate + above


def scatter(
    definition: Definition, side: MeasuredSide, spread: Spread, params: VariabilityParams | None = None
) -> Measurement:
    """A person's variability with its interval; not determinable below ``min_strides``, or where the strides scatter no
    more than the measurement explains: then the reason says below what it lies.
    """
    p = params or VariabilityParams()
    if spread.n < p.min_strides or spread.freedom < 2:
        strides = f"{spread.n} stride{'' if spread.n == 1 else 's'}{' of each foot' if side is MeasuredSide.BOTH else ''}"
        reason = (
            f"There are {strides} in mid-walk, where at least {p.min_strides} are needed; trials of a session are pooled"
            " in its report."
        )
        return not_determinable(definition, side, reason, spread.n)
    size = 1.0 if definition is d.DOUBLE_SUPPORT_SD else 100.0
    low, high = (size * math.sqrt(max(v, 0.0)) for v in variance_interval(spread, 0.95, p))
    if low <= 0.0:
        bound = size * math.sqrt(max(variance_interval(spread, 0.90, p)[1], spread.variance))
        reason = (
            f"The strides scatter by {size * math.sqrt(spread.variance):.1f} %, not above what the measurement itself"
            f" explains ({size * math.sqrt(spread.measurement_variance):.1f} %): the variability lies, with 95 %"
            f" certainty, below {bound:.1f} %."
        )
        return not_determinable(definition, side, reason, spread.n)
    value = size * math.sqrt(spread.variance - spread.measurement_variance)
    sd = (high - low) / (2.0 * TWO_SIDED_95)
    return replace(measured(definition, side, value, sd, spread.n), interval=(low, high))


def _inner(foot: FootGait, params: VariabilityParams) -> Bools:
    """Strides that have ``edge_strides`` others before and after them in their straight part."""
    inner = np.zeros(len(foot), dtype=np.bool_)
    for part in range(int(foot.part.max(initial=-1)) + 1):
        inner[np.flatnonzero(foot.part == part)[params.edge_strides : -params.edge_strides]] = True
    return inner


def spreads_of(feet: Mapping[Side, FootGait], params: VariabilityParams | None = None) -> Spreads:
    """Scatter of the strides in mid-walk of each foot that was recorded; relative but for the double support."""
    p = params or VariabilityParams()
    found: dict[str, dict[Side, Spread]] = {one.name: {} for one in PARAMETERS}
    for side, foot in feet.items():
        own = phases_of(foot)
        own = own.only(_inner(foot, p)[own.index])
        errors = EventErrors.at(foot.motion.rate_hz)
        time_sd, n = math.sqrt(2.0) * errors.contact_sd_s, max(len(own.index), 1)
        time_mean_sd = time_sd * math.sqrt(runs_of(own.index)) / n
        length, length_sd = foot.length_m[own.index], independent_sd(foot)[own.index]
        velocity = length / own.stride_s
        velocity_sd = np.hypot(length_sd, time_sd * velocity) / own.stride_s
        found[d.STRIDE_TIME_CV.name][side] = spread_of(own.stride_s, time_sd, time_mean_sd).relative
        found[d.STRIDE_LENGTH_CV.name][side] = spread_of(length, length_sd).relative
        found[d.STRIDE_VELOCITY_CV.name][side] = spread_of(velocity, velocity_sd).relative
        if side.other in feet:
            share, usable = double_supports(own, feet[side.other])
            stance_sd = math.hypot(errors.contact_sd_s, errors.off_sd_s)
            share_sd = 100.0 * math.sqrt(2.0) * stance_sd / own.stride_s[usable]
            found[d.DOUBLE_SUPPORT_SD.name][side] = spread_of(share, share_sd)
    return found


def variability(found: Spreads, params: VariabilityParams | None = None) -> list[Measurement]:
    """Left, right and both of each parameter, from the ``spreads_of`` a trial or pooled ones of several."""
    measurements = []
    for definition in PARAMETERS:
        sides = found.get(definition.name, {})
        missing = [side for side in Side if side not in sides]
        for side in Side:
            which = MeasuredSide(side)
            if side in sides:
                measurements.append(scatter(definition, which, sides[side], params))
            else:
                measurements.append(not_determinable(definition, which, NO_FOOT.format(side=side)))
        if missing:
            reason = ONE_FOOT.format(side=missing[0])
            measurements.append(not_determinable(definition, MeasuredSide.BOTH, reason))
        else:
            both = of_feet(sides[Side.LEFT], sides[Side.RIGHT])
            measurements.append(scatter(definition, MeasuredSide.BOTH, both, params))
    return measurements
