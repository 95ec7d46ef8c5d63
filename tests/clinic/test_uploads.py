from __future__ import annotations

import io
import json
import zipfile

import pytest

from gaitlab.clinic import patients, sessions
from gaitlab.clinic.access import Principal
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.sessions import InspectedFile
from gaitlab.clinic.views import PatientForm, SessionForm
from gaitlab.errors import InputError
from gaitlab.recording import InputFile, Placement
from tests.clinic.conftest import People
from tests.recordings import short_walk

LEFT, RIGHT = Placement.LEFT_FOOT, Placement.RIGHT_FOOT


def inspect(clinic: Clinic, who: Principal, *files: InputFile) -> list[InspectedFile]:
    with clinic.desk(who) as desk:
        return sessions.inspect_upload(desk, files)


def recorded(placement: Placement, name: str, device: str = "") -> InputFile:
    """The walk's file under another name, and from a device that says who it is."""
    content = short_walk()[placement].content
    head = f"// DeviceId: {device}\n".encode() if device else b""
    return InputFile(name, head + content)


def zipped(*files: InputFile) -> InputFile:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in files:
            archive.writestr(file.name, file.content)
    return InputFile("trial.zip", buffer.getvalue())


def test_a_file_is_described_and_nothing_stored(clinic: Clinic, people: People) -> None:
    (one,) = inspect(clinic, people.alice, short_walk()[LEFT])
    assert (one.name, one.placement, one.left_out, one.rate_hz) == ("walk_left_foot.txt", LEFT, False, 100.0)
    assert "name" in one.why
    assert one.samples > 300
    assert one.lost_share == 0
    assert not [path for path in (clinic.settings.data_dir / "files").rglob("*") if path.is_file()]


def test_lost_packets_are_counted(clinic: Clinic, people: People) -> None:
    lines = short_walk()[LEFT].content.splitlines(keepends=True)
    thinned = lines[:2] + [line for i, line in enumerate(lines[2:]) if i % 4 != 1]
    (one,) = inspect(clinic, people.alice, InputFile("lf.txt", b"".join(thinned)))
    assert one.samples == len(lines) - 2
    assert one.lost_share == pytest.approx(0.25, abs=0.01)


def test_a_zip_is_unpacked_and_other_files_in_it_are_left_out(clinic: Clinic, people: People) -> None:
    archive = zipped(short_walk()[LEFT], short_walk()[RIGHT], InputFile("readme.txt", b"the walk of today\n"))
    found = inspect(clinic, people.alice, archive)
    assert [(one.placement, one.left_out) for one in found] == [(LEFT, False), (RIGHT, False), (None, True)]


def test_a_placement_file_in_the_zip_decides(clinic: Clinic, people: People) -> None:
    stated = InputFile("placement.json", json.dumps({"left_foot": "a.txt", "right_foot": "b.txt"}).encode())
    archive = zipped(recorded(LEFT, "a.txt"), recorded(RIGHT, "b.txt"), stated)
    found = {one.name: one for one in inspect(clinic, people.alice, archive)}
    assert (found["a.txt"].placement, found["b.txt"].placement) == (LEFT, RIGHT)
    assert "placement.json" in found["a.txt"].why
    assert found["placement.json"].left_out


def test_a_placement_file_that_names_one_file_for_both_feet_is_refused(
    clinic: Clinic, people: People
) -> None:
    stated = InputFile("placement.json", json.dumps({"left_foot": "a.txt", "right_foot": "a.txt"}).encode())
    with pytest.raises(InputError, match="the same file") as refused:
        inspect(clinic, people.alice, zipped(recorded(LEFT, "a.txt"), recorded(RIGHT, "b.txt"), stated))
    assert (refused.value.code, refused.value.file) == ("same_content", "placement.json")


def test_a_sensor_worn_elsewhere_is_left_out(clinic: Clinic, people: People) -> None:
    found = inspect(clinic, people.alice, short_walk()[LEFT], recorded(RIGHT, "pelvis.txt"))
    assert [(one.placement, one.left_out) for one in found] == [(LEFT, False), (None, True)]


def test_a_device_is_placed_as_the_site_placed_it_last(clinic: Clinic, people: People) -> None:
    files = {LEFT: recorded(LEFT, "1.txt", "00B40001"), RIGHT: recorded(RIGHT, "2.txt", "00B40002")}
    form = SessionForm.model_validate({"date": "2026-11-20", "test": "walk"})
    (before,) = inspect(clinic, people.alice, files[LEFT])
    assert (before.placement, before.device) == (None, "00B40001")
    with clinic.desk(people.alice) as desk:
        patient = patients.add_patient(desk, PatientForm(code="MS-07"))
        sessions.add_session(desk, patient.id, form, files)
    found = inspect(
        clinic, people.bob, recorded(LEFT, "9.txt", "00B40001"), recorded(RIGHT, "8.txt", "00B40002")
    )
    assert [one.placement for one in found] == [LEFT, RIGHT]
    assert all(one.why for one in found)
    clinic.now.pass_by(days=1)  # type: ignore[attr-defined]
    with clinic.desk(people.alice) as desk:
        sessions.add_session(desk, patient.id, form, {LEFT: files[RIGHT], RIGHT: files[LEFT]})
    assert [one.placement for one in inspect(clinic, people.bob, files[LEFT])] == [RIGHT]
    assert [one.placement for one in inspect(clinic, people.charlie, files[LEFT])] == [None]


@pytest.mark.parametrize(
    "file",
    [InputFile("left_foot.txt", b""), InputFile("left_foot.txt", b"\x89PNG\r\n\x1a\n" + bytes(100)),
     InputFile("notes.txt", b"Dear colleague,\n"), InputFile("left_foot.txt", b"a;b;c\n1;2;3\n")],
    ids=["empty", "picture", "letter", "other columns"],
)  # fmt: skip
def test_a_file_that_is_no_recording_is_named(clinic: Clinic, people: People, file: InputFile) -> None:
    with pytest.raises(InputError) as refusal:
        inspect(clinic, people.alice, file)
    assert refusal.value.file == file.name


def test_a_damaged_recording_beside_a_good_one_is_refused_and_not_overlooked(
    clinic: Clinic, people: People
) -> None:
    with pytest.raises(InputError) as refusal:
        inspect(clinic, people.alice, short_walk()[LEFT], InputFile("right_foot.txt", b"\x00\x01" * 50))
    assert refusal.value.file == "right_foot.txt"


def test_no_file_at_all_is_said(clinic: Clinic, people: People) -> None:
    with pytest.raises(InputError):
        inspect(clinic, people.alice)
