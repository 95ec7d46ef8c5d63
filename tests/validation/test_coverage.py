"""The table of coverage: the truth of every parameter, and intervals that hold it."""

from __future__ import annotations

import numpy as np
import pytest

from gaitlab.analysis import Settings, analyze
from gaitlab.cli import main
from gaitlab.gait.definitions import DEFINITIONS
from gaitlab.recording.model import Side
from gaitlab.simulation import SensorErrors
from gaitlab.validation import Table, coverage_table
from gaitlab.validation.coverage import CLASSES, simulated_walk, true_feet, true_parameters


@pytest.fixture(scope="module")
def table() -> Table:
    """Both kinds of sampling, one walk of each a class and pace."""
    return coverage_table(seeds=2)


def test_every_parameter_but_the_correction_itself_and_rare_variabilities_is_judged(table: Table) -> None:
    judged = {row.key for row in table.rows}
    missing = {one.name for one in DEFINITIONS if one.group != "variability"} - judged
    points_where_it_walks = {
        "foot_progression_angle",
        "foot_progression_sd",
    }  # no truth of its own in simulation
    assert missing <= {"knee_residual"} | points_where_it_walks
    assert "each_stride_length" in judged


@pytest.mark.parametrize(
    "key",
    [
        "stride_time",
        "step_time",
        "cadence",
        "stance_share",
        "swing_share",
        "double_support_share",
        "turn_duration",
        "turn_angle",
        "stop_duration",
        "path_deviation",
        "closing_distance",
        "knee_sway",
        "each_stride_length",
    ],
)
def test_at_least_nine_intervals_of_ten_hold_the_truth(table: Table, key: str) -> None:
    """In each class all but one of the eight that a small table has of some parameters."""
    shares = [table.row(key).value(kind) for kind in CLASSES]
    assert np.mean(shares) >= 90.0
    assert min(shares) >= 87.5


def test_with_perfect_sensors_the_analysis_is_near_the_truth_that_it_is_judged_by() -> None:
    walk = simulated_walk("comfortable", SensorErrors(), 5, "mean")
    analysis = analyze(walk.recording, Settings(course_m=7.62))
    feet = true_feet(analysis, walk.truth)
    for side in Side:
        np.testing.assert_allclose(
            feet[side].length_m[feet[side].walking],
            walk.truth.feet[side].stride_length_m[: feet[side].walking.sum()],
            atol=1e-6,
        )
    found = {(one.definition.name, one.side): one.value for one in analysis.gait.parameters}
    for one in true_parameters(analysis, walk.truth, feet):
        if one.definition.unit in ("s", "m/s") and one.value is not None:
            assert found[one.definition.name, one.side] == pytest.approx(one.value, abs=0.05)


def test_the_command_takes_no_folder_and_the_sets_need_one(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], table: Table
) -> None:
    monkeypatch.setattr("gaitlab.cli.validate.coverage_table", lambda: table)
    assert main(["validate", "coverage"]) == 0
    assert "each stride length" in capsys.readouterr().out
    for wrong in (["validate", "coverage", "folder"], ["validate", "leg-vicon"]):
        with pytest.raises(SystemExit) as caught:
            main(wrong)
        assert caught.value.code == 2
