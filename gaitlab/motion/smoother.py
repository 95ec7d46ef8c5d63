"""Place, heading, tilt and accelerometer offset of a foot at all its rests, estimated together from all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.chain import ChainSolution, solve_chain
from gaitlab.motion.passages import Passages, tilting
from gaitlab.recording.model import Bools, Floats

PLACE, HEADING, DRIFT, TILT, OFFSET, FLOOR = slice(0, 3), 3, 4, slice(5, 7), slice(7, 10), 10
"""Parts of a state: place (3, m), heading error (rad), its drift (rad/s), tilt error (2, rad), accelerometer offset (3,
sensor, m/s²), height of the floor (m)."""

HEIGHT, SIZE = 2, 11


@dataclass(frozen=True)
class SmootherParams:
    """What is known before: standard deviations.

    Attributes
    ----------
    rest_speed_mps : float
        A resting foot is not quite still: the optical mid-foot moves at 0.014 to 0.025 m/s in the rests of
        ``mtw-leg-vicon``, marker noise included.
    level_sd_m : float
        Height of a sensor over the floor at its rests, about their mean.
    level_m : float
        A passage that ends higher or lower than this went up or down a step, and the floor is another one.
    slope_m : float
        What a passage over a level floor adds to the floor's height.
    gravity_sd_mps2, gravity_least_mps2 : float
        Mean acceleration of a foot in a rest of 0.2 s, and in a long one.
    tilt_walk_rad : float
        Error of tilt that a second adds: what the gyroscope's scale makes of a swing there and back.
    tilt_sd_rad : float
        Of the orientation that the smoother begins with.
    offset_sd_mps2, offset_along_sd_mps2 : float
        Accelerometer offset across gravity, and along it, where it was measured while standing.
    offset_walk_mps2, heading_walk_rad, drift_walk_radps : float
        What a second adds to accelerometer offset, heading and the heading's drift.
    strange : float
        A passage whose velocity is off by more than this many standard deviations is as uncertain as it is off.
    fastest_mps : float
        But no more uncertain than a walking foot's mean speed allows.
    """

    rest_speed_mps: float = 0.01
    level_sd_m: float = 0.01
    level_m: float = 0.07
    slope_m: float = 0.002
    gravity_sd_mps2: float = 0.10
    gravity_least_mps2: float = 0.02
    tilt_walk_rad: float = 0.005
    tilt_sd_rad: float = 0.05
    offset_sd_mps2: float = 0.2
    offset_along_sd_mps2: float = 0.03
    offset_walk_mps2: float = 1e-3
    heading_walk_rad: float = 2e-3
    drift_walk_radps: float = 1e-4
    strange: float = 3.0
    fastest_mps: float = 1.5


@dataclass(frozen=True, eq=False)
class Smoothed:
    """Estimates at the k rests of a foot.

    Attributes
    ----------
    place_m : ndarray (k, 3)
        From the first rest.
    heading_rad, tilt_rad, offset_mps2 : ndarray (k,), (k, 2), (k, 3)
        Corrections of the orientation (about the vertical and the horizontal axes of the world) and the offset.
    covariance : ndarray (k, 11, 11)
        Of the whole state.
    step_covariance : ndarray (k − 1, 3, 3)
        Of the way from each rest to the next.
    level : ndarray of bool (k − 1,)
        The floor was taken to be level between the two rests.
    strangeness : ndarray (k − 1,)
        RMS of the passage's velocity residual in standard deviations, before it was made to count less.
    """

    place_m: Floats
    heading_rad: Floats
    tilt_rad: Floats
    offset_mps2: Floats
    covariance: Floats
    step_covariance: Floats
    level: Bools
    strangeness: Floats


@dataclass(frozen=True)
class Fix:
    """A rest's place along a horizontal direction (unit vector), known from elsewhere, against the first rest's."""

    rest: int
    direction: tuple[float, float]
    place_m: float
    sd_m: float


@dataclass(frozen=True, eq=False)
class Known:
    """What the smoother is told besides the passages.

    Attributes
    ----------
    up : ndarray (3,)
        Direction of gravity in the sensor's axes while standing.
    stood : bool
        Its size was measured then.
    tilt_change_rad : ndarray (k − 1, 2)
        Turn about the horizontal axes from rest to rest that was taken out of the gyroscope's orientation to make it level.
    drift_sd_radps : float
        Of the gyroscope's offset about the vertical.
    rest_s : ndarray (k,)
        Durations of the rests.
    fixes : tuple of Fix
        What is known of places, if anything.
    """

    up: Floats
    stood: bool
    tilt_change_rad: Floats
    drift_sd_radps: float
    rest_s: Floats
    fixes: tuple[Fix, ...] = ()


def smooth(
    passages: Passages, known: Known, gravity_mps2: float, params: SmootherParams | None = None
) -> Smoothed:
    """Estimate all states at once by least squares; what is strange counts less, in a second pass.

    What is used: the foot is still at both ends of a passage; gravity points down in every rest; the floor is level
    between two rests unless the passage shows a step; tilt, heading and offsets change slowly.

    Ours, after the error-state smoothers of pedestrian navigation (Colomar, Nilsson and Händel 2012, "Smoothing for
    ZUPT-aided INSs", IPIN). It replaces the removal of drift in proportion to time (İkizoğlu et al. 2018, §3.2).
    """
    p = params or SmootherParams()
    level = np.abs(passages.displacement_m[:, 2]) < p.level_m
    doubt = np.ones(len(level))
    solution = _solve(passages, known, level, doubt, gravity_mps2, p)
    strangeness = _strangeness(passages, solution, p)
    if strangeness.max(initial=0.0) > p.strange:
        doubt = np.where(strangeness > p.strange, strangeness**2, 1.0)
        solution = _solve(passages, known, level, doubt, gravity_mps2, p)
    state = solution.state
    return Smoothed(
        state[:, PLACE],
        state[:, HEADING],
        state[:, TILT],
        state[:, OFFSET],
        solution.covariance,
        _of_steps(solution),
        level,
        strangeness,
    )


def _solve(
    passages: Passages, known: Known, level: Bools, doubt: Floats, gravity_mps2: float, p: SmootherParams
) -> ChainSolution:
    before, after, value, weight = _statements(passages, known, level, doubt, p)
    weighted_before, weighted_after = before * weight[..., None], after * weight[..., None]
    diagonal, right = _alone(passages, known, gravity_mps2, p)
    diagonal[:-1] += _t(before) @ weighted_before
    diagonal[1:] += _t(after) @ weighted_after
    right[:-1] += (_t(weighted_before) @ value[..., None])[..., 0]
    right[1:] += (_t(weighted_after) @ value[..., None])[..., 0]
    return solve_chain(diagonal, _t(before) @ weighted_after, right)


def _statements(
    passages: Passages, known: Known, level: Bools, doubt: Floats, p: SmootherParams
) -> tuple[Floats, Floats, Floats, Floats]:
    """What is said of the states before and after each passage: 14 rows of coefficients, values and weights.

    Rows: way (3), velocity (3), floor (1), tilt (2), heading (1), drift (1), offset (3).
    """
    n = len(level)
    before, after = np.zeros((n, 14, SIZE)), np.zeros((n, 14, SIZE))
    value, variance = np.zeros((n, 14)), np.empty((n, 14))
    way, apart = passages.displacement_m, passages.apart_s
    for rows, by in ((slice(0, 3), -passages.displacement_by), (slice(3, 6), passages.velocity_by)):
        before[:, rows, TILT], after[:, rows, TILT], before[:, rows, OFFSET] = (
            by[..., :2],
            by[..., 2:4],
            by[..., 4:],
        )
    before[:, [0, 1, 2], [0, 1, 2]], after[:, [0, 1, 2], [0, 1, 2]] = -1.0, 1.0
    for one in (before, after):
        one[:, 0, HEADING], one[:, 1, HEADING] = 0.5 * way[:, 1], -0.5 * way[:, 0]
    value[:, 0:3], value[:, 3:6] = way, -passages.velocity_mps
    moving = p.rest_speed_mps**2
    ends = passages.late_s**2 + (passages.duration_s - passages.late_s) ** 2
    way_var = doubt * (passages.displacement_var + moving * ends)
    variance[:, 0:3] = np.minimum(way_var, (p.fastest_mps * passages.duration_s) ** 2)[:, None]
    variance[:, 3:6] = (doubt * (passages.velocity_var + 2.0 * moving))[:, None]
    before[:, 6, FLOOR], after[:, 6, FLOOR] = -1.0, 1.0
    variance[:, 6] = np.where(level, p.slope_m**2, np.inf)
    pairs = [(7, 5, p.tilt_walk_rad), (8, 6, p.tilt_walk_rad), (9, HEADING, p.heading_walk_rad)]
    pairs += [(10, DRIFT, p.drift_walk_radps), *((11 + k, 7 + k, p.offset_walk_mps2) for k in range(3))]
    for row, column, walk in pairs:
        before[:, row, column], after[:, row, column] = -1.0, 1.0
        variance[:, row] = walk**2 * np.maximum(apart, 0.1)
    before[:, 9, DRIFT] = -apart
    value[:, 7:9] = -known.tilt_change_rad
    return before, after, value, 1.0 / variance


def _alone(passages: Passages, known: Known, gravity_mps2: float, p: SmootherParams) -> tuple[Floats, Floats]:
    """What is said of each state by itself: gravity in its rest, and what is known before."""
    k = len(passages.force_mps2)
    by = np.zeros((k, 3, SIZE))
    by[:, :, TILT], by[:, :, OFFSET] = tilting(passages.force_mps2), -passages.rotation
    value = np.array([0.0, 0.0, gravity_mps2]) - passages.force_mps2
    sd = np.maximum(p.gravity_least_mps2, p.gravity_sd_mps2 * np.sqrt(0.2 / np.maximum(known.rest_s, 0.05)))
    weighted = by / (sd**2)[:, None, None]
    diagonal = _t(by) @ weighted
    right = (_t(weighted) @ value[..., None])[..., 0]
    diagonal[:, [5, 6], [5, 6]] += p.tilt_sd_rad**-2.0
    floor = np.ix_(range(k), (HEIGHT, FLOOR), (HEIGHT, FLOOR))
    diagonal[floor] += np.array([[1.0, -1.0], [-1.0, 1.0]]) / p.level_sd_m**2
    along = np.outer(known.up, known.up)
    along_sd = p.offset_along_sd_mps2 if known.stood else p.offset_sd_mps2
    first = diagonal[0]
    first[OFFSET, OFFSET] += along / along_sd**2 + (np.eye(3) - along) / p.offset_sd_mps2**2
    first[[0, 1, 2], [0, 1, 2]] += 1e12
    first[HEADING, HEADING] += 1e12
    first[DRIFT, DRIFT] += known.drift_sd_radps**-2.0
    for fix in known.fixes:
        direction = np.array(fix.direction)
        diagonal[fix.rest, :2, :2] += np.outer(direction, direction) / fix.sd_m**2
        right[fix.rest, :2] += direction * (fix.place_m / fix.sd_m**2)
    return diagonal, right


def _strangeness(passages: Passages, solution: ChainSolution, p: SmootherParams) -> Floats:
    """RMS over the axes of what is left of the velocity, in standard deviations."""
    state, by = solution.state, passages.velocity_by
    left = passages.velocity_mps + np.einsum("kij,kj->ki", by[..., :2], state[:-1, TILT])
    left += np.einsum("kij,kj->ki", by[..., 2:4], state[1:, TILT])
    left += np.einsum("kij,kj->ki", by[..., 4:], state[:-1, OFFSET])
    variance = passages.velocity_var + 2.0 * p.rest_speed_mps**2
    strangeness: Floats = np.sqrt(np.mean(left**2, axis=1) / variance)
    return strangeness


def _of_steps(solution: ChainSolution) -> Floats:
    """Covariance of the way from each rest to the next, shape (k − 1, 3, 3)."""
    place, cross = solution.covariance[:, PLACE, PLACE], solution.cross[:, PLACE, PLACE]
    covariance: Floats = place[:-1] + place[1:] - cross - _t(cross)
    return covariance


def _t(matrices: Floats) -> Floats:
    return np.swapaxes(matrices, -1, -2)
