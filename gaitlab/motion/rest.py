"""Rests of a foot: one in every gait cycle, whatever the pace, the size of the movement or the sensor's mounting."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.extrema import prominent_peaks
from gaitlab.motion.model import Indices, Rests
from gaitlab.motion.moving import moving_maximum, moving_mean
from gaitlab.motion.windows import refined
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class RestParams:
    """Tuning of ``find_rests``; every number is a share of what the recording itself shows, so it fits no one group.

    Tuned on ``mtw-10m-walk`` (46 trials, 1,523 hand-checked stances).

    Attributes
    ----------
    window_cycles : float
        Length of the moving RMS, as a share of the gait cycle.
    floor : float
        Unrest below this share of a typical swing's is equally quiet.
    prominence : float
        A rest is quieter than what lies on either side of it by at least this factor.
    swing : float
        Between two rests the unrest reaches at least this share of a typical swing's; else the two are one rest.
    rim : float
        A rest reaches as far as the unrest stays below ``rim`` times its least value (or times the floor). Beyond, the foot
        already rolls: at twice the least the optical foot of ``mtw-leg-vicon`` moves at 3 cm/s, a centimetre a stride.
    cycle_range_s : tuple of float
        Shortest and longest gait cycle looked for.
    cycle_rate_hz : float
        The gait cycle is looked for in means over whole rows, at this rate or somewhat more.
    default_cycle_s : float
        Gait cycle assumed where the signal has no period.
    min_swing_rate_radps : float
        Below this typical peak of the angular rate nothing is a swing: nobody walks. A shuffling foot reaches 1
        rad/s.
    """

    window_cycles: float = 0.15
    floor: float = 0.05
    prominence: float = 3.0
    swing: float = 0.15
    rim: float = 1.4
    cycle_range_s: tuple[float, float] = (0.5, 3.0)
    cycle_rate_hz: float = 40.0
    default_cycle_s: float = 1.1
    min_swing_rate_radps: float = 0.5


def _moving_rms(values: Floats, width: int) -> Floats:
    squares = moving_mean(_squares(values), width)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def _squares(vectors: Floats) -> Floats:
    """Squared length of each row, shape (n,)."""
    x, y, z = np.ascontiguousarray(vectors.T)
    return np.asarray(x * x + y * y + z * z)


def cycle_time(rate_radps: Floats, rate_hz: float, params: RestParams | None = None) -> float | None:
    """Duration of the gait cycle in seconds from the autocorrelation of the size of the angular rate, shape (n, 3).

    None where it has no period, as when nobody walks.
    """
    p = params or RestParams()
    block = max(1, int(rate_hz / p.cycle_rate_hz))
    hz = rate_hz / block
    size = np.sqrt(_squares(rate_radps))
    size = size[: len(size) // block * block].reshape(-1, block).mean(axis=1)
    longest = min(len(size) - 1, round(p.cycle_range_s[1] * hz))
    shortest = round(p.cycle_range_s[0] * hz)
    if longest <= shortest + 2:
        return None
    activity = moving_mean(size, max(1, round(hz)))
    active = activity > 0.3 * _quantile(activity, 0.95)
    signal = np.where(active, size - size[active].mean() if active.any() else 0.0, 0.0)
    n_fft = 1 << (len(signal) + longest - 1).bit_length()
    spectrum = np.fft.rfft(signal, n_fft)
    correlation = np.fft.irfft(spectrum.real**2 + spectrum.imag**2, n_fft)[: longest + 1]
    if correlation[0] <= 0:
        return None
    correlation = correlation / correlation[0] / (1.0 - np.arange(longest + 1) / len(signal))
    peaks = prominent_peaks(correlation[shortest:], 0.05) + shortest
    if not len(peaks) or correlation[peaks].max() <= 0:
        return None
    high = peaks[correlation[peaks] >= 0.8 * correlation[peaks].max()]
    return float(refined(correlation, high[:1])[0] / hz)


def _quantile(values: Floats, share: float) -> float:
    """Value that this share of the values does not exceed, without interpolation."""
    k = round(share * (len(values) - 1))
    return float(np.partition(values, k)[k])


def _typical_swing(level: Floats, distance: int) -> float:
    """Median of the peaks that are the highest within ``distance`` rows and not mere standing."""
    highest = moving_maximum(level, 2 * distance + 1)
    peaks = (level == highest) & (level >= 0.3 * _quantile(level, 0.98))
    return _quantile(level[peaks], 0.5) if peaks.any() else float(level.max(initial=0.0))


@dataclass(frozen=True, eq=False)
class Unrest:
    """How far each row is from rest, ``level`` (n,), and the rows of a gait cycle."""

    level: Floats
    cycle_rows: int


def unrest(
    acceleration_mps2: Floats, rate_radps: Floats, rate_hz: float, params: RestParams | None = None
) -> Unrest | None:
    """How far each row is from rest: about 1 in a typical swing, ``floor`` when still; None where nobody walks.

    u = √(½·(W/W̃)² + ½·(A/Ã)² + floor²), W and A the moving RMS of angular rate and free acceleration over a share
    of the gait cycle, W̃ and Ã their medians over the swings' peaks.
    """
    p = params or RestParams()
    cycle = cycle_time(rate_radps, rate_hz, p) or p.default_cycle_s
    width = max(3, round(p.window_cycles * cycle * rate_hz))
    distance = max(1, round(0.6 * cycle * rate_hz))
    turning, moving = _moving_rms(rate_radps, width), _moving_rms(acceleration_mps2, width)
    typical_turning, typical_moving = _typical_swing(turning, distance), _typical_swing(moving, distance)
    if typical_turning < p.min_swing_rate_radps or typical_moving <= 0:
        return None
    level: Floats = np.sqrt(
        0.5 * (turning / typical_turning) ** 2 + 0.5 * (moving / typical_moving) ** 2 + p.floor**2
    )
    return Unrest(level, max(3, round(cycle * rate_hz)))


@dataclass(frozen=True)
class _Valley:
    """Valleys of the unrest with no swing between them: one rest. Rows of the first, the last and the deepest."""

    first: int
    last: int
    moment: int


def _one_per_cycle(level: Floats, params: RestParams) -> list[_Valley]:
    """Valleys of the unrest, one between every two swings."""
    candidates = prominent_peaks(-np.log(level), float(np.log(params.prominence)))
    if not len(candidates):
        return []
    depth = level[candidates].tolist()
    swings = np.maximum.reduceat(level, candidates).tolist()  # the highest from each candidate to the next
    kept = [_Valley(int(candidates[0]), int(candidates[0]), int(candidates[0]))]
    deepest = depth[0]
    for row, value, swing in zip(candidates[1:].tolist(), depth[1:], swings[:-1], strict=True):
        if swing >= params.swing:
            kept.append(_Valley(row, row, row))
            deepest = value
            continue
        one = kept[-1]
        kept[-1] = _Valley(one.first, row, row if value < deepest else one.moment)
        deepest = min(deepest, value)
    return kept


def _extents(level: Floats, valleys: list[_Valley], params: RestParams) -> tuple[Indices, Indices, Indices]:
    """First row, row after the last and quietest row of each rest: the stretch around each valley, no farther than
    the highest rows beside it, in which the unrest stays low."""
    first = np.array([valley.first for valley in valleys], dtype=np.intp)
    last = np.array([valley.last for valley in valleys], dtype=np.intp)
    moment = np.array([valley.moment for valley in valleys], dtype=np.intp)
    swings = [
        a + int(level[a:b].argmax()) for a, b in zip(last[:-1].tolist(), first[1:].tolist(), strict=True)
    ]
    borders = np.array([0, *swings, len(level)], dtype=np.intp)
    limit = params.rim * np.maximum(level[moment], params.floor)
    over = np.flatnonzero(level > np.repeat(limit, np.diff(borders)))
    over = np.concatenate([[-1], over, [len(level)]])
    start = over[np.searchsorted(over, first, "right") - 1] + 1
    end = over[np.searchsorted(over, last)]
    start = np.minimum(np.maximum(start, borders[:-1]), first)
    return start, np.maximum(np.minimum(end, borders[1:]), last + 1), moment


def find_rests(
    acceleration_mps2: Floats, rate_radps: Floats, rate_hz: float, params: RestParams | None = None
) -> Rests:
    """Find the rests of a foot from its free acceleration and angular rate, both shape (n, 3), any axes.

    Every gait cycle has one quietest moment: it is found as a valley of the unrest that is deep against both its
    neighbours, and the rest is the stretch around it that is nearly as quiet. Two valleys without a swing between
    them are one rest. Residual velocities are zero here; the velocity stage fills them in.

    Ours. It replaces İkizoğlu et al. 2018, §3.3 (``ikizoglu2018.find_rests``), which finds 5 % of the stances in
    ``mtw-10m-walk``.
    """
    return rests_in(unrest(acceleration_mps2, rate_radps, rate_hz, params), params)


def rests_in(found: Unrest | None, params: RestParams | None = None) -> Rests:
    """The rests that an unrest shows; none where nobody walks."""
    p = params or RestParams()
    valleys = [] if found is None else _one_per_cycle(found.level, p)
    if found is None or not valleys:
        return no_rests()
    start, end, moment = _extents(found.level, valleys, p)
    return Rests(start, end, moment, np.zeros((len(moment), 3)))


def no_rests() -> Rests:
    """No rest at all."""
    none = np.array([], dtype=np.intp)
    return Rests(none, none, none, np.zeros((0, 3)))


@dataclass(frozen=True, eq=False)
class RestEvidence:
    """How good each rest is; arrays of shape (k,).

    Attributes
    ----------
    duration_s : ndarray
        From its first row to the row after its last.
    gyr_sd_radps, acc_sd_mps2 : ndarray
        Spread within it: root of the summed variances of the three axes. NaN for a rest of one row.
    residual_mps : ndarray
        Size of what the velocity had drifted to since the end of the rest before; 0 for the first.
    implied_acc_error_mps2 : ndarray
        Constant error of the acceleration that would explain it: the residual over the time since the rest before.
        NaN for the first.
    """

    duration_s: Floats
    gyr_sd_radps: Floats
    acc_sd_mps2: Floats
    residual_mps: Floats
    implied_acc_error_mps2: Floats


def rest_evidence(
    acceleration_mps2: Floats, rate_radps: Floats, rests: Rests, rate_hz: float
) -> RestEvidence:
    """What the signals, both shape (n, 3) in any axes, show of each rest after ``reset_at_rests``."""
    residual = np.linalg.norm(rests.residual_mps, axis=1)
    since = np.full(len(rests), np.nan)
    since[1:] = (rests.start[1:] - np.maximum(rests.end - 1, rests.start)[:-1]) / rate_hz
    implied = np.divide(residual, since, out=np.full(len(rests), np.nan), where=since > 0.0)
    return RestEvidence(
        (rests.end - rests.start) / rate_hz,
        _spread(rate_radps, rests),
        _spread(acceleration_mps2, rests),
        residual,
        implied,
    )


def _spread(values: Floats, rests: Rests) -> Floats:
    """Root of the summed variances of the columns within each rest; NaN where it has fewer than two rows."""
    count = rests.end - rests.start
    spread = np.full(len(rests), np.nan)
    several = np.flatnonzero(count > 1)
    if not len(several):
        return spread
    n = count[several]
    first = np.cumsum(n) - n
    rows = np.arange(int(n.sum())) + np.repeat(rests.start[several] - first, n)
    inside = values[rows]
    mean = np.add.reduceat(inside, first, axis=0) / n[:, None]
    squares = ((inside - np.repeat(mean, n, axis=0)) ** 2).sum(axis=1)
    spread[several] = np.sqrt(np.add.reduceat(squares, first) / (n - 1))
    return spread


def restlessness(found: Unrest | None) -> float | None:
    """Median over the gait cycles of the least unrest in each: how near to rest a sensor ever comes; None where
    nobody walks.

    0.05 to 0.10 for the 92 feet of ``mtw-10m-walk`` (0.05 is the floor), 0.14 and more for shanks, ankles and
    thighs in ``mtw-leg-vicon``.
    """
    if found is None:
        return None
    level, cycle = found.level, found.cycle_rows
    active = np.flatnonzero(level > 0.3)
    if not len(active) or active[-1] - active[0] < cycle:
        return None
    walk = level[active[0] : active[-1] + 1]
    whole = len(walk) // cycle * cycle
    return float(np.median(walk[:whole].reshape(-1, cycle).min(axis=1)))
