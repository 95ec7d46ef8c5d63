"""Static offsets of accelerometer and gyroscope from standing that is found, not assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import Indices, Offsets
from gaitlab.recording.model import Bools, Floats, Sensor

STANDARD_GRAVITY_MPS2 = 9.80665  # CODATA; local gravity differs from it by at most 0.3 %


@dataclass(frozen=True)
class StandingParams:
    """When a second counts as standing.

    Attributes
    ----------
    duration_s : float
        Least length; İkizoğlu et al. 2018, §3.2.
    step_s : float
        Windows begin so far apart.
    preferred_start_s : float
        Where the paper takes its second, from the start of the recording.
    max_rate_sd_radps, max_acc_sd_mps2 : float
        Largest scatter of gyroscope and accelerometer (norm of the axes' standard deviations) of a foot that stands.
        MTw noise alone gives 0.008 and 0.03; the 92 feet of ``mtw-10m-walk`` stay below 0.021 and 0.07 in their
        quietest second, a foot in the flat of a slow stance does not.
    alike, always_quiet : float
        Seconds with up to this many times the scatter of the quietest, or up to this share of the largest that still is
        standing, are as quiet as it.
    most_lost_share : float
        A second that lost more of its rows shows no standing; some real ones lost a quarter of theirs.
    sway_rad : float
        How far a standing foot turns between the beginning and the end of a stretch of standing.
    unknown_drift_radps : float
        Standard uncertainty of a gyroscope's offset that was not seen standing.
    """

    duration_s: float = 1.0
    step_s: float = 0.05
    preferred_start_s: float = 2.0
    max_rate_sd_radps: float = 0.06
    max_acc_sd_mps2: float = 0.2
    alike: float = 2.0
    always_quiet: float = 0.3
    most_lost_share: float = 0.4
    sway_rad: float = 0.01
    unknown_drift_radps: float = 0.005


def _scatter(values: Floats, block: int, blocks: int) -> Floats:
    """Norm over the axes of the standard deviation in each window of ``blocks`` blocks of rows, by its first block."""
    whole = len(values) // block * block
    columns = np.ascontiguousarray(values[:whole].T) - values.mean(axis=0)[:, None]
    square = np.einsum("ij,ij->j", columns, columns)
    running = np.zeros((4, whole // block + 1))
    np.cumsum(columns.reshape(3, -1, block).sum(axis=2), axis=1, out=running[:3, 1:])
    np.cumsum(square.reshape(-1, block).sum(axis=1), out=running[3, 1:])
    sums = (running[:, blocks:] - running[:, :-blocks]) / (block * blocks)
    variance = sums[3] - np.einsum("ij,ij->j", sums[:3], sums[:3])
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def find_standing(
    acc: Floats,
    gyr: Floats,
    rate_hz: float,
    params: StandingParams | None = None,
    received: Bools | None = None,
) -> tuple[int, int, bool]:
    """Find the stretch of at least a second in which the sensor stands still.

    Returns
    -------
    start, end : int
        Its rows ``[start, end)``: the longest run of still seconds about as quiet as its quietest; where there is none, the
        quietest second.
    standing : bool
        False where even the quietest second is not standing.
    """
    p = params or StandingParams()
    block = max(1, round(p.step_s * rate_hz))
    blocks = min(len(acc) // block, max(2, round(p.duration_s * rate_hz / block)))
    if blocks < 1:
        return 0, len(acc), False
    gyr_sd, acc_sd = _scatter(gyr, block, blocks), _scatter(acc, block, blocks)
    unrest = np.maximum(gyr_sd / p.max_rate_sd_radps, acc_sd / p.max_acc_sd_mps2)
    if (
        received is not None and not received.all()
    ):  # a lost row repeats another, and what is repeated looks still
        whole = len(received) // block * block
        lost = np.concatenate([[0], np.cumsum((~received[:whole]).reshape(-1, block).sum(axis=1))])
        share = (lost[blocks:] - lost[:-blocks]) / (block * blocks)
        unrest = np.where(share > p.most_lost_share, np.maximum(unrest, 2.0), unrest)
    runs = _runs(unrest <= 1.0)
    if not len(runs):
        start = int(np.argmin(unrest))
        return start * block, (start + blocks) * block, False
    quiet = [_quiet_part(unrest, int(low), int(high), p) for low, high in runs]
    start, end = max(quiet, key=lambda run: run[1] - run[0])
    return start * block, (end - 1 + blocks) * block, True


def _runs(marked: Bools) -> Indices:
    """First row and row after the last of each run of marked rows, shape (k, 2)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(np.int8)))
    return edges.reshape(-1, 2)


def _quiet_part(unrest: Floats, low: int, high: int, p: StandingParams) -> tuple[int, int]:
    """The part of a run around its quietest second in which the seconds are about as quiet."""
    quietest = low + int(np.argmin(unrest[low:high]))
    limit = max(p.alike * float(unrest[quietest]), p.always_quiet)
    over = np.flatnonzero(unrest[low:high] > limit) + low
    before, after = over[over < quietest], over[over > quietest]
    return int(before[-1]) + 1 if len(before) else low, int(after[0]) if len(after) else high


def find_offsets(sensor: Sensor, acc: Floats, gyr: Floats, params: StandingParams | None = None) -> Offsets:
    """Offsets of a sensor: gyroscope mean, and what the accelerometer reads beside one standard gravity, while
    standing.

    Where nobody stands still, neither offset can be told from movement, and both are left at zero: the orientation filter
    still estimates the gyroscope's, the smoother the accelerometer's.

    Source: İkizoğlu et al. 2018, §3.2 (mean over 2–3 s). Deviations: (1) the offset is taken in the sensor's frame,
    where it is constant, not in the world's; (2) gravity's size is part of it: of 92 real sensors 48 read more than
    10.0 m/s² at rest; (3) the gyroscope's offset is removed as well; (4) the whole longest stretch of standing counts: a
    standing foot still turns by ± 0.01 rad, so that 4 s tell the offset four times better than one.
    """
    p = params or StandingParams()
    rate_hz = sensor.rate_hz
    start, end, standing = find_standing(acc, gyr, rate_hz, p, sensor.received)
    mean_acc = acc[start:end].mean(axis=0)
    size = float(np.linalg.norm(mean_acc))
    acc_offset = mean_acc * (1.0 - STANDARD_GRAVITY_MPS2 / size) if standing and size > 0 else np.zeros(3)
    gyr_offset = gyr[start:end].mean(axis=0) if standing else np.zeros(3)
    drift_sd = p.sway_rad * rate_hz / (end - start) if standing else p.unknown_drift_radps
    a, g = acc_offset.tolist(), gyr_offset.tolist()
    paper = p.preferred_start_s * rate_hz
    as_in_paper = standing and start <= paper and paper + p.duration_s * rate_hz <= end
    return Offsets(start, end, (a[0], a[1], a[2]), (g[0], g[1], g[2]), standing, size, drift_sd, as_in_paper)
