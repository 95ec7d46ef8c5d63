"""The comfort zone: its limits, and by how much a stance leaves it."""

from __future__ import annotations

import numpy as np

from gaitlab.methods.leg_model import LegAngles, Links
from gaitlab.methods.posture_bousdar2017 import METHOD, corrections, extremes, judge

LINKS = Links(0.45, 0.40, 0.2)


def leg(*stances: tuple[tuple[float, float], ...]) -> LegAngles:
    """Stances of (roll, pitch) in degrees, a row far outside between them, knee and ankle bent as they like."""
    rows, start, end = [], [], []
    for stance in stances:
        rows.append((60.0, 80.0, 9.0, 9.0, 9.0))
        start.append(len(rows))
        rows += [(*hip, 9.0, 9.0, 9.0) for hip in stance]
        end.append(len(rows))
    angles = np.radians(np.array(rows)) if rows else np.zeros((0, 5))
    return LegAngles(
        angles, np.zeros(len(rows)), np.array(start, dtype=np.intp), np.array(end, dtype=np.intp), LINKS
    )


def test_the_limits_are_within_and_a_hair_beyond_is_not() -> None:
    corners = leg(
        ((3.5, 18.0), (-3.5, -28.0)), ((3.5, 18.001),), ((0.0, -28.001),), ((3.501, 0.0),), ((-3.501, 0.0),)
    )
    assert judge(corners).coherent.tolist() == [True, False, False, False, False]


def test_equations_3_and_4_give_what_leads_back_to_the_limit() -> None:
    found = judge(leg(((1.0, 0.0), (5.5, 10.0)), ((-7.5, -30.0), (0.0, 0.0)), ((0.0, 20.0), (0.0, -10.0))))
    np.testing.assert_allclose(
        np.degrees(found.correction_rad), [[-2.0, 0.0], [4.0, 2.0], [0.0, -2.0]], atol=1e-12
    )
    np.testing.assert_allclose(np.degrees(found.high_rad), [[5.5, 10.0], [0.0, 0.0], [0.0, 20.0]], atol=1e-12)
    np.testing.assert_allclose(
        np.degrees(found.low_rad), [[1.0, 0.0], [-7.5, -30.0], [0.0, -10.0]], atol=1e-12
    )


def test_a_stance_that_leaves_the_zone_on_both_sides_is_led_back_from_above_as_the_equations_are_written() -> (
    None
):
    found = corrections(np.radians([[-5.0, -40.0]]), np.radians([[6.0, 20.0]]))
    np.testing.assert_allclose(np.degrees(found), [[-2.5, -2.0]], atol=1e-12)


def test_the_metatarsal_is_as_far_out_as_the_leg_is_long_and_the_angle_wide() -> None:
    """Pitch 2° too far, no roll: hip to metatarsal is √(0.85² + 0.2²), and a chord of 2° on it is 2·r·sin 1°."""
    found = judge(leg(((0.0, 20.0), (0.0, 18.0)), ((0.0, 18.0),)))
    np.testing.assert_allclose(
        found.outside_m, [2.0 * np.hypot(0.85, 0.2) * np.sin(np.radians(1.0)), 0.0], atol=1e-12
    )


def test_only_the_rows_of_a_stance_count_and_the_last_row_may_end_one() -> None:
    values = np.arange(12.0).reshape(6, 2)
    low, high = extremes(values, np.array([0, 2, 4]), np.array([2, 3, 6]))
    np.testing.assert_array_equal(low, [[0, 1], [4, 5], [8, 9]])
    np.testing.assert_array_equal(high, [[2, 3], [4, 5], [10, 11]])


def test_turning_the_base_changes_nothing() -> None:
    first = leg(((5.0, 20.0), (0.0, -30.0)))
    other = LegAngles(first.angle_rad, first.heading_rad + 2.0, first.start, first.end, LINKS)
    np.testing.assert_array_equal(judge(first).outside_m, judge(other).outside_m)


def test_no_stance_no_rows_and_no_orientation_are_no_error() -> None:
    assert len(judge(leg()).coherent) == 0
    assert (
        len(
            judge(
                LegAngles(np.zeros((1, 5)), np.zeros(1), np.zeros(0, np.intp), np.zeros(0, np.intp))
            ).coherent
        )
        == 0
    )
    unknown = judge(leg(((np.nan, np.nan),), ((0.0, 0.0),)))
    assert unknown.coherent.tolist() == [False, True]
    assert unknown.reason[0]
    assert not unknown.reason[1]
    assert np.isnan(unknown.outside_m[0])


def test_the_constants_of_the_catalogue_are_those_of_the_paper() -> None:
    found = {one.name: (round(np.degrees(one.value), 9), one.unit) for one in METHOD.constants}
    limits = {"roll_min_rad": -3.5, "roll_max_rad": 3.5, "pitch_min_rad": -28.0, "pitch_max_rad": 18.0}
    assert found == {name: (limit, "rad") for name, limit in limits.items()}
