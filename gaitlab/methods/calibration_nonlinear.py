"""Nonlinear models between a measured and a reference displacement: nonlinear ARX, Hammerstein–Wiener, a network.

İkizoğlu et al. (2018), §2.2 and table 2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.signal import lfilter

from gaitlab.methods.calibration_linear import (
    FREE_RUN,
    FREE_RUN_OF_TWO,
    PAPER,
    SIMULATED,
    STABLE,
    Orders,
    Search,
    identify,
    inside,
    marquardt,
    shifted,
)
from gaitlab.methods.calibration_model import Calibration, Fitted, Goodness, calibration
from gaitlab.methods.constants import constant, constants_of
from gaitlab.methods.model import Constant, Method, Need, Question
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class NarxParams:
    """Regressors y(t − 1), y(t − 2), u(t − 1), u(t − 2), and the units of the nonlinear part."""

    na: int = constant(2, "", "table 2")
    nb: int = constant(2, "", "table 2")
    nk: int = constant(1, "samples", "table 2")
    units: int = constant(4, "", "ours: the paper does not name its nonlinear regression")
    decay: float = constant(
        0.01, "", "ours: weight of the parameters' mean square beside the mean squared error"
    )

    @property
    def size(self) -> int:
        """How many parameters there are."""
        return self.na + self.nb + 1 + self.units * (self.na + self.nb + 2)


@dataclass(frozen=True)
class HammersteinWienerParams:
    """Orders of the linear block and pieces of the two nonlinear ones."""

    nb: int = constant(2, "", "table 2")
    nf: int = constant(3, "", "table 2")
    nk: int = constant(1, "samples", "table 2")
    pieces: int = constant(10, "", "table 2")
    decay: float = constant(0.01, "", "ours: as for the network; keeps pieces that saw no data straight")


@dataclass(frozen=True)
class NetworkParams:
    """A network that sees the newest samples of the measured signal."""

    first: int = constant(8, "neurons", "§2.2")
    second: int = constant(4, "neurons", "§2.2")
    lags: int = constant(
        3, "samples", "ours: u(t) to u(t − 2), as far back as the small models; §2.2 names none"
    )
    decay: float = constant(
        0.01, "", "ours: weight of the parameters' mean square beside the mean squared error"
    )
    seed: int = constant(2018, "", "ours: the first weights are drawn")


def _trained(
    errors: Callable[[Floats], Floats],
    start: Floats,
    decay: float,
    rest: Floats,
    gradient: Callable[[Floats], Floats] | None = None,
) -> Floats:
    """Parameters of least mean squared error and ``decay`` times their mean square from ``rest``."""
    pull = np.sqrt(decay / len(start))

    def cost(parameters: Floats) -> Floats:
        error = errors(parameters)
        return np.concatenate([error / np.sqrt(len(error)), pull * (parameters - rest)])

    def slopes(parameters: Floats) -> Floats:
        assert gradient is not None
        rows = gradient(parameters)
        return np.concatenate([rows / np.sqrt(len(rows)), pull * np.eye(len(parameters))])

    return marquardt(cost, start, slopes if gradient is not None else None)[0]


# ------------------------------------------------------------------------------------------------ nonlinear ARX


def narx(measured: Floats, reference: Floats, train: int) -> Calibration:
    """y(t) = L·x(t) + l + Σ αᵢ tanh(βᵢ·x(t) + γᵢ) with x = y(t − 1), y(t − 2), u(t − 1), u(t − 2).

    Trained on one-step predictions, as the linear models are; in the free run its own outputs take the place of y. The
    linear part begins as the ARX model and is kept stable; the units are bounded.
    """
    p = NarxParams()

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        x = np.column_stack([*(shifted(y[:train], k) for k in range(1, p.na + 1)), _inputs(u, p)[:train]])
        linear = np.linalg.lstsq(np.column_stack([x, np.ones(train)]), y[:train], rcond=None)[0]

        def errors(parameters: Floats) -> Floats:
            free, units = _split(_tamed(parameters, p)[None, :], p)
            inner = np.tanh(x @ units[0, :, :-2].T + units[0, :, -2])
            return np.asarray(x @ free[0, :-1] + free[0, -1] + inner @ units[0, :, -1] - y[:train])

        found = _tamed(_trained(errors, *_narx_start(linear, p)), p)
        return found, _narx_run(found[None, :], _inputs(u, p), p)[0]

    return calibration(measured, reference, train, Search().rows_each * p.size, fit)


def narx_free_run(measured: Floats, reference: Floats, train: int) -> Calibration:
    """The same model with the least squared errors of the free run itself, from the linear one of that kind on."""
    p = NarxParams()

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        b1, b2, f1, f2, level = identify(u[:train], y[:train], FREE_RUN_OF_TWO)
        linear = np.array([-f1, -f2, b1, b2, level * (1.0 + f1 + f2)])
        inputs = _inputs(u, p)

        def errors(parameters: Floats) -> Floats:
            return np.asarray(_narx_run(parameters[None, :], inputs[:train], p)[0] - y[:train])

        def gradient(parameters: Floats) -> Floats:
            step = Search().step
            moved = np.concatenate([parameters[None, :], parameters + step * np.eye(p.size)])
            runs = _narx_run(moved, inputs[:train], p)
            return np.asarray((runs[1:] - runs[0]).T / step)

        found = _trained(errors, *_narx_start(linear, p), gradient)
        return found, _narx_run(found[None, :], inputs, p)[0]

    return calibration(measured, reference, train, Search().rows_each * p.size, fit)


def _inputs(u: Floats, p: NarxParams) -> Floats:
    return np.stack([shifted(u, p.nk + k) for k in range(p.nb)], axis=1)


def _narx_start(linear: Floats, p: NarxParams) -> tuple[Floats, float, Floats]:
    """Where the training begins, how strongly it is drawn, and where to: the linear model."""
    drawn = np.random.default_rng(p.units).normal(0.0, 0.1, p.size - len(linear))
    return np.concatenate([linear, drawn]), p.decay, np.concatenate([linear, np.zeros(len(drawn))])


def _split(parameters: Floats, p: NarxParams) -> tuple[Floats, Floats]:
    """Linear part with its constant, (k, 5), and units (β, γ, α), (k, units, 6), of k models."""
    n = p.na + p.nb
    return parameters[:, : n + 1], parameters[:, n + 1 :].reshape(len(parameters), p.units, n + 2)


def _tamed(parameters: Floats, p: NarxParams) -> Floats:
    """The parameters with the linear part made stable."""
    poles = inside(np.concatenate([[1.0], -parameters[: p.na]]))
    return np.concatenate([-poles[1:], parameters[p.na :]])


def _narx_run(parameters: Floats, inputs: Floats, p: NarxParams) -> Floats:
    """Free runs of k models from rest, shape (k, n). Each output is needed for the next, so it goes sample by sample, but
    through all models at once; a run that runs away is held at the bound."""
    linear, units = _split(parameters, p)
    of_inputs = inputs @ linear[:, p.na : -1].T + linear[:, -1]
    in_units = np.einsum("tj,kuj->tku", inputs, units[:, :, p.na : -2]) + units[:, :, -2]
    own, own_units, weight = linear[:, : p.na], units[:, :, : p.na], units[:, :, -1]
    past, bound = np.zeros((len(parameters), p.na)), 2.0 * Goodness().away
    run = np.zeros((len(inputs), len(parameters)))
    for t in range(len(inputs)):
        inner = np.tanh(in_units[t] + (own_units * past[:, None, :]).sum(axis=2))
        now = of_inputs[t] + (own * past).sum(axis=1) + (weight * inner).sum(axis=1)
        run[t] = np.minimum(np.maximum(now, -bound), bound)
        past = np.column_stack([run[t], past[:, :-1]])
    return np.ascontiguousarray(run.T)


# ------------------------------------------------------------------------------------------------ Hammerstein–Wiener


def hammerstein_wiener(measured: Floats, reference: Floats, train: int) -> Calibration:
    """y = h(B(q)/F(q)·f(u(t − 1))) with f and h linear in ten pieces each.

    f and h begin as the identity, so the model begins as the linear one; the knots divide the range of the training
    part evenly, and the outermost pieces go on beyond it. The first piece of each has slope 1: the gain is B's.
    """
    p = HammersteinWienerParams()
    linear = Orders(nb=p.nb, nf=p.nf, nk=p.nk)
    n_bends = p.pieces - 1

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        start = identify(u[:train], y[:train], linear)
        first = _linear_block(start[:-1], u[:train], p)
        knots_in, knots_out = _knots(u[:train], p.pieces), _knots(first, p.pieces)
        bends_in = _hinges(u, knots_in)

        def run(parameters: Floats, n: int) -> Floats:
            block, level, f, h = np.split(parameters, np.cumsum([p.nb + p.nf, 1, n_bends]))
            middle = _linear_block(block, u[:n] + bends_in[:n] @ f, p)
            return np.asarray(middle + level + _hinges(middle, knots_out) @ h)

        begin = np.concatenate([start, np.zeros(2 * n_bends)])
        found = _trained(lambda v: run(v, train) - y[:train], begin, p.decay, begin)
        return found, run(found, len(u))

    return calibration(measured, reference, train, Search().rows_each * (p.nb + p.nf + 1 + 2 * n_bends), fit)


def _linear_block(parameters: Floats, u: Floats, p: HammersteinWienerParams) -> Floats:
    b, f = parameters[: p.nb], parameters[p.nb :]
    stable = inside(np.concatenate([[1.0], f]))
    return np.asarray(lfilter(np.concatenate([np.zeros(p.nk), b]), stable, u))


def _knots(values: Floats, pieces: int) -> Floats:
    """Where the pieces meet."""
    return np.linspace(values.min(), values.max(), pieces + 1)[1:-1]


def _hinges(values: Floats, knots: Floats) -> Floats:
    """What a bend of slope 1 at each knot adds, shape (n, k); nothing at 0, so that rest stays rest."""
    return np.asarray(np.maximum(values[:, None] - knots, 0.0) - np.maximum(-knots, 0.0))


# ------------------------------------------------------------------------------------------------ network


def network(measured: Floats, reference: Floats, train: int) -> Calibration:
    """Two hidden layers of 8 and 4 tanh neurons and a linear output, trained by Levenberg–Marquardt.

    It sees u(t), u(t − 1), u(t − 2) and knows nothing beyond the range of the training part.
    """
    p = NetworkParams()
    sizes = (p.lags, p.first, p.second, 1)
    count = sum((before + 1) * after for before, after in pairwise(sizes))

    def fit(u: Floats, y: Floats, train: int) -> Fitted:
        middle, spread = u[:train].mean(), u[:train].std()
        x = np.stack([shifted((u - middle) / spread, k) for k in range(p.lags)], axis=1)
        rng = np.random.default_rng(p.seed)
        start = np.concatenate(
            [
                rng.normal(0.0, 1.0 / np.sqrt(before + 1), (before + 1) * after)
                for before, after in pairwise(sizes)
            ]
        )
        found = _trained(
            lambda v: forward(v, x[:train], sizes) - y[:train],
            start,
            p.decay,
            np.zeros(count),
            lambda v: gradient(v, x[:train], sizes),
        )
        return found, forward(found, x, sizes)

    return calibration(measured, reference, train, count, fit)


def forward(parameters: Floats, x: Floats, sizes: Sequence[int]) -> Floats:
    """Output of the network to inputs, shape (n, sizes[0])."""
    seen, weights = _layers(parameters, x, sizes)
    return np.asarray((seen[-1] @ weights[-1])[:, 0])


def gradient(parameters: Floats, x: Floats, sizes: Sequence[int]) -> Floats:
    """Derivatives of the output to each parameter, shape (n, p), by going back through the layers."""
    parts: list[Floats] = []
    back = np.ones((len(x), 1))
    for seen, weights in reversed(list(zip(*_layers(parameters, x, sizes), strict=True))):
        parts.insert(0, (seen[:, :, None] * back[:, None, :]).reshape(len(x), -1))
        back = (back @ weights[:-1].T) * (1.0 - seen[:, :-1] ** 2)
    return np.concatenate(parts, axis=1)


def _layers(parameters: Floats, x: Floats, sizes: Sequence[int]) -> tuple[list[Floats], list[Floats]]:
    """What each layer sees, its constant 1 last, and its weights."""
    seen, weights = [np.column_stack([x, np.ones(len(x))])], []
    at = 0
    for before, after in pairwise(sizes):
        weights.append(parameters[at : at + (before + 1) * after].reshape(before + 1, after))
        at += weights[-1].size
        seen.append(np.column_stack([np.tanh(seen[-1] @ weights[-1]), np.ones(len(x))]))
    return seen[:-1], weights


# ------------------------------------------------------------------------------------------------ catalogue

UNITS = "The paper does not name its nonlinear regression: a linear part and four tanh units."
SEEN = "What the network saw is not said: the three newest samples of the measured signal."
DECAY = "A small weight on the squares of the parameters stands for the early stop of MATLAB's training."
STRAIGHT = (
    "Bends of the pieces are drawn to none by a small weight, so that a piece without data stays straight."
)


def _method(
    name: str,
    title: str,
    where: str,
    constants: tuple[Constant, ...],
    run: Callable[[Floats, Floats, int], Calibration],
    *deviations: str,
) -> Method:
    needs = (Need.ACCELEROMETER, Need.REFERENCE)
    return Method(name, Question.CALIBRATION, title, where, needs, constants, (*deviations, FREE_RUN), run)


METHODS = (
    _method("nonlinear_arx", "nonlinear ARX", PAPER, constants_of(NarxParams()), narx, UNITS, DECAY, STABLE),
    _method(
        "nonlinear_arx_free_run",
        "nonlinear ARX, free run",
        PAPER,
        constants_of(NarxParams()),
        narx_free_run,
        UNITS,
        DECAY,
        SIMULATED,
    ),
    _method(
        "hammerstein_wiener",
        "Hammerstein–Wiener",
        PAPER,
        constants_of(HammersteinWienerParams()),
        hammerstein_wiener,
        STRAIGHT,
    ),
    _method(
        "network",
        "network of 8 and 4 neurons",
        "İkizoğlu et al. 2018, §2.2",
        constants_of(NetworkParams()),
        network,
        SEEN,
        DECAY,
    ),
)
