"""Many stretches at once say the same as each alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gaitlab.motion.windows import Windows, refined


@given(st.integers(0, 2**32 - 1))
def test_windows_agree_with_one_loop_over_each(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.choice([-2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0], size=60)
    start = np.sort(rng.choice(50, size=5, replace=False))
    windows = Windows(start, start + rng.integers(1, 10, size=5))
    level = rng.normal(size=5)
    highest, centre = windows.highest(values), windows.centre(values**2)
    below, above = windows.first_below(values, level), windows.first_above(values, level)
    for k in range(5):
        rows = np.arange(windows.start[k], windows.end[k])
        assert highest[k] == rows[values[rows].argmax()]
        assert centre[k] == pytest.approx(np.average(rows, weights=values[rows] ** 2))
        for found, over in ((below[k], values[rows] < level[k]), (above[k], values[rows] > level[k])):
            if not over.any() or over[0]:
                assert np.isnan(found)
                continue
            after = rows[over.argmax()]
            assert after - 1 <= found <= after
            assert np.interp(found, rows, values[rows]) == pytest.approx(level[k])


def test_the_vertex_of_a_parabola_is_found_between_rows() -> None:
    rows = np.arange(20)
    values = 3.0 - 0.5 * (rows - 7.3) ** 2
    np.testing.assert_allclose(refined(values, np.array([7, 0, 19])), [7.3, 0.0, 19.0])
