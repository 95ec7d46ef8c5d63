"""The trial's verdict follows from what was found in it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from gaitlab.analysis import analyze
from gaitlab.gait.verdicts import Quality
from gaitlab.quality import severity, trial_quality
from gaitlab.recording import read_recording
from gaitlab.recording.model import Finding, Placement, Recording
from gaitlab.result import Result
from tests.walks import analysed, cut, out_and_back


def test_the_gravest_finding_decides_and_comes_first() -> None:
    found = [
        Finding("lost_samples", "Some were lost."),
        Finding("many_lost", "Many were lost."),
        Finding("not_one_walk", "Two walks."),
        Finding("many_lost", "Many were lost."),
    ]
    quality = trial_quality(found)
    assert quality.status is Quality.INVALID
    assert quality.reasons == ("Two walks.", "Many were lost.")
    assert trial_quality(found[:2]).status is Quality.ATTENTION
    assert trial_quality(found[:1]) == trial_quality([])


def test_a_finding_that_nobody_has_judged_wants_attention() -> None:
    assert severity("something_new") is Quality.ATTENTION


def test_a_sound_walk_is_valid_and_has_no_reasons() -> None:
    quality = analysed(None).result.quality
    assert quality is not None
    assert quality.status == "valid"
    assert quality.reasons == ()


def test_a_recording_without_walking_is_invalid_and_says_so() -> None:
    sensors = {p: cut(s, 0, 350) for p, s in out_and_back().recording.sensors.items() if p.is_foot}
    quality = analyze(Recording(sensors)).result.quality
    assert quality is not None
    assert quality.status == "invalid"
    assert quality.reasons[0].startswith("Nobody walks")


def test_a_foot_most_of_whose_strides_are_invalid_makes_the_trial_invalid() -> None:
    sensors = {p: s for p, s in out_and_back().recording.sensors.items() if p.is_foot}
    left = sensors[Placement.LEFT_FOOT]
    saturated = left.saturated.copy()
    saturated[900:] = True
    recording = Recording({**sensors, Placement.LEFT_FOOT: replace(left, saturated=saturated)})
    quality = analyze(recording).result.quality
    assert quality is not None
    assert quality.status == "invalid"
    assert "rest on the few that remain" in quality.reasons[0]


def test_feet_of_two_trials_make_an_invalid_one(data_dir: Path) -> None:
    folder = data_dir / "mtw-10m-walk"
    feet = {Placement.LEFT_FOOT: folder / "1-4_lf.txt", Placement.RIGHT_FOOT: folder / "1-5_rf.txt"}
    quality = analyze(read_recording(placements=feet)).result.quality
    assert quality is not None
    assert quality.status == "invalid"
    assert "do not alternate" in quality.reasons[0]


def test_a_result_stored_before_quality_was_judged_is_still_read() -> None:
    document = json.loads(analysed().result.to_json())
    for name in ("quality", "spreads"):
        del document[name]
    for foot in document["feet"].values():
        for stride in foot["strides"]:
            del stride["quality"], stride["reason"]
        for rest in foot["rests"]:
            for name in ("gyr_sd_radps", "acc_sd_mps2", "implied_acc_error_mps2"):
                del rest[name]
    old = Result.model_validate(document)
    assert old.quality is None
    assert {stride.quality for stride in old.feet["left"].strides} == {"valid"}
    assert old.parameters == analysed().result.parameters
