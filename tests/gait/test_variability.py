"""Variability: the person's own scatter, without the measurement's, and only where there are strides enough."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from gaitlab.analysis import analyze
from gaitlab.gait import definitions as d
from gaitlab.gait.measurement import MeasuredSide, Status
from gaitlab.gait.variability import (
    Spread,
    VariabilityParams,
    of_feet,
    pooled,
    pooled_cv,
    scatter,
    spread_of,
    variability,
)
from gaitlab.recording import read_recording
from gaitlab.recording.model import Floats, Placement, Side
from tests.walks import analysed, out_and_back, without

LEFT = MeasuredSide.LEFT
SURE = VariabilityParams(jitter_spread=0.0)


def test_the_measurements_variance_is_taken_out() -> None:
    values = 1.0 + np.tile([0.03, -0.03], 15)
    one = scatter(d.STRIDE_TIME_CV, LEFT, spread_of(values, 0.01).relative)
    observed = 0.03**2 * 30 / 29
    assert one.value == pytest.approx(100 * math.sqrt(observed - 0.01**2))
    assert one.ci95 is not None
    assert one.ci95[1] - one.value > one.value - one.ci95[0] > 0.0


def test_without_measurement_error_the_interval_is_that_of_chi_square() -> None:
    spread = Spread(25, 24, 1.0, 0.02**2, 0.0)
    one = scatter(d.STRIDE_TIME_CV, LEFT, spread)
    # χ² with 24 degrees of freedom: 12.401 and 39.364
    assert one.ci95 == pytest.approx((2 * math.sqrt(24 / 39.364), 2 * math.sqrt(24 / 12.401)), rel=1e-4)


@pytest.mark.parametrize("noise", [0.0, 0.5, 1.0])
def test_the_interval_covers_the_persons_variability(noise: float) -> None:
    """Strides that vary by 2 %, measured with errors of a share of that: 95 % of the intervals cover it."""
    rng = np.random.default_rng(7)
    covered, determined = 0, 0
    for _ in range(1500):
        values = 1.1 * (1.0 + 0.02 * rng.standard_normal(30)) + 0.022 * noise * rng.standard_normal(30)
        one = scatter(d.STRIDE_TIME_CV, LEFT, spread_of(values, 0.022 * noise).relative, SURE)
        if one.ci95 is not None:
            determined += 1
            covered += one.ci95[0] <= 2.0 <= one.ci95[1]
    assert determined > 100
    assert 0.93 <= covered / determined <= 0.99


def test_errors_that_neighbours_share_with_opposite_sign_are_taken_out_whole() -> None:
    """Times between events that each err by 10 ms: the mean over many walks of what is left is the person's variance."""
    rng = np.random.default_rng(11)
    left = []
    for _ in range(3000):
        errors = 0.01 * rng.standard_normal(9)
        times = 1.0 + 0.015 * rng.standard_normal(8) + np.diff(errors)
        spread = spread_of(times, math.sqrt(2.0) * 0.01, math.sqrt(2.0) * 0.01 / 8)
        left.append(spread.variance - spread.measurement_variance)
    assert np.mean(left) == pytest.approx(0.015**2, rel=0.05)


def test_a_faster_trial_is_no_variability() -> None:
    rng = np.random.default_rng(2)
    first, second = (1.0 + 0.02 * rng.standard_normal(15) for _ in range(2))
    apart = pooled_cv([(first, 0.0), (0.6 * second, 0.0)])
    assert (apart.n, apart.freedom) == (30, 28)
    expected = 0.5 * ((first.std(ddof=1) / first.mean()) ** 2 + (second.std(ddof=1) / second.mean()) ** 2)
    assert apart.variance == pytest.approx(expected)


def test_both_sides_are_the_root_of_the_mean_of_their_squares() -> None:
    left, right = Spread(24, 23, 1.0, 0.03**2, 0.0), Spread(22, 21, 1.0, 0.01**2, 0.0)
    both = scatter(d.STRIDE_TIME_CV, MeasuredSide.BOTH, of_feet(left, right))
    assert both.value == pytest.approx(math.sqrt((3.0**2 + 1.0**2) / 2))
    assert both.n == 22


def test_a_scatter_that_the_measurement_explains_is_not_given_but_bounded() -> None:
    one = scatter(d.STRIDE_TIME_CV, LEFT, Spread(30, 29, 1.0, 0.017**2, 0.016**2))
    assert one.status is Status.NOT_DETERMINABLE
    assert "not above what the measurement itself explains" in one.reason
    assert "below 1.9 %" in one.reason


def test_too_few_strides_are_counted_and_sent_to_the_pool() -> None:
    one = scatter(d.STRIDE_TIME_CV, LEFT, spread_of(np.array([1.0, 1.1, 1.05]), 0.0))
    assert one.status is Status.NOT_DETERMINABLE
    assert "There are 3 strides" in one.reason
    assert "at least 20" in one.reason
    assert one.n == 3


def test_trials_of_no_stride_pool_to_none() -> None:
    nothing = pooled([spread_of(np.zeros(0), 0.01), spread_of(np.ones(1), 0.01)])
    assert nothing.freedom == 0
    assert scatter(d.STRIDE_TIME_CV, LEFT, nothing).status is Status.NOT_DETERMINABLE


def test_one_trial_has_too_few_strides_and_a_missing_foot_is_named() -> None:
    for name in ("stride_time_cv", "stride_length_cv", "stride_velocity_cv", "double_support_sd"):
        for side in ("left", "right", "both"):
            parameter = analysed().result.parameter(name, side)
            assert parameter is not None
            assert parameter.status == "not_determinable"
            assert "at least 20" in parameter.reason
    one_foot = analyze(without(out_and_back().recording, Placement.RIGHT_FOOT, Placement.RIGHT_KNEE))
    both = one_foot.result.parameter("stride_time_cv", "both")
    assert both is not None
    assert "right foot was not recorded" in both.reason


@pytest.mark.parametrize("person", ["1", "10", "13"])
def test_pooled_over_trials_stride_times_vary_as_the_hand_checked_ones_do(
    data_dir: Path, person: str
) -> None:
    """Within half a percentage point, of 1.4 to 2.4 %."""
    ours: dict[Side, list[Spread]] = {side: [] for side in Side}
    theirs: list[tuple[Floats, float]] = []
    for path in sorted((data_dir / "mtw-10m-walk").glob(f"{person}-*.json")):
        files = {
            Placement.LEFT_FOOT: path.with_name(f"{path.stem}_lf.txt"),
            Placement.RIGHT_FOOT: path.with_name(f"{path.stem}_rf.txt"),
        }
        recording = read_recording(placements=files)
        gait = analyze(recording).gait
        for side, key in ((Side.LEFT, "LeftFootEvents"), (Side.RIGHT, "RightFootEvents")):
            ours[side].append(gait.spreads["stride_time_cv"][side])
            times = []
            contact = (np.array(json.loads(path.read_text())[key])[:, 1] - recording.first_packet) / 100.0
            for part in range(gait.feet[side].part.max() + 1):
                chosen = np.flatnonzero(gait.feet[side].part == part)[2:-2]
                for k in chosen:
                    now, before = (gait.feet[side].events.initial_contact_s[i] for i in (k, k - 1))
                    times.append(
                        contact[np.abs(contact - now).argmin()] - contact[np.abs(contact - before).argmin()]
                    )
            theirs.append((np.array(times), 0.005 * math.sqrt(2.0)))
    found = variability({"stride_time_cv": {side: pooled(spreads) for side, spreads in ours.items()}})
    both = next(one for one in found if one.definition is d.STRIDE_TIME_CV and one.side is MeasuredSide.BOTH)
    labelled = pooled_cv(theirs)
    assert both.value == pytest.approx(
        100 * math.sqrt(labelled.variance - labelled.measurement_variance), abs=0.5
    )
