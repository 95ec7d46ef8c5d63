"""How a knee moved: it never rests, so its path is tied to its foot's by the leg between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion import ikizoglu2018
from gaitlab.motion.drift import DriftCurve
from gaitlab.motion.free import method_motion
from gaitlab.motion.integration import position_of
from gaitlab.motion.leg import Pair, RigidFit, RigidParams, fit_rigid_link
from gaitlab.motion.model import FootMotion, Indices, KneeMotion, LegLink, LegPlace, Motion
from gaitlab.motion.orientation import OrientationSource
from gaitlab.motion.thigh import TwoLinkFit, fit_two_links
from gaitlab.recording.model import Floats, Sensor


@dataclass(frozen=True)
class KneeParams:
    """How a knee is tied to its foot.

    Attributes
    ----------
    accel_density_m2ps3 : float
        Acceleration error of the knee's own path as white noise: 0.08 m/s² for a second, what a tilt of half a degree
        makes of gravity.
    spacing_s : float
        The leg is looked at so often.
    sure_share : float
        A rigid link that leaves less than this share of the foot's movement needs no second look: it is a shank. In
        ``mtw-leg-vicon`` four sensors on shanks leave 0.06–0.08, two on thighs 0.26–0.29.
    most_share : float
        One that leaves more is no shank of this leg: shanks of simulated walks leave 0.04–0.15 (the most when they
        walk fast), those of the other leg 0.34–0.51 there and 0.42–0.46 in ``mtw-leg-vicon``.
    gain : float
        Between them two links decide, where they leave less by at least this factor: 3.8 and 4.2 for the two thighs,
        at most 1.1 for every shank, real or simulated.
    thigh_share : float
        Two links that leave more than this share are no thigh of this leg: 0.07 for the thighs. The other thigh leaves
        0.14, the pelvis 0.12, and the knee would be above the sensor.
    loose_sd_m : float
        What is neither follows its foot so loosely, over seconds.
    """

    accel_density_m2ps3: float = 0.0064
    spacing_s: float = 0.1
    sure_share: float = 0.09
    most_share: float = 0.22
    gain: float = 2.0
    thigh_share: float = 0.12
    loose_sd_m: float = 0.05


@dataclass(frozen=True, eq=False)
class Cycles:
    """Gait cycles of a foot in the rows of its knee: from leaving one rest to leaving the next.

    ``start``, ``end`` (m,) rows; ``step_m`` (m, 3) the foot's displacement.
    """

    start: Indices
    end: Indices
    step_m: Floats

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
    return Cycles(start[inside], end[inside], steps[inside])


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
        Of the knee: anywhere on shank or thigh.
    foot : FootMotion
        Of the same side.
    shift : int
        Knee row = foot row + shift.
    method : str
        ``gaitlab``: the leg joins knee and foot all the time (``leg.py``, ``thigh.py``). ``ikizoglu2018``: a constant
        velocity offset per cycle, its heading that of a rigid link.

    Source: İkizoğlu et al. 2018, §3.3, tie the knee to its foot once in a gait cycle. Deviation: all the time, by the
    geometry of the leg, which is estimated.
    """
    free = method_motion(sensor, time_s, method, source)
    cycles = cycles_of(foot, free.n_samples, shift)
    if not len(cycles):
        return _knee_motion(free, free.raw_velocity_mps, free.raw_position_m, cycles, None)
    curve, fit, link = join_to_foot(free, foot, shift)
    free = free.turned(fit.yaw_rad)
    if method == "ikizoglu2018":
        pairs = [(int(a), int(b)) for a, b in zip(cycles.start, cycles.end, strict=True)]
        velocity = ikizoglu2018.correct_knee(free.raw_velocity_mps, pairs, cycles.step_m, free.rate_hz)
        return _knee_motion(free, velocity, position_of(velocity, free.rate_hz), cycles, link)
    drift, slope = curve.position_and_velocity(fit.drift)
    velocity = free.raw_velocity_mps - slope
    return _knee_motion(free, velocity, free.raw_position_m - drift, cycles, link, velocity[cycles.start])


def join_to_foot(
    free: Motion, foot: FootMotion, shift: int, params: KneeParams | None = None
) -> tuple[DriftCurve, RigidFit | TwoLinkFit, LegLink]:
    """The drift of a leg sensor against its foot, by the link that the data show: shank, thigh, or neither."""
    p = params or KneeParams()
    first = max(0, int(foot.rests.start[0]) + shift)
    last = min(free.n_samples, int(foot.rests.end[-1]) + shift) - 1
    curve = DriftCurve.over(first, last, free.n_samples, free.rate_hz, p.spacing_s, p.accel_density_m2ps3)
    pair = Pair.of(free, foot, shift, curve, RigidParams().sd_m)
    rigid = fit_rigid_link(pair, curve)
    if rigid.unexplained < p.sure_share:
        return curve, rigid, LegLink(LegPlace.SHANK, rigid.unexplained)
    two = fit_two_links(pair, curve, rigid)
    gain = rigid.misfit / max(two.misfit, 1e-9)
    if gain > p.gain and rigid.unexplained < gain * p.thigh_share and two.plausible:
        return curve, two, LegLink(LegPlace.THIGH, rigid.unexplained / gain)
    if rigid.unexplained < p.most_share:
        return curve, rigid, LegLink(LegPlace.SHANK, rigid.unexplained)
    loose = fit_rigid_link(pair, curve, replace(RigidParams(), sd_m=p.loose_sd_m))
    return curve, loose, LegLink(LegPlace.UNKNOWN, rigid.unexplained)


def _knee_motion(
    free: Motion,
    velocity: Floats,
    position: Floats,
    cycles: Cycles,
    link: LegLink | None,
    started: Floats | None = None,
) -> KneeMotion:
    """``started`` (m, 3): velocity with which each cycle really began; None: the uncorrected one."""
    raw = free.raw_position_m
    excess = raw[cycles.end] - raw[cycles.start] - cycles.step_m
    if started is not None:  # a velocity that was wrong when the cycle began is no fault of the cycle
        carried = free.raw_velocity_mps[cycles.start] - started
        excess = excess - carried * ((cycles.end - cycles.start) / free.rate_hz)[:, None]
    residual = np.linalg.norm(excess[:, :2], axis=1)
    kept = vars(free) | {"velocity_mps": velocity, "position_m": position}
    return KneeMotion(**kept, cycle_start=cycles.start, cycle_end=cycles.end, residual_m=residual, link=link)
