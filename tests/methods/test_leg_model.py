"""The leg of five angles: poses worked by hand, there and back, and against joints that cameras saw."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gaitlab.methods.leg_model import (
    DH_AS_PRINTED,
    LegAngles,
    Links,
    angles_of_joints,
    angles_of_segments,
    hip_angles,
    joints_in_base,
    joints_in_world,
    link_matrices,
)

LINKS = Links(0.45, 0.40, 0.2)
NONE = np.zeros(0, dtype=np.intp)
OPTICAL = (
    Path(os.environ.get("GAITLAB_DATA", Path(__file__).resolve().parents[3] / "shared" / "data"))
    / "mtw-leg-vicon"
    / "vicon-left-leg.csv"
)


def pose(*angles_deg: float) -> np.ndarray:
    """Knee, ankle and metatarsal of five angles in degrees, shape (3, 3)."""
    return joints_in_base(np.radians([angles_deg]), LINKS)[0, 1:]


def quaternions(rotation: Rotation) -> np.ndarray:
    return rotation.as_quat(scalar_first=True)


def test_equation_1_is_a_turn_about_z_a_way_along_x_and_a_turn_about_x() -> None:
    h = link_matrices(np.radians([30.0]), 0.4, np.radians(-90.0))[0]
    s, c = 0.5, np.sqrt(3.0) / 2.0
    expected = [[c, 0.0, -s, 0.4 * c], [s, 0.0, c, 0.4 * s], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    np.testing.assert_allclose(h, expected, atol=1e-15)


def test_at_zero_the_leg_hangs_stretched_and_the_foot_points_forward() -> None:
    np.testing.assert_allclose(
        pose(0, 0, 0, 0, 0), [[0, 0, -0.45], [0, 0, -0.85], [0.2, 0, -0.85]], atol=1e-15
    )


def test_a_knee_bent_by_90_degrees_puts_the_shank_behind_and_the_foot_down() -> None:
    expected = [[0, 0, -0.45], [-0.4, 0, -0.45], [-0.4, 0, -0.65]]
    np.testing.assert_allclose(pose(0, 0, 90, 0, 0), expected, atol=1e-15)


def test_a_pitched_ankle_moves_only_the_metatarsal() -> None:
    expected = [[0, 0, -0.45], [0, 0, -0.85], [0.2 * np.cos(0.5), 0, -0.85 - 0.2 * np.sin(0.5)]]
    np.testing.assert_allclose(pose(0, 0, 0, 0, np.degrees(0.5)), expected, atol=1e-15)


def test_hip_pitch_takes_the_leg_back_and_hip_roll_to_the_left() -> None:
    s, c = np.sin(0.3), np.cos(0.3)
    np.testing.assert_allclose(pose(0, np.degrees(0.3), 0, 0, 0)[1], [-0.85 * s, 0, -0.85 * c], atol=1e-15)
    np.testing.assert_allclose(pose(np.degrees(0.3), 0, 0, 0, 0)[1], [0, 0.85 * s, -0.85 * c], atol=1e-15)


def test_ankle_roll_turns_a_pitched_foot_about_the_shank_s_axis_backward() -> None:
    expected = [0.0, -0.2, -0.85]  # the toe hangs down from the ankle, then swings to the right
    np.testing.assert_allclose(pose(0, 0, 0, 90, 90)[2], expected, atol=1e-15)


def test_the_table_as_printed_is_the_mended_one_with_a_knee_bent_by_180_degrees_more() -> None:
    angles = np.random.default_rng(1).uniform(-1.0, 1.0, (20, 5))
    folded = angles + np.array([0.0, 0.0, np.pi, 0.0, 0.0])
    np.testing.assert_allclose(
        joints_in_base(angles, LINKS, DH_AS_PRINTED), joints_in_base(folded, LINKS), atol=1e-12
    )
    at_zero = joints_in_base(np.zeros((1, 5)), LINKS, DH_AS_PRINTED)[0, 3]
    np.testing.assert_allclose(at_zero, [-0.2, 0.0, -0.05], atol=1e-15)


def test_angles_come_back_from_joints() -> None:
    rng = np.random.default_rng(2)
    angles = rng.uniform(-1.4, 1.4, (500, 5))
    angles[:, 1] = rng.uniform(-2.1, 0.2, 500)  # a hip flexed by up to 120°, as the paper's figure 2
    angles[:, 4] = rng.uniform(0.1, 1.4, 500) * rng.choice([-1.0, 1.0], 500)
    heading = rng.uniform(-np.pi, np.pi, 500)
    hip = rng.normal(0.0, 3.0, (500, 3))
    places = joints_in_world(LegAngles(angles, heading, NONE, NONE, LINKS), hip)
    np.testing.assert_allclose(angles_of_joints(places, heading), angles, atol=1e-9)


def test_angles_come_back_from_segment_orientations() -> None:
    rng = np.random.default_rng(3)
    angles, heading = rng.uniform(-1.4, 1.4, (500, 5)), rng.uniform(-np.pi, np.pi, 500)
    angles[:, 1] = rng.uniform(-2.1, 0.2, 500)
    thigh = Rotation.from_euler("ZXY", np.column_stack([heading, angles[:, :2]]))
    shank = thigh * Rotation.from_euler("y", angles[:, 2:3])
    foot = shank * Rotation.from_euler("XY", angles[:, 3:] * [-1.0, 1.0])
    found, base = angles_of_segments(quaternions(thigh), quaternions(shank), quaternions(foot))
    np.testing.assert_allclose(found, angles, atol=1e-9)
    np.testing.assert_allclose(base, heading, atol=1e-9)
    places = joints_in_world(LegAngles(angles, heading, NONE, NONE, LINKS))
    ends = [(thigh, [0, 0, -LINKS.thigh_m]), (shank, [0, 0, -LINKS.shank_m]), (foot, [LINKS.foot_m, 0, 0])]
    for k, (segment, link) in enumerate(ends):
        np.testing.assert_allclose(np.diff(places, axis=1)[:, k], segment.apply(link), atol=1e-12)


def test_turning_the_world_changes_the_heading_alone() -> None:
    rng = np.random.default_rng(4)
    thigh = Rotation.from_euler("ZXY", rng.uniform(-0.5, 0.5, (50, 3)))
    before = hip_angles(quaternions(thigh))
    after = hip_angles(quaternions(Rotation.from_euler("z", 1.0) * thigh))
    np.testing.assert_allclose(after[0] - before[0], 1.0, atol=1e-12)
    np.testing.assert_allclose(after[1:], before[1:], atol=1e-12)


def test_no_rows_and_joints_that_coincide_are_no_error() -> None:
    assert joints_in_base(np.zeros((0, 5))).shape == (0, 4, 3)
    assert angles_of_joints(np.zeros((0, 4, 3)), np.zeros(0)).shape == (0, 5)
    assert np.all(np.isfinite(angles_of_joints(np.zeros((1, 4, 3)), np.zeros(1))))


@pytest.mark.skipif(not OPTICAL.is_file(), reason="the public recordings are not here (GAITLAB_DATA)")
def test_the_leg_lies_on_the_joints_that_cameras_saw_but_for_what_five_angles_cannot_do() -> None:
    """The knee within 5 mm; the ankle within 30 mm RMS, for this shank sways 3.4° beside the plane of a hinge; the
    metatarsal within 45 mm, for the foot also toes out, which no angle of the model does."""
    rows = list(csv.reader(OPTICAL.read_text().splitlines()))
    table = {
        name: np.array(column, float)
        for name, column in zip(rows[0], zip(*rows[1:], strict=True), strict=True)
    }
    joints = np.stack(
        [
            np.stack([table[f"{name}_{k}"] for k in (1, 2, 3)], axis=1)
            for name in ("LFEP", "LFEO", "LTIO", "LTOE")
        ],
        axis=1,
    )
    thigh, shank, foot = (
        np.stack([table[f"{name}_{k}"] for k in (1, 2, 3, 4)], axis=1) for name in ("qLTH", "qLSK", "qLFT")
    )
    # the foot's z points to the toe there
    forward = Rotation.from_matrix([[0, 0, -1], [0, 1, 0], [1, 0, 0]])
    foot = quaternions(Rotation.from_quat(foot, scalar_first=True) * forward)
    angles, heading = angles_of_segments(thigh, shank, foot)
    lengths = np.linalg.norm(np.diff(joints, axis=1), axis=2).mean(axis=0)
    leg = LegAngles(angles, heading, NONE, NONE, Links(*lengths))
    error = np.linalg.norm(joints_in_world(leg, joints[:, 0]) - joints, axis=2)
    rms = np.sqrt(np.mean(error**2, axis=0))
    assert np.all(rms[1:] < [0.005, 0.030, 0.045])
    # what is left is beside the plane: within it the ankle is where it was seen
    sideways = Rotation.from_quat(thigh, scalar_first=True).apply([0.0, 1.0, 0.0])
    within = np.linalg.norm(np.diff(joints[:, :3], axis=1)[:, 1], axis=1)
    beside = np.abs(np.sum((joints[:, 2] - joints[:, 1]) * sideways, axis=1))
    assert np.all(np.abs(error[:, 2] - beside) < 0.012 + 0.5 * beside**2 / within)
