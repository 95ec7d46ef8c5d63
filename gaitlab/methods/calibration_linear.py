"""Linear models between a measured and a reference displacement: ARMAX, Box–Jenkins, state space, correlation.

İkizoğlu et al. (2018), table 2. All polynomial models are one: A(q)y = B(q)/F(q)·u + C(q)/D(q)·e, identified by the least
squares of its one-step prediction errors e (Ljung, System Identification, 2nd ed., §7.2 and 10.2). That is a dozen lines
on SciPy; the libraries that know these models either bring a solver of several hundred megabytes or lack most of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.signal import lfilter

from gaitlab.methods.calibration_model import Calibration, Fitted, calibration
from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.model import Constant, Method, Need, Question
from gaitlab.recording.model import Floats

PAPER = "İkizoğlu et al. 2018, §2.2, table 2"


@dataclass(frozen=True)
class Orders:
    """Orders of the polynomials; the input acts after ``nk`` samples."""

    na: int = constant(0, "", "table 2")
    nb: int = constant(0, "", "table 2")
    nc: int = constant(0, "", "table 2")
    nd: int = constant(0, "", "table 2")
    nf: int = constant(0, "", "table 2")
    nk: int = constant(1, "samples", "table 2")

    @property
    def size(self) -> int:
        """How many parameters there are, with the output's level."""
        return self.na + self.nb + self.nc + self.nd + self.nf + 1


ARMAX = Orders(na=2, nb=2, nc=2)
BOX_JENKINS = Orders(nb=4, nf=4, nc=4, nd=4)
STATE_SPACE = Orders(na=4, nb=4, nc=4)
FREE_RUN_OF_TWO = Orders(nb=2, nf=2)
FREE_RUN_OF_FOUR = Orders(nb=4, nf=4)


@dataclass(frozen=True)
class CorrelationParams:
    """Lags of the correlation models, in samples.

    Attributes
    ----------
    m, n : int
        As in the paper.
    least_share : float
        Directions of the lagged inputs in which they move less than this share of the largest are left out: a smooth
        displacement's neighbouring samples are all but equal.
    """

    m: int = constant(20, "samples", "table 2")
    n: int = constant(10, "samples", "table 2")
    least_share: float = constant(1e-4, "", "ours: neighbouring samples of a smooth signal are all but equal")


FADING = 0.5
"""Poles of a start whose input fades quickly: halved with every sample."""


@dataclass(frozen=True)
class Search:
    """How long a search may be.

    Attributes
    ----------
    rows_each : int
        Training rows wanted for every parameter.
    evaluations : int
        Most steps of the search; MATLAB's networks stop after as many.
    tolerance : float
        Relative change of cost or parameters that ends it.
    step : float
        Of the differences, as a share of a parameter or of 1.
    """

    rows_each: int = 5
    evaluations: int = 100
    tolerance: float = 1e-6
    step: float = 1e-7


@dataclass(frozen=True, eq=False)
class Polynomials:
    """The five polynomials in q⁻¹, lowest power first, and the output's level."""

    a: Floats
    b: Floats
    c: Floats
    d: Floats
    f: Floats
    level: float

    def errors(self, u: Floats, y: Floats) -> Floats:
        """One-step prediction errors, from rest."""
        left = lfilter(self.a, [1.0], y - self.level) - lfilter(self.b, self.f, u)
        return np.asarray(lfilter(self.d, self.c, left))

    def run(self, u: Floats) -> Floats:
        """Output to an input without noise, from rest."""
        return np.asarray(self.level + lfilter(self.b, np.convolve(self.a, self.f), u))


def inside(polynomial: Floats) -> Floats:
    """The polynomial with the roots outside the unit circle reflected into it: stable, its gain the same but for a factor."""
    roots = np.roots(polynomial)
    size = np.abs(roots)
    if not (size > 1.0).any():
        return polynomial
    return np.asarray(np.poly(np.where(size > 1.0, roots / np.maximum(size, 1e-12) ** 2, roots)).real)


def polynomials(parameters: Floats, orders: Orders) -> Polynomials:
    """From the vector (a, b, c, d, f, level) to the model, A, C and F made stable."""
    sizes = (orders.na, orders.nb, orders.nc, orders.nd, orders.nf)
    a, b, c, d, f, level = np.split(parameters, np.cumsum(sizes))
    a, c, d, f = (np.concatenate([[1.0], one]) for one in (a, c, d, f))
    return Polynomials(
        inside(a), np.concatenate([np.zeros(orders.nk), b]), inside(c), d, inside(f), float(level[0])
    )


def identify(u: Floats, y: Floats, orders: Orders) -> Floats:
    """Parameters (a, b, c, d, f, level) with the least squared prediction errors.

    Levenberg–Marquardt of MINPACK, from each of ``_starts``; the best end counts.
    """
    ends = [
        marquardt(lambda parameters: polynomials(parameters, orders).errors(u, y), start)
        for start in _starts(u, y, orders)
    ]
    best = polynomials(min(ends, key=lambda end: end[1])[0], orders)
    rest = (best.a[1:], best.b[orders.nk :], best.c[1:], best.d[1:], best.f[1:], [best.level])
    return np.concatenate(rest)


def marquardt(
    errors: Callable[[Floats], Floats], start: Floats, gradient: Callable[[Floats], Floats] | None = None
) -> tuple[Floats, float]:
    """Where the squared errors are least by Levenberg–Marquardt, and their sum there.

    Parameters
    ----------
    errors, gradient : callable
        Parameters (p,) to errors (n,) and to their derivatives (n, p); without a gradient by differences.
    """
    search = Search()

    def bounded(parameters: Floats) -> Floats:
        return np.clip(errors(parameters), -1e6, 1e6)

    def differences(parameters: Floats) -> Floats:
        here = bounded(parameters)
        steps = search.step * np.maximum(np.abs(parameters), 1.0)
        moved = (bounded(parameters + step) - here for step in np.diag(steps))
        return np.stack([change / step for change, step in zip(moved, steps, strict=True)], axis=1)

    found = least_squares(
        bounded,
        start,
        jac=gradient or differences,
        method="lm",
        max_nfev=search.evaluations,
        ftol=search.tolerance,
        xtol=search.tolerance,
    )
    return np.asarray(found.x), 2.0 * float(found.cost)


def _starts(u: Floats, y: Floats, orders: Orders) -> list[Floats]:
    """Where to begin: the ARX model by least squares; and where the model has an F, also one whose input fades quickly,
    since the ARX model of a smooth signal is all past output. C and D begin at 1."""
    poles = orders.na or orders.nf
    inputs = np.stack([shifted(u, orders.nk + k) for k in range(orders.nb)], axis=1)
    outputs = np.stack([shifted(-y, k) for k in range(1, poles + 1)], axis=1)
    arx = np.linalg.lstsq(np.concatenate([outputs, inputs], axis=1), y, rcond=None)[0]
    noise, level = np.zeros(orders.nc + orders.nd), np.zeros(1)
    if orders.na:
        return [np.concatenate([arx, noise, level])]
    fading = np.asarray(np.poly(np.full(orders.nf, FADING)))
    faded = lfilter([1.0], fading, inputs, axis=0)
    zeros = np.linalg.lstsq(faded, y, rcond=None)[0]
    return [
        np.concatenate([arx[poles:], noise, arx[:poles], level]),
        np.concatenate([zeros, noise, fading[1:], level]),
    ]


def shifted(values: Floats, lag: int) -> Floats:
    """The values ``lag`` samples before (after, where negative); beyond the ends the last known one holds."""
    rows = np.clip(np.arange(len(values)) - lag, 0, len(values) - 1)
    return values[rows]


def _polynomial(measured: Floats, reference: Floats, train: int, orders: Orders) -> Calibration:
    """A polynomial model; its level, which prediction errors hardly know where the noise wanders, is that of the run."""

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        parameters = identify(u[:train], y[:train], orders)
        run = polynomials(parameters, orders).run(u)
        level = float(np.mean(y[:train] - run[:train]))
        parameters[-1] += level
        return parameters, run + level

    return calibration(measured, reference, train, Search().rows_each * orders.size, fit)


def armax(measured: Floats, reference: Floats, train: int) -> Calibration:
    """A(q)y(t) = B(q)u(t − 1) + C(q)e(t) with two coefficients each."""
    return _polynomial(measured, reference, train, ARMAX)


def box_jenkins(measured: Floats, reference: Floats, train: int) -> Calibration:
    """y(t) = B(q)/F(q)·u(t − 1) + C(q)/D(q)·e(t) with four coefficients each."""
    return _polynomial(measured, reference, train, BOX_JENKINS)


def state_space(measured: Floats, reference: Floats, train: int) -> Calibration:
    """x(t + 1) = Ax + Bu + Ke, y = Cx + e with four states, by prediction errors.

    In observer canonical form its matrices hold the coefficients of A(q)y = B(q)u + C(q)e, four each, one to one: that
    is what is identified.
    """
    return _polynomial(measured, reference, train, STATE_SPACE)


def armax_free_run(measured: Floats, reference: Floats, train: int) -> Calibration:
    """The input's part of the ARMAX model, B/A, with the least squared errors of the free run itself."""
    return _polynomial(measured, reference, train, FREE_RUN_OF_TWO)


def box_jenkins_free_run(measured: Floats, reference: Floats, train: int) -> Calibration:
    """The input's part of the Box–Jenkins model, B/F, with the least squared errors of the free run itself.

    The state space of four states has the same one.
    """
    return _polynomial(measured, reference, train, FREE_RUN_OF_FOUR)


def correlation(measured: Floats, reference: Floats, train: int) -> Calibration:
    """A₀y(t) = B₀u(t) + … + B_m u(t − m) + A₁y(t − 1) + … + A_n y(t − n), as printed, by least squares."""
    p = CorrelationParams()

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        lagged = [shifted(u[:train], k) for k in range(p.m + 1)]
        lagged += [shifted(y[:train], k) for k in range(1, p.n + 1)]
        parameters = _solve(np.stack([*lagged, np.ones(train)], axis=1), y[:train])
        inputs, outputs, level = np.split(parameters, [p.m + 1, p.m + 1 + p.n])
        poles = inside(np.concatenate([[1.0], -outputs]))
        return parameters, np.asarray(lfilter(inputs, poles, u) + lfilter(level, poles, np.ones(len(u))))

    return calibration(measured, reference, train, Search().rows_each * (p.m + p.n + 1), fit)


def correlation_two_sided(measured: Floats, reference: Floats, train: int) -> Calibration:
    """y(t) = Σ h_k u(t − k), k from −n to m: the impulse response on both sides of now, by least squares."""
    p = CorrelationParams()

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        lagged = np.stack([*(shifted(u, k) for k in range(-p.n, p.m + 1)), np.ones(len(u))], axis=1)
        whole = slice(0, train - p.n)  # rows whose later inputs still belong to the training part
        parameters = _solve(lagged[whole], y[whole])
        return parameters, np.asarray(lagged @ parameters)

    return calibration(measured, reference, train, Search().rows_each * (p.m + p.n + 1), fit)


def _solve(lagged: Floats, y: Floats) -> Floats:
    return np.asarray(np.linalg.lstsq(lagged, y, rcond=CorrelationParams().least_share)[0])


STABLE = "Roots outside the unit circle are reflected into it: left to itself an unstable model says nothing."
FREE_RUN = (
    "The fit is that of a free run over all rows from rest; MATLAB's compare fits the initial state to each part it is"
    " shown, which a sensor alone could not."
)
SIMULATED = (
    "Identified by the errors of the free run instead of one-step predictions: a smooth displacement is best predicted"
    " from its own past, and a model that leans on that says little of the sensor."
)
CANONICAL = "Identified in observer canonical form, which holds every observable model of four states once."
BOTH = "The printed equation; a two-sided impulse response of the same lags is the method beside it."
TWO_SIDED = (
    "Two-sided in the input instead of the printed outputs: n later samples of u for n earlier ones of y."
)


def _method(
    name: str,
    title: str,
    constants: tuple[Constant, ...],
    run: Callable[[Floats, Floats, int], Calibration],
    *deviations: str,
) -> Method:
    needs = (Need.ACCELEROMETER, Need.REFERENCE)
    return Method(name, Question.CALIBRATION, title, PAPER, needs, constants, (*deviations, FREE_RUN), run)


def _orders(orders: Orders) -> tuple[Constant, ...]:
    return tuple(one for one in constants_of(orders) if one.value)


METHODS = (
    _method("armax", "ARMAX", _orders(ARMAX), armax, STABLE),
    _method("box_jenkins", "Box–Jenkins", _orders(BOX_JENKINS), box_jenkins, STABLE),
    _method("state_space", "state space", _orders(STATE_SPACE), state_space, STABLE, CANONICAL),
    _method("armax_free_run", "ARMAX, free run", _orders(FREE_RUN_OF_TWO), armax_free_run, STABLE, SIMULATED),
    _method(
        "box_jenkins_free_run",
        "Box–Jenkins, free run",
        _orders(FREE_RUN_OF_FOUR),
        box_jenkins_free_run,
        STABLE,
        SIMULATED,
    ),
    _method("correlation", "correlation", constants_of(CorrelationParams()), correlation, STABLE, BOTH),
    _method(
        "correlation_two_sided",
        "two-sided impulse response",
        constants_of(CorrelationParams()),
        correlation_two_sided,
        TWO_SIDED,
    ),
)
