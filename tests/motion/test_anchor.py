"""What is known of the course bends the path only where somebody says so, and by no more than the path allows."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.motion.path import Anchor
from gaitlab.recording.model import Placement
from tests.walks import out_and_back

LEFT = Placement.LEFT_FOOT


def track(anchor: Anchor | None) -> FootMotion:
    walk = out_and_back().recording
    return track_foot(walk.sensors[LEFT], walk.time_s(LEFT), anchor=anchor)


def far_m(foot: FootMotion) -> float:
    return float(np.linalg.norm(foot.rest_position_m[:, :2] - foot.rest_position_m[0, :2], axis=1).max())


def test_a_closed_course_ends_nearer_to_where_it_began_and_is_surer_of_it() -> None:
    free, closed = track(None), track(Anchor(closed=True, closed_sd_m=0.05))
    gap = [
        float(np.linalg.norm((one.rest_position_m[-1] - one.rest_position_m[0])[:2]))
        for one in (free, closed)
    ]
    assert gap[1] < gap[0]
    spread = [float(np.trace(one.place_covariance_m2[-1])) for one in (free, closed)]
    assert spread[1] < 0.5 * spread[0]


@pytest.mark.parametrize("excess", [-0.1, 0.1])
def test_a_known_way_pulls_the_farthest_place_towards_it(excess: float) -> None:
    free = track(None)
    pulled = track(Anchor(way_m=far_m(free) + excess, way_sd_m=0.01))
    assert 0.2 < (far_m(pulled) - far_m(free)) / excess <= 1.0


def test_nothing_known_changes_nothing() -> None:
    np.testing.assert_array_equal(track(None).position_m, track(Anchor()).position_m)
