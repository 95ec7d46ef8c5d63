"""The list of patients, one patient, and the form."""

from __future__ import annotations

import pytest

from tests.api.visitors import House, soup

FULL = {
    "code": "MS-7",
    "sex": "female",
    "birth_year": "1971",
    "height_cm": "168,5",
    "weight_kg": "64.5",
    "leg_length_cm": "86",
    "diagnosis": "RRMS",
    "note": "first line\r\nsecond line",
}


def test_an_empty_list_says_what_to_do(house: House) -> None:
    assert "Add the first patient" in house.browser(house.alice).get("/").text
    reader = house.browser(house.bob).get("/").text
    assert "Add the first patient" not in reader
    assert "may read" in reader


def test_a_patient_is_added_in_centimetres_and_stored_in_metres(house: House) -> None:
    browser = house.browser(house.alice)
    made = browser.post("/patients/new", FULL)
    assert made.status_code == 303
    page = browser.soup(made.headers["location"]).get_text(" ")
    for shown in ("MS-7", "RRMS", "1971", "168.5 cm", "64.5 kg", "86 cm", "second line"):
        assert shown in page
    stored = house.program(house.alice).get(f"/api/v1{made.headers['location']}").json()
    assert (stored["height_m"], stored["leg_length_m"], stored["weight_kg"]) == (1.685, 0.86, 64.5)


def test_the_edit_form_shows_what_was_typed_and_changes_it(house: House) -> None:
    browser = house.browser(house.alice)
    path = browser.post("/patients/new", FULL).headers["location"]
    form = browser.soup(f"{path}/edit")
    shown = {str(i["name"]): str(i["value"]) for i in form.select("main form.grid input")}
    assert (shown["height_cm"], shown["leg_length_cm"], shown["weight_kg"]) == ("168.5", "86", "64.5")
    answer = browser.post(f"{path}/edit", {**FULL, "version": shown["version"], "weight_kg": "70"})
    assert (answer.status_code, answer.headers["location"]) == (303, path)
    assert "70 kg" in browser.get(path).text


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"code": "  "}, "code"),
        ({"code": "x" * 65}, "code"),
        ({"birth_year": "71"}, "birth_year"),
        ({"birth_year": "long ago"}, "birth_year"),
        ({"height_cm": "1.68"}, "height_cm"),
        ({"height_cm": "tall"}, "height_cm"),
        ({"height_cm": "1e999999999"}, "height_cm"),
        ({"height_cm": "1_70"}, "height_cm"),
        ({"height_cm": "1e0"}, "height_cm"),
        ({"weight_kg": "7_0"}, "weight_kg"),
        ({"weight_kg": "1"}, "weight_kg"),
        ({"weight_kg": "nan"}, "weight_kg"),
        ({"leg_length_cm": "860"}, "leg_length_cm"),
        ({"diagnosis": "d" * 201}, "diagnosis"),
        ({"sex": "both"}, "sex"),
    ],
)
def test_a_wrong_field_says_so_beside_it_and_everything_typed_is_kept(
    house: House, wrong: dict[str, str], field: str
) -> None:
    browser = house.browser(house.alice)
    answer = browser.post("/patients/new", {**FULL, **wrong})
    page = soup(answer)
    assert answer.status_code == 422
    error = page.select_one(f"#{field}-error")
    assert error is not None
    assert error.get_text(strip=True).endswith(".")
    marked = page.select_one(f"#{field}")
    assert marked is not None
    assert marked["aria-invalid"] == "true"
    assert f"{field}-error" in str(marked["aria-describedby"])
    for name in {"birth_year", "height_cm", "weight_kg", "leg_length_cm", "diagnosis"} - {field}:
        assert page.select_one(f"input[name={name}]")["value"] == FULL[name]  # type: ignore[index]
    assert "second line" in page.select_one("textarea").get_text()  # type: ignore[union-attr]
    assert "No patients yet" in browser.get("/").text


def test_a_code_in_use_is_said_beside_the_code(house: House) -> None:
    browser = house.browser(house.alice)
    browser.post("/patients/new", FULL)
    again = browser.post("/patients/new", FULL)
    assert again.status_code == 409
    assert soup(again).select_one("#code-error") is not None


def test_a_change_on_an_old_version_is_said_and_what_was_typed_is_kept(house: House) -> None:
    browser = house.browser(house.alice)
    path = browser.post("/patients/new", FULL).headers["location"]
    version = str(browser.soup(f"{path}/edit").select_one("input[name=version]")["value"])  # type: ignore[index]
    browser.post(f"{path}/edit", {**FULL, "version": version, "note": "somebody was faster"})
    late = browser.post(f"{path}/edit", {**FULL, "version": version, "note": "I was slower"})
    assert late.status_code == 409
    assert soup(late).select_one(".notice.bad") is not None
    assert "I was slower" in late.text
    assert "somebody was faster" in browser.get(path).text


@pytest.mark.parametrize("version", ["", "none", "-1", "9" * 5000])
def test_a_change_without_a_version_is_refused_and_never_skips_the_check(house: House, version: str) -> None:
    browser = house.browser(house.alice)
    path = browser.post("/patients/new", FULL).headers["location"]
    answer = browser.post(f"{path}/edit", {**FULL, "version": version, "note": "unchecked"})
    assert answer.status_code == 409
    assert "unchecked" not in browser.get(path).text


def test_the_list_can_be_searched_and_turned(house: House) -> None:
    for number in range(30):
        house.patient(house.alice, f"MS-{number:02}")
    browser = house.browser(house.alice)
    first = browser.soup("/")
    assert len(first.select("tbody tr")) == 25
    following = first.select_one("a[rel=next]")
    assert following is not None
    second = browser.soup(str(following["href"]))
    assert len(second.select("tbody tr")) == 5
    assert second.select_one("a[rel=prev]") is not None
    found = browser.soup("/?query=s-1")
    assert [a.get_text() for a in found.select("tbody th a")] == [f"MS-{n}" for n in range(10, 20)]
    assert "No code contains “zz”" in browser.get("/?query=zz").text
    assert browser.get("/?page=9").headers["location"] == "/"


def test_a_hidden_patient_is_gone_from_the_pages(house: House) -> None:
    browser = house.browser(house.alice)
    path = browser.post("/patients/new", FULL).headers["location"]
    assert browser.post(f"{path}/delete", {"reason": "wrong person"}).headers["location"] == "/"
    assert browser.get(path).status_code == 404
    assert "MS-7" not in browser.get("/").text


def test_a_reader_sees_no_buttons_that_they_may_not_press(house: House) -> None:
    patient = house.patient(house.alice)
    session = house.session(house.alice, patient.id)
    browser = house.browser(house.bob)
    for path in (f"/patients/{patient.id}", f"/sessions/{session.id}"):
        links = {str(a["href"]) for a in browser.soup(path).select("main a[href]")}
        actions = {str(form["action"]) for form in browser.soup(path).select("main form")}
        assert not [link for link in links if link.endswith(("/new", "/edit"))]
        assert not actions


MARKUP = "<img src=x onerror=alert(1)>\"'&{{7*7}}</textarea><script>alert(2)</script>"


def test_markup_in_any_field_is_shown_as_text(house: House) -> None:
    browser = house.browser(house.alice)
    short = '<b onclick="x">&{{7*7}}'
    path = browser.post(
        "/patients/new", {**FULL, "code": short, "diagnosis": MARKUP, "note": MARKUP}
    ).headers["location"]
    session = house.session(house.alice, path.rsplit("/", 1)[-1], note=MARKUP)
    pages = (
        "/",
        path,
        f"{path}/edit",
        f"{path}/sessions/new",
        f"/sessions/{session.id}",
        f"/sessions/{session.id}/trials/new",
    )
    for where in (*pages, f"/?query={'<script>'}"):
        answer = browser.get(where)
        page = soup(answer)
        assert not page.select("img[onerror], b[onclick], main script")
        assert "49" not in page.select_one("h1").get_text()  # type: ignore[union-attr]
    assert short in browser.soup(path).select_one("h1").get_text()  # type: ignore[union-attr]
    report = browser.get(f"/sessions/{session.id}/report.html").text
    assert "<img src=x" not in report
    assert "<script" not in report
