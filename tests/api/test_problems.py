"""Bad input gets one clear problem document, and nothing is stored."""

from __future__ import annotations

import io
import zipfile
from typing import Any

import pytest

from gaitlab.recording import Placement
from tests.api.visitors import House, Program, as_uploads
from tests.recordings import short_walk

DATA = {"date": "2026-11-20", "test": "walk"}
LEFT = short_walk()[Placement.LEFT_FOOT]


def line_changed(content: bytes, line: int, cell: int, text: str) -> bytes:
    lines = content.decode().split("\n")
    cells = lines[line - 1].split("\t")
    cells[cell] = text
    lines[line - 1] = "\t".join(cells)
    return "\n".join(lines).encode()


def zipped(names: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in names.items():
            archive.writestr(name, content)
    return buffer.getvalue()


WRONG_FILES: dict[str, tuple[str, bytes, int | None, str | None]] = {
    "empty": ("left_foot", b"", None, None),
    "binary": ("left_foot", bytes(range(256)) * 20, None, None),
    "wrong columns": ("left_foot", b"a\tb\tc\n1\t2\t3\n", None, None),
    "text in a number": ("left_foot", line_changed(LEFT.content, 12, 2, "abc"), 12, "Acc_Y"),
    "one sample": ("left_foot", b"\n".join(LEFT.content.split(b"\n")[:3]) + b"\n", None, None),
    "a picture": ("left_foot", b"\x89PNG\r\n\x1a\n" + b"\0" * 100, None, None),
    "zip with ../": ("recording", zipped({"../left_foot.txt": LEFT.content}), None, None),
    "zip with an absolute name": ("recording", zipped({"/etc/left_foot.txt": LEFT.content}), None, None),
    "zip bomb": ("recording", zipped({"left_foot.txt": b"0" * 60_000_000}), None, None),
    "zip in a zip": (
        "recording",
        zipped({"left_foot.zip": zipped({"left_foot.txt": LEFT.content})}),
        None,
        None,
    ),
    "not a zip": ("recording", b"PK\x03\x04 but no further", None, None),
}


def send(program: Program, patient_id: str, files: dict[str, Any], **data: str) -> Any:
    return program.post(f"/api/v1/patients/{patient_id}/sessions", data={**DATA, **data}, files=files)


@pytest.mark.parametrize("kind", WRONG_FILES)
def test_a_wrong_file_is_named_with_the_place_in_it_and_nothing_is_stored(house: House, kind: str) -> None:
    field, content, line, column = WRONG_FILES[kind]
    patient = house.patient(house.alice)
    name = "walk <b>left</b>.txt"
    answer = send(house.program(house.alice), patient.id, {field: (name, content)})
    assert answer.status_code in (413, 422)
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["status"] == answer.status_code
    assert problem["code"]
    assert problem["detail"].endswith(".")
    assert problem["hint"]
    assert problem["file"]
    if line is not None:
        assert (problem["file"], problem["line"], problem["column"]) == (name, line, column)
    assert "Traceback" not in answer.text
    assert house.n_sessions(patient.id) == 0


def test_no_file_at_all_is_said(house: House) -> None:
    patient = house.patient(house.alice)
    program = house.program(house.alice)
    answers = [
        send(program, patient.id, {}),
        send(program, patient.id, {"left_foot": ("", b"")}),
    ]
    assert [answer.status_code for answer in answers] == [422, 422]
    assert answers[0].json()["code"] == "no_file"


def test_a_knee_without_a_foot_is_said(house: House) -> None:
    patient = house.patient(house.alice)
    answer = send(house.program(house.alice), patient.id, {"left_knee": (LEFT.name, LEFT.content)})
    assert (answer.status_code, answer.json()["code"]) == (422, "no_foot")


def test_two_files_for_one_placement_are_said(house: House) -> None:
    patient = house.patient(house.alice)
    twice = [("left_foot", ("a.txt", LEFT.content)), ("left_foot", ("b.txt", LEFT.content))]
    answer = send(house.program(house.alice), patient.id, twice)  # type: ignore[arg-type]
    problem = answer.json()
    assert (answer.status_code, problem["code"]) == (422, "given_twice")
    assert (problem["file"], problem["column"]) == ("b.txt", "left_foot")


def test_files_and_a_zip_together_are_said(house: House) -> None:
    patient = house.patient(house.alice)
    files = {"left_foot": (LEFT.name, LEFT.content), "recording": ("w.zip", zipped({"lf.txt": LEFT.content}))}
    answer = send(house.program(house.alice), patient.id, files)
    assert (answer.status_code, answer.json()["code"]) == (422, "two_ways")


def test_a_zip_whose_placements_cannot_be_told_is_said(house: House) -> None:
    patient = house.patient(house.alice)
    archive = zipped({"one.txt": LEFT.content, "two.txt": LEFT.content})
    answer = send(house.program(house.alice), patient.id, {"recording": ("walk.zip", archive)})
    assert answer.status_code == 422
    assert answer.json()["code"] == "placement_unknown"
    assert "one.txt" in answer.json()["detail"]


@pytest.mark.parametrize(
    ("change", "column"),
    [
        ({"date": "yesterday"}, "date"),
        ({"date": "2999-01-01"}, "date"),
        ({"date": "0"}, "date"),
        ({"date": "1800-01-01"}, "date"),
        ({"test": "marathon"}, "test"),
        ({"course_m": "0.1"}, "course_m"),
        ({"course_m": "nan"}, "course_m"),
        ({"course_m": "far"}, "course_m"),
        ({"note": "x" * 2001}, "note"),
        ({"note": "a\x00b"}, "note"),
        ({"site_id": "other"}, "site_id"),
        ({"created_by": "somebody"}, "created_by"),
        ({"id": "mine"}, "id"),
    ],
)
def test_a_wrong_or_unknown_field_is_named(house: House, change: dict[str, str], column: str) -> None:
    patient = house.patient(house.alice)
    files = as_uploads(short_walk())
    answer = house.program(house.alice).post(
        f"/api/v1/patients/{patient.id}/sessions", data={**DATA, **change}, files=files
    )
    assert (answer.status_code, answer.json()["column"]) == (422, column)
    assert house.n_sessions(patient.id) == 0


@pytest.mark.parametrize(
    "smuggled",
    ["id", "site_id", "owner_id", "role", "created_at", "version", "signed_by", "sha256", "deleted_at"],
)
def test_no_field_can_be_smuggled_into_a_patient(house: House, smuggled: str) -> None:
    program = house.program(house.alice)
    patient = house.patient(house.alice)
    new = program.post("/api/v1/patients", json={"code": "P-2", smuggled: "x"})
    changed = program.request("PATCH", f"/api/v1/patients/{patient.id}", json={"note": "n", smuggled: "x"})
    for answer in (new, changed):
        assert answer.status_code == 422
        assert answer.json()["errors"][0]["field"] == smuggled
    assert program.get("/api/v1/patients").json()["total"] == 1
    assert program.get(f"/api/v1/patients/{patient.id}").json()["note"] == ""


NO_PATIENTS = {
    "nothing": b"",
    "half an object": b"{",
    "a list": b"[]",
    "null": b"null",
    "a text": b'"text"',
    "a number for a code": b'{"code": 5}',
    "an empty code": b'{"code": ""}',
    "a NUL in the code": b'{"code": "a\\u0000"}',
    "no UTF-8": b"\xff\xfe",
    "an endless number": b'{"code": "x", "height_m": 1e999}',
    "not a number": b'{"code": "x", "height_m": NaN}',
    "a deep nest": b'{"code":' + b"[" * 50_000,
}


@pytest.mark.parametrize("body", NO_PATIENTS.values(), ids=NO_PATIENTS)
def test_a_body_that_is_no_patient_is_a_problem_and_never_a_crash(house: House, body: bytes) -> None:
    answer = house.program(house.alice).post(
        "/api/v1/patients", content=body, headers={"Content-Type": "application/json"}
    )
    assert answer.status_code in (400, 422)
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("odd", ["%00", "a" * 65, "'; DROP TABLE patient--", "ä", "%2e%2e%2f"])
def test_an_odd_identifier_is_not_found(house: House, odd: str) -> None:
    program, browser = house.program(house.alice), house.browser(house.alice)
    answers = [
        program.get(f"/api/v1/patients/{odd}"),
        program.get(f"/api/v1/trials/{odd}/result.json"),
        browser.get(f"/sessions/{odd}"),
    ]
    assert {answer.status_code for answer in answers} == {404}


def test_a_form_with_too_many_parts_is_refused(house: House) -> None:
    patient = house.patient(house.alice)
    many = [("left_foot", (f"{i}.txt", b"x")) for i in range(80)]
    answer = send(house.program(house.alice), patient.id, many)  # type: ignore[arg-type]
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_request")


def test_a_page_answers_a_program_that_asks_for_json_in_json(house: House) -> None:
    answer = house.browser(house.alice).get("/patients/nothing", headers={"Accept": "application/json"})
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["code"] == "not_found"


def cut(body: bytes, how: str) -> bytes:
    """A multipart body as it arrives when its sender stops early."""
    return {"in the last file": body[:-4000], "before its closing boundary": body[: body.rindex(b"\r\n--")]}[
        how
    ]


@pytest.mark.parametrize("how", ["in the last file", "before its closing boundary"])
def test_an_upload_that_was_cut_off_is_refused_and_nothing_is_stored(house: House, how: str) -> None:
    patient, program = house.patient(house.alice), house.program(house.alice)
    files = as_uploads(short_walk())
    path = f"/api/v1/patients/{patient.id}/sessions"
    whole = program.client.build_request("POST", path, data=DATA, files=files)
    body = cut(whole.read(), how)
    answer = program.post(path, content=body, headers={"Content-Type": whole.headers["content-type"]})
    assert (answer.status_code, answer.json()["code"]) == (400, "incomplete_body")
    browser = house.browser(house.alice)
    path = f"/patients/{patient.id}/sessions/new"
    sent = [("files", file) for file in files.values()]
    whole = browser.client.build_request("POST", path, data={**DATA, "form_token": browser.token}, files=sent)
    headers = {"Content-Type": whole.headers["content-type"], "Sec-Fetch-Site": "same-origin"}
    answer = browser.client.post(path, content=cut(whole.read(), how), headers=headers)
    assert answer.status_code == 400
    assert house.n_sessions(patient.id) == 0


def test_an_upload_that_is_no_form_is_told_so(house: House) -> None:
    patient = house.patient(house.alice)
    answer = house.program(house.alice).post(f"/api/v1/patients/{patient.id}/sessions", json=DATA)
    assert (answer.status_code, answer.json()["code"]) == (415, "not_a_form")
