"""An unscented Kalman filter for the orientation of any sensor from gyroscope and accelerometer, without magnetometer.

Bousdar Ahmed and Metzger 2017 (§II-C) name an unscented filter with roll, pitch and yaw, into whose prediction a
correction goes as a control; its details are in their reference [12], which we do not have. What is assumed:

- State: the turn from the gyroscope's own integral to the world (level, z up), a unit quaternion, and the
  gyroscope's offset left over, three entries. The world's axes for the error, so that no orientation is singular
  and any mounting will do; the paper's Euler angles are singular in a sitting person.
- Process: the integral of the gyroscope is right but for its offset and white noise; the offset walks.
- Measurement: the specific force, averaged over a block in the integral's axes, is gravity there plus the
  acceleration of the body, taken as noise as large as the force is away from gravity in that block.

The integral runs over all rows at once; the filter steps once a block, its 13 sigma points at once. Published
quaternion form of the transform: Crassidis and Markley 2003, "Unscented filtering for spacecraft attitude estimation".
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.methods.constants import constant
from gaitlab.motion import strapdown
from gaitlab.motion.model import Indices
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.quaternions import conjugate, matrices, midway, multiply
from gaitlab.recording.model import Floats

_OURS = "ours: reference [12] is not at hand"


@dataclass(frozen=True)
class UnscentedParams:
    """Sizes of what the filter does not know; all ours, none fitted to a recording.

    In ``mtw-leg-vicon`` the tilt against the optical thigh is 4.6° RMS whether the gyroscope's noise is 0.3 or 3 times
    as large, the force lasts 4 times as long or the blocks are half or twice as long.

    Attributes
    ----------
    block_s : float
        The force is heard so often; a gait cycle has ten.
    gyro_noise : float
        White noise of the angular rate: 0.1°/√s, ten times the data sheet of an MTw, for its scale is not exact and a
        sensor on a thigh sways on the skin.
    offset_walk : float
        Of the gyroscope's offset.
    offset_sd_radps : float
        Of the offset at the start, after the standing one was removed.
    force_sd_mps2 : float
        Of the mean force over a block while nothing moves: what is left of the accelerometer's offset.
    lasting_s : float
        How long an acceleration of the body keeps its sign: a quarter of a gait cycle.
    heading_sd_rad : float
        Bound of the heading's uncertainty, which nothing lessens.
    spread : float
        κ of the transform; the middle point has the weight κ/(n + κ).
    """

    block_s: float = constant(0.1, "s", _OURS)
    gyro_noise: float = constant(1.7e-3, "rad/s/√Hz", _OURS)
    offset_walk: float = constant(1e-4, "rad/s/√s", _OURS)
    offset_sd_radps: float = constant(3e-3, "rad/s", _OURS)
    force_sd_mps2: float = constant(0.1, "m/s²", _OURS)
    lasting_s: float = constant(0.25, "s", _OURS)
    heading_sd_rad: float = constant(0.5, "rad", "ours: √7 times it stays well below π")
    spread: float = constant(
        1.0, "1", "ours: κ of Julier and Uhlmann 1997, above 0 so that no weight is negative"
    )


@dataclass(frozen=True, eq=False)
class Blocks:
    """What m blocks of rows hold for the filter.

    Attributes
    ----------
    integral : ndarray (n, 4)
        Orientation of each row by the gyroscope alone, against row 0.
    edge : ndarray (m + 1,)
        First row of each block, and n.
    force_mps2 : ndarray (m, 3)
        Mean specific force in the integral's axes.
    force_sd_mps2 : ndarray (m,)
        How far from gravity it may be.
    lever_s : ndarray (m, 3, 3)
        What an offset of the gyroscope turns in the block, by entry, in the integral's axes.
    seconds : ndarray (m,)
    """

    integral: Floats
    edge: Indices
    force_mps2: Floats
    force_sd_mps2: Floats
    lever_s: Floats
    seconds: Floats


@dataclass(frozen=True, eq=False)
class Belief:
    """Turn from the integral to the world (4,), offset of the gyroscope (3,), covariance of both errors (6, 6)."""

    turn: Floats
    offset_radps: Floats
    covariance: Floats


def blocks_of(
    acc_mps2: Floats, gyr_radps: Floats, rate_hz: float, params: UnscentedParams | None = None
) -> Blocks:
    """Integrate the gyroscope and gather the force, for all rows at once."""
    p = params or UnscentedParams()
    n = len(gyr_radps)
    if not n:
        none = np.zeros(0)
        edge = np.zeros(1, dtype=np.intp)
        return Blocks(np.zeros((0, 4)), edge, np.zeros((0, 3)), none, np.zeros((0, 3, 3)), none)
    edge = np.append(np.arange(0, n, max(1, round(p.block_s * rate_hz))), n).astype(np.intp)
    count = np.diff(edge)
    integral = strapdown.integrate_rate(gyr_radps, rate_hz)
    middle = matrices(midway(integral, gyr_radps, rate_hz))
    first = edge[:-1]
    force = np.add.reduceat(strapdown.apply(middle, acc_mps2), first) / count[:, None]
    lever = np.add.reduceat(middle, first, axis=2).transpose(2, 0, 1) / rate_hz
    excess = np.sqrt(np.einsum("ij,ij->i", acc_mps2, acc_mps2)) - STANDARD_GRAVITY_MPS2
    moving = np.sqrt(np.add.reduceat(excess**2, first) / count)
    seconds = count / rate_hz
    alike = np.sqrt(np.maximum(1.0, p.lasting_s / seconds))
    return Blocks(integral, edge, force, alike * np.hypot(p.force_sd_mps2, moving), lever, seconds)


def first_belief(blocks: Blocks, params: UnscentedParams | None = None) -> Belief:
    """Level by the first block's force; the heading is that of the first row and known by definition."""
    p = params or UnscentedParams()
    force = blocks.force_mps2[:1] if len(blocks.force_mps2) else np.array([[0.0, 0.0, 1.0]])
    sd = blocks.force_sd_mps2[0] if len(blocks.force_sd_mps2) else 0.0
    if not np.any(force):
        force = np.array([[0.0, 0.0, 1.0]])
    tilt = min(float(sd) / STANDARD_GRAVITY_MPS2, 1.0)
    spread = np.array([tilt, tilt, 1e-6, *[p.offset_sd_radps] * 3])
    return Belief(strapdown.upright(force)[0], np.zeros(3), np.diag(spread**2))


def run(
    blocks: Blocks, belief: Belief, first: int, last: int, params: UnscentedParams | None = None
) -> tuple[Floats, Belief]:
    """Filter the blocks ``[first, last)``: the turn after each, shape (last − first, 4), and what is believed then."""
    p = params or UnscentedParams()
    turns = np.empty((last - first, 4))
    sds = blocks.force_sd_mps2.tolist()
    seconds = blocks.seconds.tolist()
    for j in range(first, last):
        belief = _stepped(belief, blocks.lever_s[j], seconds[j], blocks.force_mps2[j], sds[j], p)
        turns[j - first] = belief.turn
    return turns, belief


def attitudes(blocks: Blocks, turns: Floats, first: int = 0) -> Floats:
    """Orientation, sensor to world, of the rows of blocks from ``first`` on, by the turn after each block (k, 4)."""
    edge = blocks.edge[first : first + len(turns) + 1]
    if not len(turns):
        return np.zeros((0, 4))
    return multiply(np.repeat(turns, np.diff(edge), axis=0), blocks.integral[edge[0] : edge[-1]])


def controlled(belief: Belief, at: Floats, turn: Floats) -> Belief:
    """The belief after a control that turns the orientation in the sensor's own axes by ``turn`` (4,).

    ``at`` (4,) is the integral's orientation then: C′ = C·Δ with C = c·Q gives c′ = c·(Q·Δ·Q⁻¹).
    """
    moved = multiply(belief.turn, multiply(at, multiply(turn, conjugate(at))))
    return replace(belief, turn=moved / np.linalg.norm(moved))


def _stepped(
    belief: Belief, lever_s: Floats, seconds: float, force: Floats, sd: float, p: UnscentedParams
) -> Belief:
    """One block: sigma points of what was believed and of the block's noise, moved by the offset, and heard once."""
    size = 6
    noise = np.repeat([p.gyro_noise**2 * seconds, p.offset_walk**2 * seconds], 3)
    root = np.linalg.cholesky((size + p.spread) * (belief.covariance + np.diag(noise))).T
    errors = np.concatenate([np.zeros((1, size)), root, -root])
    weights = np.full((2 * size + 1, 1), 0.5 / (size + p.spread))
    weights[0] = p.spread / (size + p.spread)
    offsets = belief.offset_radps + errors[:, 3:]
    turns = multiply(strapdown.small_rotation(errors[:, :3]), belief.turn)
    turns = multiply(turns, strapdown.small_rotation(-offsets @ lever_s.T))
    moved = np.hstack([_vector(multiply(turns, conjugate(turns[0]))), offsets])
    mean = np.sum(weights * moved, axis=0)
    moved -= mean
    w, x, y, z = turns.T
    seen = np.stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], axis=1)
    seen *= STANDARD_GRAVITY_MPS2  # what the accelerometer of a still sensor reads, in the integral's axes
    expected = np.sum(weights * seen, axis=0)
    seen -= expected
    common = (weights * seen).T @ moved
    gain = np.linalg.solve((weights * seen).T @ seen + sd**2 * np.eye(3), common).T
    mean += gain @ (force - expected)
    covariance = (weights * moved).T @ moved - gain @ common
    turn = multiply(strapdown.small_rotation(mean[None, :3])[0], turns[0])
    return Belief(turn / np.linalg.norm(turn), mean[3:], _bounded(0.5 * (covariance + covariance.T), p))


def _bounded(covariance: Floats, p: UnscentedParams) -> Floats:
    """The covariance with the heading no more uncertain than sigma points can be without meeting behind the circle.

    Nothing here hears the heading, so that in the end it is unknown; what is known of the tilt is not touched.
    """
    excess = float(np.sqrt(covariance[2, 2])) / p.heading_sd_rad
    if excess <= 1.0:
        return covariance
    scale = np.array([1.0, 1.0, 1.0 / excess, 1.0, 1.0, 1.0])
    bounded: Floats = covariance * np.outer(scale, scale)
    return bounded


def _vector(q: Floats) -> Floats:
    """Rotation vectors (k, 3) of quaternions (k, 4), the short way round."""
    q = q * np.where(q[:, :1] < 0.0, -1.0, 1.0)
    length = np.linalg.norm(q[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(length, q[:, 0])
    scale = np.divide(angle, length, out=np.full_like(angle, 2.0), where=length > 1e-12)
    vector: Floats = q[:, 1:] * scale[:, None]
    return vector
