"""The magnetometer is heard where the field at the rests is one field, and only there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from gaitlab.motion.foot import track_foot
from gaitlab.motion.model import FootMotion
from gaitlab.motion.quaternions import conjugate, rotate
from gaitlab.recording import read_recording
from gaitlab.recording.model import Floats, Placement
from tests.walks import out_and_back

LEFT = Placement.LEFT_FOOT
EARTH = np.array([0.2, 0.35, -0.9])


def drifting(drift_radps: float, disturbed: Floats | float = 0.0) -> FootMotion:
    """The left foot of a simulated walk whose gyroscope's offset about the vertical is wrong, in the earth's field."""
    walk = out_and_back(None).recording
    sensor, time_s = walk.sensors[LEFT], walk.time_s(LEFT)
    assert sensor.gyr_radps is not None
    attitude = track_foot(sensor, time_s).attitude
    up = rotate(conjugate(attitude), np.broadcast_to([0.0, 0.0, 1.0], sensor.gyr_radps.shape))
    walking = (np.arange(sensor.n_samples) > 500)[:, None]  # not while it stands, or the offset would be seen
    mag = rotate(conjugate(attitude), np.broadcast_to(EARTH, sensor.gyr_radps.shape)) + disturbed
    return track_foot(
        replace(sensor, gyr_radps=sensor.gyr_radps + drift_radps * walking * up, mag=mag), time_s
    )


def test_a_drift_of_the_heading_is_taken_out_where_the_field_agrees() -> None:
    true, plain = drifting(0.0), drifting(0.004, np.random.default_rng(1).normal(size=(1, 3)) * 1e-3)
    assert plain.field is not None
    assert plain.field.used
    assert abs(plain.field.drift_radps) > 0.002
    end = np.linalg.norm(plain.rest_position_m[-1] - true.rest_position_m[-1])
    alone = track_foot_without_field(0.004)
    assert end < 0.5 * np.linalg.norm(alone.rest_position_m[-1] - true.rest_position_m[-1])


def track_foot_without_field(drift_radps: float) -> FootMotion:
    noise = np.random.default_rng(2).normal(size=(drifting(0.0).n_samples, 3))
    foot = drifting(drift_radps, noise)
    assert foot.field is not None
    assert not foot.field.used
    return foot


def test_a_disturbed_field_changes_nothing() -> None:
    foot = track_foot_without_field(0.0)
    assert foot.field is not None
    assert foot.field.scatter_rad > 0.1
    np.testing.assert_allclose(foot.position_m, drifting(0.0).position_m, atol=0.05)


def test_no_real_foot_over_an_indoor_floor_trusts_its_compass(data_dir: Path) -> None:
    for path in sorted((data_dir / "mtw-10m-walk").glob("1-*_lf.txt")):
        recording = read_recording(placements={LEFT: path})
        foot = track_foot(recording.sensors[LEFT], recording.time_s(LEFT))
        assert foot.field is not None
        assert not foot.field.used
        assert np.degrees(foot.field.scatter_rad) > 10.0
