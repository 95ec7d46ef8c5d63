"""How well a track meets points whose places are known: error of distance and of direction between successive ones.

Bousdar Ahmed and Metzger 2017, §III-A, eq. 7–8; table II: 0.4 ± 1.8 m and 14.9 ± 28.8° for the thigh navigation system,
0.2 ± 1.2 m and 10.1 ± 31.3° with the corrections, 17 walks and 149 points.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.recording.model import Floats


@dataclass(frozen=True, eq=False)
class GroundTruthErrors:
    """Between each of k points and the next, true minus estimated.

    Attributes
    ----------
    distance_m : ndarray (k − 1,)
        e_d, eq. 7.
    heading_rad : ndarray (k − 1,)
        e_ψ, eq. 8, within ±π; NaN where two points coincide.
    """

    distance_m: Floats
    heading_rad: Floats


def ground_truth_errors(true_m: Floats, estimated_m: Floats, *, aligned: bool = False) -> GroundTruthErrors:
    """Eq. 7 and 8 of points (k, 2) or (k, 3), of which the horizontal places count.

    A heading without a compass begins anywhere: ``aligned`` takes the first direction of both to be one, and its error
    is then 0 by definition.
    """
    true, estimated = (np.diff(points[:, :2], axis=0) for points in (true_m, estimated_m))
    distance = np.hypot(true[:, 0], true[:, 1]) - np.hypot(estimated[:, 0], estimated[:, 1])
    turn = _directions(true) - _directions(estimated)
    if aligned and len(turn):
        turn = turn - turn[0]
    return GroundTruthErrors(distance, np.pi - np.mod(np.pi - turn, 2.0 * np.pi))


def _directions(way: Floats) -> Floats:
    direction: Floats = np.arctan2(way[:, 1], way[:, 0])
    direction[~np.any(way, axis=1)] = np.nan
    return direction
