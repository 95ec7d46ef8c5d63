"""How uncertain each place and each velocity of a foot's path is, row by row; computed for whoever asks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import FootMotion
from gaitlab.motion.passages import leaving
from gaitlab.motion.smoother import SmootherParams
from gaitlab.recording.model import Floats


@dataclass(frozen=True, eq=False)
class Spread:
    """Covariances, row by row, world axes: ``place_m2`` (n, 3, 3) of the place against the first rest, ``velocity_m2ps2``
    (n, 3, 3)."""

    place_m2: Floats
    velocity_m2ps2: Floats


def spread_of(foot: FootMotion) -> Spread:
    """Covariance of every place and velocity of a foot's path.

    At the rests it is the smoother's. Between two of them, u of the passage's time T after the first: the places of both
    ends and, since the velocity is nil at both, what a white acceleration error that makes the velocity variance V over the
    passage leaves there (a twice integrated Brownian bridge): V·T²·(u(1 − u))³/3 in place and V·u(1 − u)·(1 − 3u(1 − u))
    in velocity, per axis. Both have the share of the scale. Before the first and after the last rest it is that of the rest:
    the path there is not known to be any better than that.
    """
    n, rests = foot.n_samples, foot.rests
    place, velocity = np.zeros((n, 3, 3)), np.zeros((n, 3, 3))
    axes = np.arange(3)
    velocity[:, axes, axes] += SmootherParams().rest_speed_mps ** 2
    if len(rests) > 1:
        first, last = rests.start[1:], leaving(rests)[:-1]
        knots = np.stack([last, first], axis=1).ravel()
        phases = np.stack([np.arange(len(first)), np.arange(1, len(first) + 1)], axis=1).ravel()
        phase = np.interp(np.arange(n), knots, phases)
        passage = np.minimum(phase.astype(np.intp), len(first) - 1)
        u = phase - passage
        known = foot.place_covariance_m2
        place += known[passage] + u[:, None, None] * (known[passage + 1] - known[passage])
        arch = u * (1.0 - u)
        duration_s = ((first - last) / foot.rate_hz)[passage]
        doubt = foot.velocity_var_m2ps2[passage]
        place[:, axes, axes] += (doubt * duration_s**2 * arch**3 / 3.0)[:, None]
        velocity[:, axes, axes] += (doubt * arch * (1.0 - 3.0 * arch))[:, None]
    way = foot.position_m - foot.position_m[rests.moment[0] if len(rests) else 0]
    for covariance, vectors in ((place, way), (velocity, foot.velocity_mps)):
        covariance += foot.scale_sd**2 * vectors[:, :, None] * vectors[:, None, :]
    return Spread(place, velocity)
