"""Where each sensor was worn is told by names, devices and placement.json, or asked; never guessed in silence."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Placement, read_recording
from gaitlab.recording.placing import guess_placements
from gaitlab.recording.selection import place_files
from tests.recording.texts import LONG_HEADER, mt_text

LEFT_FOOT, RIGHT_FOOT = Placement.LEFT_FOOT, Placement.RIGHT_FOOT
LEFT_KNEE, RIGHT_KNEE = Placement.LEFT_KNEE, Placement.RIGHT_KNEE


def sensor_file(name: str, n: int = 60) -> InputFile:
    return InputFile(name, mt_text(n=n).file.content)


def folder_of(tmp_path: Path, *names: str, **texts: str) -> Path:
    for number, name in enumerate(names):
        (tmp_path / name).write_bytes(sensor_file(name, 60 + number).content)
    for name, text in texts.items():
        (tmp_path / name.replace("__", ".")).write_text(text)
    return tmp_path


def zip_of(tmp_path: Path, entries: Mapping[str, bytes]) -> Path:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    path = tmp_path / "trial.zip"
    path.write_bytes(buffer.getvalue())
    return path


def refusal(*paths: Path, placements: Mapping[Placement, Path | str] | None = None) -> InputError:
    with pytest.raises(InputError) as caught:
        read_recording(*paths, placements=placements)
    assert caught.value.hint
    return caught.value


@pytest.mark.parametrize(
    ("name", "placement"),
    [
        ("1-3_lf.txt", LEFT_FOOT),
        ("1-3_rf.txt", RIGHT_FOOT),
        ("S01_left_foot_2.txt", LEFT_FOOT),
        ("LF.txt", LEFT_FOOT),
        ("M6_RF.TXT", RIGHT_FOOT),
        ("RightKnee.txt", RIGHT_KNEE),
        ("left-knee.csv", LEFT_KNEE),
        ("lk.txt", LEFT_KNEE),
        ("walk_l_foot.txt", LEFT_FOOT),
        ("foot right.txt", RIGHT_FOOT),
        ("leftFoot3.txt", LEFT_FOOT),
        ("rightfoot.txt", RIGHT_FOOT),
        ("FootLeft.txt", LEFT_FOOT),
        ("LShank.txt", LEFT_KNEE),
        ("RTibia_20210820_202113_811.csv", RIGHT_KNEE),
        ("LeftLowerLeg.txt", LEFT_KNEE),
        ("right_shoe.txt", RIGHT_FOOT),
        ("RF_left_foot.txt", LEFT_FOOT),  # initials do not outweigh words
        ("MT_012005D6_009-001_00B421E6.txt", None),
        ("S02-Trial-Walk-1-000_00B40C55.txt", None),
        ("half_shelf.txt", None),
        ("left.txt", None),
        ("foot.txt", None),
        ("left_right_foot.txt", None),
        ("left_foot_knee.txt", None),
        ("left_leg.txt", None),
    ],
)
def test_placement_by_file_name(name: str, placement: Placement | None) -> None:
    guess = guess_placements([sensor_file(name)])[0]
    assert guess.placement is placement
    assert guess.why.endswith(".")


def test_shank_counts_as_knee_and_says_so() -> None:
    guess = guess_placements([sensor_file("left_tibia.txt")])[0]
    assert guess.why == "The file name says left tibia; a sensor there counts as the knee's."


@pytest.mark.parametrize(
    ("name", "elsewhere"),
    [("1-1_lb.txt", "low back"), ("M6_HE.txt", "head"), ("LeftThigh.txt", "thigh"), ("Pelvis.txt", "pelvis")],
)
def test_other_parts_of_the_body_are_known_as_such(name: str, elsewhere: str) -> None:
    guess = guess_placements([sensor_file(name)])[0]
    assert guess.placement is None
    assert guess.elsewhere == elsewhere


def test_folder_name_tells_where_the_file_name_does_not() -> None:
    assert guess_placements([sensor_file("trial3/right_foot/data.txt")])[0].placement is RIGHT_FOOT
    assert guess_placements([sensor_file("left_foot/data_rf.txt")])[0].placement is RIGHT_FOOT


def test_device_from_name_or_header_and_its_earlier_place() -> None:
    by_name = sensor_file("MT_012005D6_009-001_00B421E6.txt")
    by_header = InputFile("a.txt", replace(mt_text(), comments=LONG_HEADER).file.content)
    known = {"00B421E6": LEFT_KNEE, "00B42D4B": RIGHT_FOOT}
    guesses = guess_placements([by_name, by_header], known)
    assert [(guess.device, guess.placement) for guess in guesses] == [
        ("00B421E6", LEFT_KNEE),
        ("00B42D4B", RIGHT_FOOT),
    ]
    assert "00B421E6 was worn at the left knee before" in guesses[0].why
    assert [guess.placement for guess in guess_placements([by_name, by_header])] == [None, None]


def test_file_name_goes_before_the_earlier_place_of_the_device() -> None:
    file = InputFile("left_foot_00B421E6.txt", mt_text().file.content)
    assert guess_placements([file], {"00B421E6": RIGHT_KNEE})[0].placement is LEFT_FOOT


def test_two_files_for_one_placement_are_both_named() -> None:
    with pytest.raises(InputError) as caught:
        guess_placements([sensor_file("a_lf.txt"), sensor_file("b_left_foot.txt")])
    assert caught.value.code == "placement_twice"
    assert "a_lf.txt, b_left_foot.txt" in caught.value.message


def test_folder_with_one_trial(tmp_path: Path) -> None:
    folder_of(tmp_path, "w_lf.txt", "w_rf.txt", "w_lk.txt", README__txt="Read me", markers__csv="t,x\n0,1\n")
    (tmp_path / "1-1.json").write_text("{}")
    assert list(read_recording(tmp_path).sensors) == [LEFT_FOOT, RIGHT_FOOT, LEFT_KNEE]


def test_zip_with_one_trial_in_a_folder_and_clutter(tmp_path: Path) -> None:
    entries = {
        "trial/w_lf.txt": sensor_file("a", 60).content,
        "trial/w_rf.txt": sensor_file("a", 70).content,
        "__MACOSX/trial/._w_lf.txt": b"\x00\x05",
        "trial/.DS_Store": b"\x00",
        "trial/README.md": b"# walk",
        "trial/meta.json": b"{}",
    }
    recording = read_recording(zip_of(tmp_path, entries))
    assert [sensor.source.name for sensor in recording.sensors.values()] == [
        "trial/w_lf.txt",
        "trial/w_rf.txt",
    ]


@pytest.mark.parametrize("as_zip", [False, True])
def test_placement_json_settles_everything(tmp_path: Path, as_zip: bool) -> None:
    table = json.dumps({"left_foot": "b.txt", "right_knee": "misleading_lf.txt"})
    names = ["a.txt", "b.txt", "misleading_lf.txt"]
    folder = folder_of(tmp_path, *names)
    (folder / "placement.json").write_text(table)
    path = folder
    if as_zip:
        path = zip_of(
            tmp_path, {f"t/{name}": (folder / name).read_bytes() for name in [*names, "placement.json"]}
        )
    recording = read_recording(path)
    assert {p: sensor.source.name.removeprefix("t/") for p, sensor in recording.sensors.items()} == {
        LEFT_FOOT: "b.txt",
        RIGHT_KNEE: "misleading_lf.txt",
    }


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ('{"left_foot": "a.txt",\n "right_foot" "b.txt"}', 2, "JSON"),
        ("[1, 2]", None, "object"),
        ('{"left_hand": "a.txt"}', None, "left_hand"),
        ('{"left_foot": 3}', None, "left_foot"),
        ('{"left_foot": "c.txt"}', None, "c.txt"),
        ('{"left_foot": "../../secret.txt"}', None, "secret"),
        ("{}", None, "no file"),
        ('{"left_foot": "a.txt", "left_foot": "b.txt"}', None, "twice"),
        ("[" * 100_000, None, "JSON"),
        ("\x00", 1, "JSON"),
    ],
)
def test_placement_json_that_is_wrong(tmp_path: Path, text: str, line: int | None, what: str) -> None:
    folder_of(tmp_path, "a.txt", "b.txt", placement__json=text)
    error = refusal(tmp_path)
    assert (error.code, error.file, error.line) == ("placement_file", "placement.json", line)
    assert what in error.message


def test_placement_json_never_opens_a_path(tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_bytes(sensor_file("x").content)
    folder = tmp_path / "trial"
    folder.mkdir()
    folder_of(folder, "a_lf.txt", placement__json=json.dumps({"left_foot": str(secret)}))
    assert refusal(folder).code == "placement_file"


def test_unknown_placement_lists_the_files_and_the_ways_to_place_them(tmp_path: Path) -> None:
    folder_of(tmp_path, "a.txt", "b.txt", "c_lf.txt")
    error = refusal(tmp_path)
    assert error.code == "placement_unknown"
    assert "a.txt, b.txt" in error.message
    assert "c_lf.txt" not in error.message
    assert "--left-foot" in error.hint
    assert "placement.json" in error.hint


def test_explicit_placements_settle_the_rest(tmp_path: Path) -> None:
    folder_of(tmp_path, "a.txt", "b.txt", "c_rf.txt")
    recording = read_recording(tmp_path, placements={LEFT_FOOT: tmp_path / "a.txt"})
    assert {p: s.source.name for p, s in recording.sensors.items()} == {
        LEFT_FOOT: "a.txt",
        RIGHT_FOOT: "c_rf.txt",
    }


def test_explicit_placement_by_a_name_inside_a_zip(tmp_path: Path) -> None:
    path = zip_of(tmp_path, {"t/a.txt": sensor_file("a").content, "t/b.txt": sensor_file("b", 70).content})
    for name in ("t/b.txt", "b.txt"):
        recording = read_recording(path, placements={RIGHT_FOOT: name})
        assert recording.sensors[RIGHT_FOOT].source.name == "t/b.txt"


def test_explicit_path_on_disk_goes_before_a_file_of_the_same_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "trial").mkdir()
    folder_of(tmp_path / "trial", "a_lf.txt", "b_rf.txt")
    (tmp_path / "a_lf.txt").write_bytes(sensor_file("a", 90).content)
    monkeypatch.chdir(tmp_path)
    recording = read_recording("trial", placements={LEFT_FOOT: "a_lf.txt"})
    assert recording.sensors[LEFT_FOOT].n_samples == 90


def test_explicit_placement_outweighs_the_name_and_placement_json(tmp_path: Path) -> None:
    folder_of(tmp_path, "a_lf.txt", "b_rf.txt", placement__json='{"left_foot": "a_lf.txt"}')
    recording = read_recording(tmp_path, placements={LEFT_FOOT: tmp_path / "b_rf.txt"})
    assert {p: s.source.name for p, s in recording.sensors.items()} == {LEFT_FOOT: "b_rf.txt"}


def test_explicit_placement_that_is_a_folder_or_missing(tmp_path: Path) -> None:
    folder_of(tmp_path, "a_lf.txt", "b_rf.txt")
    assert refusal(placements={LEFT_FOOT: tmp_path}).code == "placement_unknown"
    assert refusal(placements={LEFT_FOOT: tmp_path / "none.txt"}).code == "no_such_file"


def test_sensor_worn_elsewhere_is_left_aside_and_told(tmp_path: Path) -> None:
    recording = read_recording(folder_of(tmp_path, "1_lf.txt", "1_rf.txt", "1_lb.txt"))
    assert list(recording.sensors) == [LEFT_FOOT, RIGHT_FOOT]
    assert [(finding.code, "1_lb.txt (low back)" in finding.message) for finding in recording.findings] == [
        ("sensor_not_used", True)
    ]


def test_only_a_sensor_worn_elsewhere(tmp_path: Path) -> None:
    error = refusal(folder_of(tmp_path, "1_lb.txt"))
    assert (error.code, error.file) == ("no_sensor_files", "1_lb.txt")


def test_damaged_file_named_for_a_placement_is_refused_not_overlooked(tmp_path: Path) -> None:
    folder_of(tmp_path, "1_lf.txt", **{"1_rf__txt": ""})
    error = refusal(tmp_path)
    assert (error.code, error.file) == ("empty_file", "1_rf.txt")


def test_markers_named_like_a_placement_give_way_to_the_sensor(tmp_path: Path) -> None:
    recording = read_recording(folder_of(tmp_path, "1_lf.txt", left_foot_markers__csv="t,x\n0,1\n"))
    assert recording.sensors[LEFT_FOOT].source.name == "1_lf.txt"


@pytest.mark.parametrize(
    ("content", "code"), [("", "empty_file"), ("Hello", "not_mt_manager"), ("a,Acc_X\n", "missing_columns")]
)
def test_single_file_that_is_no_recording_gets_its_own_reason(
    tmp_path: Path, content: str, code: str
) -> None:
    path = tmp_path / "a.txt"
    path.write_text(content)
    error = refusal(path)
    assert (error.code, error.file) == (code, "a.txt")


def test_nothing_to_read(tmp_path: Path) -> None:
    assert refusal(tmp_path).code == "no_files"
    (tmp_path / "a.txt").write_text("x")
    (tmp_path / "b.txt").write_text("y")
    assert refusal(tmp_path).code == "no_sensor_files"


def test_earlier_choices_of_devices_place_files_without_names() -> None:
    file = sensor_file("MT_012005D6_009-001_00B421E6.txt")
    assert place_files([file], known_devices={"00B421E6": LEFT_FOOT}).files == {LEFT_FOOT: file}
