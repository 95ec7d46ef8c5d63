"""The magnetometer as a second opinion on a foot's heading: heard only where it agrees with itself and the gyroscope."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gaitlab.motion.model import FieldEvidence, FootMotion
from gaitlab.motion.quaternions import matrices
from gaitlab.motion.strapdown import apply
from gaitlab.recording.model import Floats


@dataclass(frozen=True)
class MagnetometerParams:
    """When the field at the rests of a foot is that of the earth.

    Attributes
    ----------
    scatter_rad : float
        Its direction in the foot's world scatters by no more than this about a steady drift; 3°. In the rests of
        ``mtw-10m-walk``, indoors and a hand's breadth over the floor, it scatters by 17° to 57°.
    strength_spread : float
        Nor its strength by more than this share; 16 % to 42 % there.
    least_rests : int
        Fewer rests show no drift.
    """

    scatter_rad: float = 0.05
    strength_spread: float = 0.05
    least_rests: int = 6


def judge_field(
    foot: FootMotion, mag: Floats, params: MagnetometerParams | None = None
) -> FieldEvidence | None:
    """Judge the field, shape (n, 3), sensor frame, any unit, in the rests of a foot; None where there are too few."""
    p = params or MagnetometerParams()
    rests = foot.rests
    if len(rests) < p.least_rests:
        return None
    moment = rests.moment
    field = apply(matrices(foot.attitude[moment]), mag[moment])
    strength = np.linalg.norm(field, axis=1)
    if not strength.min() > 0.0:
        return None
    heading = np.unwrap(np.arctan2(field[:, 1], field[:, 0]))
    time_s = foot.time_s[moment] - foot.time_s[moment].mean()
    slope = float(time_s @ (heading - heading.mean()) / (time_s @ time_s))
    scatter = float(np.std(heading - heading.mean() - slope * time_s, ddof=2))
    spread = float(strength.std() / strength.mean())
    agrees = scatter <= p.scatter_rad and spread <= p.strength_spread
    return FieldEvidence(agrees, scatter, spread, slope, scatter / float(np.sqrt(time_s @ time_s)))


def with_field(foot: FootMotion, mag: Floats | None) -> FootMotion:
    """The foot with its heading's drift corrected by the field where it agrees, and the evidence either way.

    The drift of the gyroscope's heading, known from standing to within ``drift_sd_radps``, and the one that the field
    shows are weighed by their variances (Feliz et al. 2009, future work 1 and 2: judge when the compass can be trusted,
    then combine the two).
    """
    evidence = None if mag is None else judge_field(foot, mag)
    if evidence is None:
        return foot
    if evidence.used:
        known = foot.offsets.drift_sd_radps**2
        share = known / (known + evidence.drift_sd_radps**2)
        foot = foot.redirected(-share * evidence.drift_radps * (foot.time_s - foot.time_s[0]))
    return replace(foot, field=evidence)
