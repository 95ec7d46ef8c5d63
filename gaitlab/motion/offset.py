"""Static offsets of accelerometer and gyroscope from a standing second that is found, not assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from gaitlab.motion.model import Offsets
from gaitlab.recording.model import Floats, Sensor

STANDARD_GRAVITY_MPS2 = 9.80665  # CODATA; local gravity differs from it by at most 0.3 %


@dataclass(frozen=True)
class StandingParams:
    """When a second counts as standing.

    Attributes
    ----------
    duration_s : float
        Length of the window; İkizoğlu et al. 2018, §3.2.
    preferred_start_s : float
        Where the paper takes it, from the start of the recording.
    max_rate_sd_radps, max_acc_sd_mps2 : float
        Largest scatter of gyroscope and accelerometer (norm of the axes' standard deviations) of a foot that stands.
        MTw noise alone gives 0.008 and 0.03; the 92 feet of ``mtw-10m-walk`` stay below 0.021 and 0.07 in their
        quietest second, a foot in the flat of a slow stance does not.
    """

    duration_s: float = 1.0
    preferred_start_s: float = 2.0
    max_rate_sd_radps: float = 0.06
    max_acc_sd_mps2: float = 0.2


def _scatter(values: Floats, width: int) -> Floats:
    """Norm over the axes of the standard deviation in each window of ``width`` rows, by the window's first row."""
    centred = values - values.mean(axis=0)
    mean = uniform_filter1d(centred, width, axis=0, mode="nearest")
    square = uniform_filter1d(centred**2, width, axis=0, mode="nearest")
    variance = np.maximum(square - mean**2, 0.0).sum(axis=1)
    half = width // 2
    scatter: Floats = np.sqrt(variance[half : half + len(values) - width + 1])
    return scatter


def find_standing(
    acc: Floats, gyr: Floats, rate_hz: float, params: StandingParams | None = None
) -> tuple[int, int, bool]:
    """Find the second in which the sensor stands stillest.

    Returns
    -------
    start, end : int
        Its rows ``[start, end)``: the paper's (2 s to 3 s) where the foot stands then, else the quietest of the
        recording.
    standing : bool
        False where even the quietest second is not standing.
    """
    p = params or StandingParams()
    width = min(len(acc), max(2, round(p.duration_s * rate_hz)))
    rate_sd, acc_sd = _scatter(gyr, width), _scatter(acc, width)
    unrest = np.maximum(rate_sd / p.max_rate_sd_radps, acc_sd / p.max_acc_sd_mps2)
    preferred = round(p.preferred_start_s * rate_hz)
    start = preferred if preferred < len(unrest) and unrest[preferred] <= 1.0 else int(np.argmin(unrest))
    return start, start + width, bool(unrest[start] <= 1.0)


def find_offsets(sensor: Sensor, acc: Floats, gyr: Floats, params: StandingParams | None = None) -> Offsets:
    """Offsets of a sensor: gyroscope mean, and what the accelerometer reads beside one standard gravity, while
    standing.

    Where nobody stands still, the gyroscope's offset cannot be told from movement and is left at zero (the
    orientation filter still estimates it), and the accelerometer's is taken from the quietest second.

    Source: İkizoğlu et al. 2018, §3.2 (mean over 2–3 s). Deviations: (1) the offset is taken in the sensor's frame,
    where it is constant, not in the world's; (2) gravity's size is part of it: of 92 real sensors 48 read more than
    10.0 m/s² at rest; (3) the gyroscope's offset is removed as well; (4) the second is searched for.
    """
    start, end, standing = find_standing(acc, gyr, sensor.rate_hz, params)
    mean_acc = acc[start:end].mean(axis=0)
    size = float(np.linalg.norm(mean_acc))
    acc_offset = mean_acc * (1.0 - STANDARD_GRAVITY_MPS2 / size) if size > 0 else np.zeros(3)
    gyr_offset = gyr[start:end].mean(axis=0) if standing else np.zeros(3)
    a, g = acc_offset.tolist(), gyr_offset.tolist()
    as_in_paper = start == round((params or StandingParams()).preferred_start_s * sensor.rate_hz)
    return Offsets(start, end, (a[0], a[1], a[2]), (g[0], g[1], g[2]), standing, size, as_in_paper)
