"""The upload form without JavaScript, and what its script asks for."""

from __future__ import annotations

import io
import zipfile
from typing import Any

from bs4 import BeautifulSoup

from gaitlab.recording import InputFile, Placement
from tests.api.test_problems import line_changed
from tests.api.visitors import House, Visitor, as_choice, soup
from tests.recordings import short_walk

TYPED = {"date": "2026-11-20", "test": "walk", "course_m": "", "note": "typed & kept"}
LEFT, RIGHT = short_walk()[Placement.LEFT_FOOT], short_walk()[Placement.RIGHT_FOOT]
JSON = {"Accept": "application/json"}


def send(browser: Visitor, patient_id: str, files: Any, **more: Any) -> Any:
    headers = more.pop("headers", {})
    return browser.post(
        f"/patients/{patient_id}/sessions/new", {**TYPED, **more}, files=files, headers=headers
    )


def kept(page: BeautifulSoup) -> dict[str, str]:
    """What stands in the form's fields."""
    values = {
        str(i["name"]): str(i.get("value", "")) for i in page.select("form[data-session-form] input[name]")
    }
    values["note"] = page.select_one("textarea[name=note]").get_text().strip()  # type: ignore[union-attr]
    values["test"] = str(page.select_one("select[name=test] option[selected]")["value"])  # type: ignore[index]
    return values


def test_the_form_is_ready_with_today_and_a_key_of_its_own(house: House) -> None:
    path = f"/patients/{house.patient(house.alice).id}/sessions/new"
    browser = house.browser(house.alice)
    first, second = kept(browser.soup(path)), kept(browser.soup(path))
    assert first["date"][:2] == "20"
    assert first["test"] == "t25fw"
    assert len(first["idempotency_key"]) >= 20
    assert first["idempotency_key"] != second["idempotency_key"]


def test_several_files_become_a_session_with_the_placements_of_their_names(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    answer = send(browser, patient.id, as_choice([RIGHT, LEFT]))
    assert answer.status_code == 303
    page = browser.soup(answer.headers["location"])
    rows = {th.get_text(): th.find_next("td").get_text() for th in page.select(".files-table tbody th")}  # type: ignore[union-attr]
    assert rows == {"left foot": LEFT.name, "right foot": RIGHT.name}
    assert "typed & kept" in page.get_text()


def test_one_zip_becomes_a_session(house: House) -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for file in (LEFT, RIGHT):
            archive.writestr(f"trial 1/{file.name}", file.content)
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    answer = send(browser, patient.id, [("files", ("walk.zip", buffer.getvalue()))])
    assert answer.status_code == 303


def test_the_course_length_follows_the_test_where_it_is_left_empty(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    for test, told in (("t25fw", "7.62 m"), ("10mwt", "10 m"), ("walk", "")):
        answer = send(browser, patient.id, as_choice([LEFT, RIGHT]), test=test)
        lead = browser.soup(answer.headers["location"]).select_one(".lead")
        assert lead is not None
        assert (f"course {told}" in lead.get_text()) if told else ("course" not in lead.get_text())
    typed = send(browser, patient.id, as_choice([LEFT, RIGHT]), test="10mwt", course_m="6,5")
    assert "course 6.5 m" in browser.get(typed.headers["location"]).text


def test_files_whose_placement_cannot_be_told_are_asked_for(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    nameless = [InputFile("one.txt", LEFT.content), InputFile("two.txt", RIGHT.content)]
    asked = send(browser, patient.id, as_choice(nameless))
    page = soup(asked)
    assert asked.status_code == 422
    assert house.n_sessions(patient.id) == 0
    names = [str(i["value"]) for i in page.select(".placements input[name=placed_name]")]
    assert names == ["one.txt", "two.txt"]
    assert "same files once more" in page.get_text()
    form = kept(page)
    assert (form["note"], form["test"], form["date"]) == ("typed & kept", "walk", "2026-11-20")
    answer = send(
        browser, patient.id, as_choice(nameless), placed_name=names, placed_as=["left_foot", "right_foot"]
    )
    assert answer.status_code == 303
    assert house.n_sessions(patient.id) == 1


def test_a_chosen_placement_goes_before_the_guess_and_a_file_can_be_left_out(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    more = InputFile("left_foot_again.txt", LEFT.content)
    answer = send(
        browser,
        patient.id,
        as_choice([LEFT, RIGHT, more]),
        placed_name=[LEFT.name, RIGHT.name, more.name],
        placed_as=["left_foot", "right_foot", "not_used"],
    )
    assert answer.status_code == 303
    assert len(browser.soup(answer.headers["location"]).select(".files-table tbody tr")) == 2


def test_two_files_of_one_name_are_refused(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    same = [InputFile("lf.txt", LEFT.content), InputFile("lf.txt", RIGHT.content)]
    answer = send(browser, patient.id, as_choice(same))
    assert answer.status_code == 422
    assert "Two files are called lf.txt." in answer.text
    assert house.n_sessions(patient.id) == 0


def test_a_placement_that_does_not_exist_is_refused(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    answer = send(browser, patient.id, as_choice([LEFT]), placed_name=[LEFT.name], placed_as=["left_elbow"])
    assert answer.status_code == 422
    assert "no such placement" in answer.text
    assert house.n_sessions(patient.id) == 0


def test_two_files_for_one_placement_are_named(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    answer = send(
        browser,
        patient.id,
        as_choice([LEFT, RIGHT]),
        placed_name=[LEFT.name, RIGHT.name],
        placed_as=["left_foot", "left_foot"],
    )
    assert answer.status_code == 422
    said = soup(answer).select_one(".notice.bad").get_text()  # type: ignore[union-attr]
    assert LEFT.name in said
    assert RIGHT.name in said
    assert "left foot" in said


def test_a_wrong_file_is_shown_with_its_place_and_what_was_typed_stays(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    broken = InputFile("walk_left_foot.txt", line_changed(LEFT.content, 12, 2, "abc"))
    answer = send(browser, patient.id, as_choice([broken, RIGHT]), test="10mwt", course_m="9.5")
    page = soup(answer)
    assert answer.status_code == 422
    notice = page.select_one(".notice.bad")
    assert notice is not None
    assert notice.select_one(".problem-place").get_text() == "walk_left_foot.txt, line 12, column Acc_Y"  # type: ignore[union-attr]
    assert "abc" in notice.get_text()
    form = kept(page)
    assert (form["note"], form["test"], form["course_m"]) == ("typed & kept", "10mwt", "9.5")
    assert house.n_sessions(patient.id) == 0


def test_wrong_details_are_said_beside_their_fields(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    for wrong, field in (
        ({"date": ""}, "date"),
        ({"date": "2999-01-01"}, "date"),
        ({"course_m": "far"}, "course_m"),
        ({"course_m": "0.5"}, "course_m"),
        ({"note": "n" * 2001}, "note"),
    ):
        answer = send(browser, patient.id, as_choice([LEFT, RIGHT]), **wrong)
        assert answer.status_code == 422
        assert soup(answer).select_one(f"#{field}-error") is not None, field
    answer = send(browser, patient.id, [("files", ("", b""))])
    assert soup(answer).select_one("#files-error") is not None
    assert house.n_sessions(patient.id) == 0


def test_pressing_twice_makes_one_session(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    key = kept(browser.soup(f"/patients/{patient.id}/sessions/new"))["idempotency_key"]
    answers = [send(browser, patient.id, as_choice([LEFT, RIGHT]), idempotency_key=key) for _ in range(2)]
    assert answers[0].headers["location"] == answers[1].headers["location"]
    assert house.n_sessions(patient.id) == 1
    other = send(browser, patient.id, as_choice([LEFT, RIGHT]), idempotency_key=key, note="another walk")
    assert other.status_code == 422
    assert soup(other).select_one(".notice.bad") is not None


def test_the_script_gets_the_new_address_or_a_problem_document(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    made = send(browser, patient.id, as_choice([LEFT, RIGHT]), headers=JSON)
    assert made.status_code == 201
    assert browser.get(made.json()["location"]).status_code == 200
    refused = send(browser, patient.id, as_choice([InputFile("lf.txt", b"")]), headers=JSON)
    assert (refused.status_code, refused.json()["file"]) == (422, "lf.txt")


def test_inspection_tells_each_file_and_each_wrong_one_and_stores_nothing(house: House) -> None:
    patient, browser = house.patient(house.alice), house.browser(house.alice)
    broken = InputFile("bad_lf.txt", line_changed(LEFT.content, 12, 2, "abc"))
    nameless = InputFile("sensor.txt", LEFT.content)
    answer = browser.post(
        f"/patients/{patient.id}/sessions/inspect", files=as_choice([RIGHT, broken, nameless]), headers=JSON
    )
    assert answer.status_code == 200
    told = {one["name"]: one for one in answer.json()["files"]}
    assert set(told) == {RIGHT.name, "sensor.txt"}
    assert told[RIGHT.name]["placement"] == "right_foot"
    assert "file name" in told[RIGHT.name]["why"]
    assert told["sensor.txt"]["placement"] is None
    assert told["sensor.txt"]["samples"] > 300
    assert told["sensor.txt"]["rate_hz"] == 100
    (problem,) = answer.json()["problems"]
    assert (problem["file"], problem["line"], problem["column"]) == ("bad_lf.txt", 12, "Acc_Y")
    assert house.n_sessions(patient.id) == 0


def test_an_earlier_choice_for_a_device_is_remembered(house: House) -> None:
    def worn(name: str, content: bytes, device: str) -> InputFile:
        return InputFile(name, f"// DeviceId: {device}\n".encode() + content)

    patient, browser = house.patient(house.alice), house.browser(house.alice)
    first = [worn("a.txt", LEFT.content, "00B40001"), worn("b.txt", RIGHT.content, "00B40002")]
    chosen = {"placed_name": ["a.txt", "b.txt"], "placed_as": ["left_foot", "right_foot"]}
    assert send(browser, patient.id, as_choice(first), **chosen).status_code == 303
    later = [worn("c.txt", LEFT.content, "00B40001"), worn("d.txt", RIGHT.content, "00B40002")]
    assert send(browser, patient.id, as_choice(later), note="the next day").status_code == 303


def test_a_further_trial_is_added_by_the_form(house: House) -> None:
    browser = house.browser(house.alice)
    session = house.session(house.alice, house.patient(house.alice).id)
    path = f"/sessions/{session.id}/trials/new"
    assert browser.soup(path).select_one("input[type=file]") is not None
    answer = browser.post(path, files=as_choice(short_walk(8.0).values()))
    assert answer.headers["location"] == f"/sessions/{session.id}?trial=2"
    page = browser.soup(answer.headers["location"])
    assert [a.get_text() for a in page.select(".trials a")] == ["Trial 1", "Trial 2"]
    wrong = browser.post(path, files=as_choice([InputFile("lf.txt", b"")]))
    assert (wrong.status_code, soup(wrong).select_one(".problem-place").get_text()) == (422, "lf.txt")  # type: ignore[union-attr]
