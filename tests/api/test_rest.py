"""REST does what the pages do: patients, sessions, trials, reports."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import pytest
from pypdf import PdfReader

from gaitlab.recording import InputFile, Placement
from gaitlab.result import Result
from tests.api.visitors import House, as_choice, as_uploads
from tests.recordings import short_walk

DATA = {"date": "2026-11-20", "test": "t25fw"}


def real_trial(data_dir: Path, name: str = "1-1") -> dict[Placement, InputFile]:
    folder = data_dir / "mtw-10m-walk"
    return {
        Placement.foot(place.side): InputFile(
            f"{name}_{end}.txt", (folder / f"{name}_{end}.txt").read_bytes()
        )
        for place, end in ((Placement.LEFT_FOOT, "lf"), (Placement.RIGHT_FOOT, "rf"))
    }


def test_a_patient_is_added_read_listed_changed_and_hidden(house: House) -> None:
    program = house.program(house.alice)
    new = program.post("/api/v1/patients", json={"code": "MS-1", "sex": "female", "height_m": 1.7})
    assert new.status_code == 201
    path = new.headers["location"]
    assert path == f"/api/v1/patients/{new.json()['id']}"
    assert program.get(path).json() == new.json()
    assert [p["code"] for p in program.get("/api/v1/patients?query=ms").json()["items"]] == ["MS-1"]
    changed = program.request("PATCH", path, json={"weight_kg": 70})
    assert (changed.json()["weight_kg"], changed.json()["height_m"]) == (70, 1.7)
    gone = program.request("DELETE", path)
    assert (gone.status_code, gone.content) == (204, b"")
    assert program.get(path).status_code == 404
    assert program.get("/api/v1/patients").json()["total"] == 0


def test_a_code_is_given_once(house: House) -> None:
    program = house.program(house.alice)
    program.post("/api/v1/patients", json={"code": "MS-1"})
    again = program.post("/api/v1/patients", json={"code": "MS-1"})
    assert again.status_code == 409
    assert again.headers["content-type"] == "application/problem+json"


def test_a_change_on_an_old_version_is_refused(house: House) -> None:
    program = house.program(house.alice)
    path = f"/api/v1/patients/{house.patient(house.alice).id}"
    seen = program.get(path).headers["etag"]
    first = program.request("PATCH", path, json={"note": "one"}, headers={"If-Match": seen})
    second = program.request("PATCH", path, json={"note": "two"}, headers={"If-Match": seen})
    assert (first.status_code, second.status_code) == (200, 409)
    assert first.headers["etag"] != seen
    assert program.get(path).json()["note"] == "one"


def test_the_list_comes_in_pages(house: House) -> None:
    for number in range(5):
        house.patient(house.alice, f"P-{number}")
    page = house.program(house.alice).get("/api/v1/patients?limit=2&offset=2").json()
    assert ([p["code"] for p in page["items"]], page["total"]) == (["P-2", "P-3"], 5)


def test_a_real_walk_gives_the_same_result_by_rest_by_zip_and_by_form(house: House, data_dir: Path) -> None:
    patient, files = house.patient(house.alice), real_trial(data_dir)
    program, browser = house.program(house.alice), house.browser(house.alice)
    single = program.post(f"/api/v1/patients/{patient.id}/sessions", data=DATA, files=as_uploads(files))
    assert single.status_code == 201, single.text
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for file in files.values():
            archive.writestr(file.name, file.content)
    packed = program.post(
        f"/api/v1/patients/{patient.id}/sessions",
        data=DATA,
        files={"recording": ("w.zip", buffer.getvalue())},
    )
    form = browser.post(
        f"/patients/{patient.id}/sessions/new", {**DATA, "course_m": ""}, files=as_choice(files.values())
    )
    assert form.status_code == 303
    trials = [one.json()["trials"][0]["id"] for one in (single, packed)]
    by_form = program.get(f"/api/v1{form.headers['location']}").json()["trials"][0]["id"]
    texts = {program.get(f"/api/v1/trials/{trial}/result.json").text for trial in (*trials, by_form)}
    texts.add(browser.get(f"/trials/{by_form}/result.json").text)
    assert len(texts) == 1
    result = Result.model_validate_json(texts.pop())
    assert {given.name for given in result.provenance.inputs} == {"1-1_lf.txt", "1-1_rf.txt"}
    speed = result.parameter("steady_speed")
    assert speed is not None
    assert speed.value is not None
    assert 0.5 < speed.value < 2.5


def test_a_session_answers_with_its_location_its_parameters_and_its_files(house: House) -> None:
    patient, program = house.patient(house.alice), house.program(house.alice)
    files = short_walk()
    answer = program.post(f"/api/v1/patients/{patient.id}/sessions", data=DATA, files=as_uploads(files))
    session = answer.json()
    assert answer.headers["location"] == f"/api/v1/sessions/{session['id']}"
    assert program.get(answer.headers["location"]).json() == session
    assert session["course_m"] == 7.62
    trial = session["trials"][0]
    assert {file["placement"]: file["sha256"] for file in trial["files"]} == {
        p: f.sha256 for p, f in files.items()
    }
    result = program.get(trial["result_url"]).json()
    assert result["schema"] == "gaitlab.result/1"
    assert trial["parameters"] == result["parameters"]
    assert program.get(f"/api/v1/trials/{trial['id']}").json() == trial
    listed = program.get(f"/api/v1/patients/{patient.id}/sessions").json()["items"]
    assert [(one["id"], one["n_trials"]) for one in listed] == [(session["id"], 1)]


def test_a_further_trial_is_numbered_on(house: House) -> None:
    patient, program = house.patient(house.alice), house.program(house.alice)
    session = house.session(house.alice, patient.id)
    answer = program.post(f"/api/v1/sessions/{session.id}/trials", files=as_uploads(short_walk(8.0)))
    assert answer.status_code == 201
    assert answer.json()["number"] == 2
    assert program.get(answer.headers["location"]).json()["session_id"] == session.id
    assert [t["number"] for t in program.get(f"/api/v1/sessions/{session.id}").json()["trials"]] == [1, 2]


def test_the_report_comes_as_page_and_as_pdf_with_the_result_attached(house: House) -> None:
    patient, program = house.patient(house.alice, "MS-77"), house.program(house.alice)
    session = house.session(house.alice, patient.id)
    page = program.get(f"/api/v1/sessions/{session.id}/report.html")
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert "MS-77" in page.text
    pdf = program.get(f"/api/v1/sessions/{session.id}/report.pdf")
    assert pdf.headers["content-type"] == "application/pdf"
    reader = PdfReader(io.BytesIO(pdf.content))
    assert "MS-77" in "".join(p.extract_text() for p in reader.pages)
    attached = json.loads(reader.attachments["result.json"][0])
    assert attached == program.get(f"/api/v1/trials/{session.trials[0].id}/result.json").json()


def test_the_series_has_the_fixed_columns(house: House) -> None:
    session = house.session(house.alice, house.patient(house.alice).id)
    answer = house.program(house.alice).get(f"/api/v1/trials/{session.trials[0].id}/series.csv")
    assert answer.headers["content-type"].startswith("text/csv")
    lines = answer.text.splitlines()
    assert lines[0] == ("placement,t_s,lost,rest,ax_mps2,ay_mps2,az_mps2,vx_mps,vy_mps,vz_mps,px_m,py_m,pz_m")
    assert {line.split(",")[0] for line in lines[1:]} == {"left_foot", "right_foot"}


def test_a_repeated_request_with_the_same_key_makes_one_session(house: House) -> None:
    patient = house.patient(house.alice)
    token = house.program(house.alice)
    answers = [
        token.post(
            f"/api/v1/patients/{patient.id}/sessions",
            data=DATA,
            files=as_uploads(short_walk()),
            headers={"Idempotency-Key": "k-1"},
        )
        for _ in range(3)
    ]
    assert [answer.status_code for answer in answers] == [201, 201, 201]
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len({answer.headers["location"] for answer in answers}) == 1
    assert house.n_sessions(patient.id) == 1
    other = token.post(
        f"/api/v1/patients/{patient.id}/sessions",
        data=DATA,
        files=as_uploads(short_walk(8.0)),
        headers={"Idempotency-Key": "k-1"},
    )
    assert (other.status_code, other.json()["code"]) == (422, "idempotency_key_reused")
    assert house.n_sessions(patient.id) == 1


@pytest.mark.parametrize("key", ["x" * 65, "with blank", "ä", ""])
def test_a_key_that_cannot_be_one_is_refused(house: House, key: str) -> None:
    patient = house.patient(house.alice)
    answer = house.program(house.alice).post(
        f"/api/v1/patients/{patient.id}/sessions",
        data=DATA,
        files=as_uploads(short_walk()),
        headers={b"Idempotency-Key": key.encode("latin-1")},
    )
    assert answer.status_code == 422
    assert house.n_sessions(patient.id) == 0
