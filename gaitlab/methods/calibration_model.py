"""What a calibration against a reference displacement gives, and how its goodness of fit is counted.

İkizoğlu et al. (2018), §2.2 and table 2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Floats

NOT_GIVEN = "measured and reference have to be equally long and finite throughout"
TOO_SHORT = "the training part is too short for the model"
NO_MOVEMENT = "measured or reference does not change in the training part"
UNSTABLE = "the identified model runs away when it is left to itself"


@dataclass(frozen=True, eq=False)
class Calibration:
    """What a model makes of a measured signal after it was trained on the first part of it.

    Attributes
    ----------
    prediction : ndarray (n,)
        The reference as the model gives it from the measured signal alone, in the reference's unit; NaN where it failed.
    train : int
        Rows ``[0, train)`` were used for training.
    fit_train_percent, fit_test_percent : float
        ``goodness_of_fit`` on the training rows and on the others; NaN where not determinable.
    parameters : ndarray (p,)
        What was identified, in the model's own order, for signals scaled as in ``scaled``.
    reason : str
        Why nothing was determined; empty where it was.
    """

    prediction: Floats
    train: int
    fit_train_percent: float
    fit_test_percent: float
    parameters: Floats
    reason: str = ""


@dataclass(frozen=True)
class Goodness:
    """``away``: a free run that leaves so many times the spread of the training reference has run away."""

    away: float = 1e3


Fitted = tuple[Floats, Floats]
"""A model's parameters and its free run over all rows, scaled as it was trained."""


def goodness_of_fit(reference: Floats, prediction: Floats) -> float:
    """100·(1 − ‖y − ŷ‖/‖y − mean(y)‖) in percent, as MATLAB's ``compare``: 100 is perfect, 0 no better than the mean.

    NaN where the reference does not change or there are fewer than two rows.
    """
    if len(reference) < 2:
        return float("nan")
    spread = float(np.linalg.norm(reference - reference.mean()))
    if not spread > 0.0:
        return float("nan")
    return 100.0 * (1.0 - float(np.linalg.norm(reference - prediction)) / spread)


def calibration(
    measured: Floats,
    reference: Floats,
    train: int,
    needed: int,
    fit: Callable[[Floats, Floats, int], Fitted],
) -> Calibration:
    """Train a model and let it run freely over all rows.

    Both signals count from their first row, where the foot stands, and are scaled by their spread in the training part.
    The run uses the reference nowhere, not even for its start: what a sensor alone would give. (``compare`` fits the
    initial state to the part it is shown.)

    Parameters
    ----------
    measured, reference : ndarray (n,)
    train : int
        The first so many rows are for training.
    needed : int
        Fewest training rows that the model can do with.
    fit : callable
        Scaled measured signal, scaled reference and ``train`` to parameters and free run.
    """
    measured, reference = np.asarray(measured, dtype=float), np.asarray(reference, dtype=float)
    given = measured.ndim == 1 and measured.shape == reference.shape
    if not given or not (np.isfinite(measured).all() and np.isfinite(reference).all()):
        return _failed(reference, train, NOT_GIVEN)
    train = min(train, len(reference))
    if train < needed:
        return _failed(reference, train, TOO_SHORT)
    spread_in, spread_out = float(measured[:train].std()), float(reference[:train].std())
    if not (spread_in > 0.0 and spread_out > 0.0):
        return _failed(reference, train, NO_MOVEMENT)
    parameters, run = fit(
        (measured - measured[0]) / spread_in, (reference - reference[0]) / spread_out, train
    )
    if not np.isfinite(run).all() or np.abs(run).max() > Goodness().away:
        return _failed(reference, train, UNSTABLE)
    prediction = reference[0] + spread_out * run
    return Calibration(
        prediction,
        train,
        goodness_of_fit(reference[:train], prediction[:train]),
        goodness_of_fit(reference[train:], prediction[train:]),
        parameters,
    )


def _failed(reference: Floats, train: int, reason: str) -> Calibration:
    nothing = float("nan")
    return Calibration(np.full(len(reference), nothing), train, nothing, nothing, np.zeros(0), reason)
