"""How a knee moved: it never rests, so its path is tied to its foot's in every gait cycle."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

from gaitlab.motion import ikizoglu2018
from gaitlab.motion.foot import method_motion
from gaitlab.motion.integration import position_of
from gaitlab.motion.model import FootMotion, Indices, KneeMotion, Motion
from gaitlab.motion.orientation import OrientationSource
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True)
class KneeParams:
    """Weights of the knee's correction.

    Attributes
    ----------
    step_sd_m : float
        How far the knee's displacement in a gait cycle may lie from the foot's step length in mid-walk; measured
        against optical knees: 0.02.
    edge_step_sd_m : float
        The same for the first and the last cycle, where the person starts from and comes to standing: measured
        0.05–0.16.
    drift_mps2 : float
        Acceleration error that lasts about a second: what a tilt of half a degree makes of gravity.
    standing_margin_s : float
        A standing knee is taken to be still until this long before its foot leaves the ground.
    standing_velocity_sd_mps : float
        How still.
    """

    step_sd_m: float = 0.02
    edge_step_sd_m: float = 0.1
    drift_mps2: float = 0.08
    standing_margin_s: float = 0.8
    standing_velocity_sd_mps: float = 0.02


@dataclass(frozen=True, eq=False)
class Cycles:
    """Gait cycles of a foot in the rows of its knee: from leaving one rest to leaving the next.

    ``start``, ``end`` (m,) rows; ``step_m`` (m, 3) the foot's displacement; ``edge`` (m,) True for the first and
    last.
    """

    start: Indices
    end: Indices
    step_m: Floats
    edge: Floats

    def __len__(self) -> int:
        return len(self.start)


def cycles_of(foot: FootMotion, n_rows: int, shift: int) -> Cycles:
    """Gait cycles that lie wholly within the knee's ``n_rows``; knee row = foot row + ``shift``.

    The last rest of a recording is not left again; the foot's coming to it closes the last cycle.
    """
    leaving = np.maximum(foot.rests.end - 1, foot.rests.start) + shift
    if len(leaving):
        leaving[-1] = foot.rests.start[-1] + shift
    steps = np.diff(foot.rest_position_m, axis=0)
    start, end = leaving[:-1], leaving[1:]
    inside = (start >= 0) & (end < n_rows) & (end > start)
    edge = np.zeros(len(start))
    if len(edge):
        edge[[0, -1]] = 1.0
    return Cycles(start[inside], end[inside], steps[inside], edge[inside])


def heading_against_foot(
    raw_position_m: Floats, cycles: Cycles, standing: list[tuple[int, int]], rate_hz: float
) -> float:
    """Angle in radians by which the knee's horizontal axes must be turned to the left to agree with its foot's.

    From cycle to cycle knee and foot change their mean velocity alike: at the start, in a turn, at the stop. With the
    horizontal plane as complex numbers and Δ from one cycle to the next, ΔV_foot = z·ΔV_knee + b·Δt, b a constant
    drift; the angle is that of z. It needs no magnetometer and holds for any place on the leg. Standing spans count
    as cycles of no movement.
    """
    spans = [(a, b, 0j) for a, b in standing]
    spans += [
        (int(a), int(b), complex(s[0], s[1]))
        for a, b, s in zip(cycles.start, cycles.end, cycles.step_m, strict=True)
    ]
    spans.sort(key=lambda span: span[0])
    first, last, step = (np.array(column) for column in zip(*spans, strict=True))
    plane = raw_position_m[:, 0] + 1j * raw_position_m[:, 1]
    duration = (last - first) / rate_hz
    knee, foot = (plane[last] - plane[first]) / duration, step / duration
    middle = 0.5 * (first + last) / rate_hz
    design = np.stack([np.diff(knee), np.diff(middle).astype(complex)], axis=1)
    if len(design) < 2:
        return float(np.angle(np.sum(foot * np.conj(knee))))
    z = np.linalg.lstsq(design, np.diff(foot), rcond=None)[0][0]
    return float(np.angle(z))


def standing_spans(foot: FootMotion, n_rows: int, shift: int, params: KneeParams) -> list[tuple[int, int]]:
    """Rows ``[start, end]`` of each second in which the person stands before the first and after the last cycle."""
    rate_hz = foot.rate_hz
    margin, second = round(params.standing_margin_s * rate_hz), round(rate_hz)
    rests = foot.rests
    spans = []
    for start, end in (
        (rests.start[0], rests.end[0] - margin),
        (rests.start[-1] + margin, rests.end[-1]),
    ):
        low, high = max(0, int(start) + shift), min(n_rows - 1, int(end) + shift)
        n_seconds = (high - low) // second
        if n_seconds < 1:
            continue
        borders = np.linspace(low, high, n_seconds + 1).round().astype(int)
        spans += [(int(x), int(y)) for x, y in itertools.pairwise(borders)]
    return spans


def correct_velocity(
    raw_velocity_mps: Floats,
    cycles: Cycles,
    standing: list[tuple[int, int]],
    rate_hz: float,
    params: KneeParams,
) -> Floats:
    """Knee velocity whose drift, linear between the cycles' borders, is the likeliest under three statements.

    The knee goes as far in each cycle as its foot (loosely in the first and last), it is still while the person
    stands, and the drift changes slowly. A banded least-squares problem in the drift at the borders, solved once
    for all axes.

    Source: the statement is İkizoğlu et al. 2018, §3.3. Deviations: the drift is continuous instead of constant per
    cycle, edge cycles count less, standing is used.
    """
    borders = np.unique(
        np.concatenate([cycles.start, cycles.end, [row for span in standing for row in span]])
    )
    at = {int(row): k for k, row in enumerate(borders)}
    raw_position = position_of(raw_velocity_mps, rate_hz)
    n = len(borders)
    band, right = np.zeros((2, n)), np.zeros((n, 3))

    def add(i: int, j: int, ci: float, cj: float, value: Floats | float, sd: float) -> None:
        weight = 1.0 / sd**2
        band[1, i] += weight * ci * ci
        band[1, j] += weight * cj * cj
        band[0, j] += weight * ci * cj
        right[i] += weight * ci * value
        right[j] += weight * cj * value

    steps = np.diff(borders) / rate_hz
    for k, duration in enumerate(steps):
        add(k, k + 1, -1.0, 1.0, 0.0, params.drift_mps2 * float(duration))
    for start, end, step, edge in zip(cycles.start, cycles.end, cycles.step_m, cycles.edge, strict=True):
        i, j = at[int(start)], at[int(end)]
        excess = raw_position[end] - raw_position[start] - step
        sd = params.edge_step_sd_m if edge else params.step_sd_m
        if j == i + 1:
            half = 0.5 * float(steps[i])
            add(i, j, half, half, excess, sd)
    for start, end in standing:
        for row in (start, end):
            k = at[int(row)]
            weight = 1.0 / params.standing_velocity_sd_mps**2
            band[1, k] += weight
            right[k] += weight * raw_velocity_mps[row]
    drift = solveh_banded(band, right)
    rows = np.arange(len(raw_velocity_mps))
    taken: Floats = np.stack([np.interp(rows, borders, drift[:, k]) for k in range(3)], axis=1)
    return raw_velocity_mps - taken


def track_knee(
    sensor: Sensor,
    time_s: Floats,
    foot: FootMotion,
    shift: int,
    method: str = "gaitlab",
    source: OrientationSource | None = None,
) -> KneeMotion:
    """Reconstruct how a knee moved, in the world frame of its foot.

    Parameters
    ----------
    sensor : Sensor
        Of the knee (or anywhere on shank or thigh).
    foot : FootMotion
        Of the same side.
    shift : int
        Knee row = foot row + shift.
    method : str
        ``gaitlab``, or ``ikizoglu2018`` for a constant velocity offset per cycle.
    """
    free = method_motion(sensor, time_s, method, source)
    params = KneeParams()
    cycles = cycles_of(foot, free.n_samples, shift)
    if not len(cycles):
        return _knee_motion(free, free.raw_velocity_mps, cycles)
    standing = standing_spans(foot, free.n_samples, shift, params)
    yaw = heading_against_foot(free.raw_position_m, cycles, standing, free.rate_hz)
    free = free.turned(yaw)
    if method == "ikizoglu2018":
        pairs = [(int(a), int(b)) for a, b in zip(cycles.start, cycles.end, strict=True)]
        velocity = ikizoglu2018.correct_knee(free.raw_velocity_mps, pairs, cycles.step_m, free.rate_hz)
        return _knee_motion(free, velocity, cycles)
    velocity = correct_velocity(free.raw_velocity_mps, cycles, standing, free.rate_hz, params)
    return _knee_motion(free, velocity, cycles, velocity[cycles.start])


def _knee_motion(free: Motion, velocity: Floats, cycles: Cycles, started: Floats | None = None) -> KneeMotion:
    """``started`` (m, 3): velocity with which each cycle really began; None: the uncorrected one."""
    raw = free.raw_position_m
    excess = raw[cycles.end] - raw[cycles.start] - cycles.step_m
    if started is not None:  # a velocity that was wrong when the cycle began is no fault of the cycle
        carried = free.raw_velocity_mps[cycles.start] - started
        excess = excess - carried * ((cycles.end - cycles.start) / free.rate_hz)[:, None]
    residual = np.linalg.norm(excess[:, :2], axis=1)
    kept = vars(free) | {"velocity_mps": velocity, "position_m": position_of(velocity, free.rate_hz)}
    return KneeMotion(**kept, cycle_start=cycles.start, cycle_end=cycles.end, residual_m=residual)
