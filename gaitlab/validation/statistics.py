"""Figures of a sample of errors; NaN where there are too few."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.recording.model import Floats
from gaitlab.validation.model import Figure

CM, MM, M, MS, PERCENT = (
    ("cm", 100.0, 2),
    ("mm", 1000.0, 1),
    ("m", 1.0, 3),
    ("ms", 1000.0, 1),
    ("%", 100.0, 1),
)
"""Unit, how many of it are in one SI unit, decimals."""
Unit = tuple[str, float, int]


def figure(name: str, value: float, unit: Unit, *, signed: bool = False) -> Figure:
    """One figure from a value in SI units."""
    label, scale, decimals = unit
    return Figure(name, value * scale, label, decimals, signed)


def mean_and_sd(errors: Sequence[float] | Floats, unit: Unit) -> tuple[Figure, Figure]:
    """Signed mean and standard deviation (n − 1)."""
    values = np.asarray(errors, dtype=np.float64)
    mean = float(values.mean()) if len(values) else float("nan")
    sd = float(values.std(ddof=1)) if len(values) > 1 else float("nan")
    return figure("mean", mean, unit, signed=True), figure("SD", sd, unit)


def mean_absolute(errors: Sequence[float] | Floats, unit: Unit) -> Figure:
    """Mean absolute error."""
    values = np.abs(np.asarray(errors, dtype=np.float64))
    return figure("MAE", float(values.mean()) if len(values) else float("nan"), unit)


def median_and_p95(values: Sequence[float] | Floats, unit: Unit) -> tuple[Figure, Figure]:
    """Median and 95th percentile (linear between the order statistics)."""
    known = np.asarray(values, dtype=np.float64)
    median, p95 = np.percentile(known, (50, 95)) if len(known) else (float("nan"), float("nan"))
    return figure("median", float(median), unit), figure("P95", float(p95), unit)


def share(name: str, count: int, of: int) -> Figure:
    """A count as a share in percent."""
    return figure(name, count / of if of else float("nan"), PERCENT)
