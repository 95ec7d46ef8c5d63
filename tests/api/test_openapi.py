"""The OpenAPI document and its page describe what REST really does."""

from __future__ import annotations

import re
from typing import Any

import pytest
from fastapi.routing import iter_route_contexts

from api.app import create_app
from api.openapi import document
from api.policy import policy_of
from tests.api.visitors import House, soup

FIXED = {
    ("/api/v1/patients", "post"),
    ("/api/v1/patients", "get"),
    ("/api/v1/patients/{patient_id}", "get"),
    ("/api/v1/patients/{patient_id}", "patch"),
    ("/api/v1/patients/{patient_id}", "delete"),
    ("/api/v1/patients/{patient_id}/sessions", "post"),
    ("/api/v1/patients/{patient_id}/sessions", "get"),
    ("/api/v1/sessions/{session_id}/trials", "post"),
    ("/api/v1/sessions/{session_id}", "get"),
    ("/api/v1/sessions/{session_id}/report.html", "get"),
    ("/api/v1/sessions/{session_id}/report.pdf", "get"),
    ("/api/v1/trials/{trial_id}", "get"),
    ("/api/v1/trials/{trial_id}/result.json", "get"),
    ("/api/v1/trials/{trial_id}/series.csv", "get"),
    ("/api/v1/trials/{trial_id}/comparison", "get"),
}


@pytest.fixture(scope="module")
def doc() -> dict[str, Any]:
    return document(create_app())


def operations(doc: dict[str, Any]) -> dict[tuple[str, str], dict[str, Any]]:
    return {(path, method): op for path, methods in doc["paths"].items() for method, op in methods.items()}


def test_all_fixed_routes_and_no_pages_are_described(doc: dict[str, Any]) -> None:
    assert set(operations(doc)) == FIXED


def test_every_operation_says_what_it_does_who_may_and_what_can_go_wrong(doc: dict[str, Any]) -> None:
    for (path, method), operation in operations(doc).items():
        assert operation["description"].endswith(".")
        assert operation["x-permission"]
        for status in (
            "401",
            "403",
            *(["404"] if "{" in path else []),
            *(["422"] if method in ("post", "patch") else []),
        ):
            assert "application/problem+json" in operation["responses"][status]["content"], (
                path,
                method,
                status,
            )
        success = [status for status in operation["responses"] if status.startswith("2")]
        assert len(success) == 1


def test_the_permissions_told_are_those_asked_for(doc: dict[str, Any]) -> None:
    for context in iter_route_contexts(create_app().routes):
        if context.path and context.path.startswith("/api/") and context.endpoint:
            policy = policy_of(context.endpoint)
            for method in context.methods or ():
                assert policy is not None
                assert operations(doc)[context.path, method.lower()]["x-permission"] == policy.permission


def test_every_reference_leads_somewhere(doc: dict[str, Any]) -> None:
    found = set(re.findall(r"'\$ref': '#/components/schemas/([^']+)'", str(doc)))
    assert found
    assert found <= set(doc["components"]["schemas"])
    assert "HTTPValidationError" not in str(doc)


def test_the_upload_is_described_with_its_files(doc: dict[str, Any]) -> None:
    operation = operations(doc)["/api/v1/patients/{patient_id}/sessions", "post"]
    (media, body), *_ = operation["requestBody"]["content"].items()
    assert media == "multipart/form-data"
    fields = doc["components"]["schemas"][body["schema"]["$ref"].rsplit("/", 1)[-1]]["properties"]
    assert {
        "date",
        "test",
        "course_m",
        "left_foot",
        "right_foot",
        "left_knee",
        "right_knee",
        "recording",
    } <= set(fields)
    assert "Idempotency-Key" in {parameter["name"] for parameter in operation["parameters"]}


def test_the_problem_document_is_the_one_that_is_sent(house: House, doc: dict[str, Any]) -> None:
    problem = house.program(house.alice).post("/api/v1/patients", json={}).json()
    assert set(problem) == set(doc["components"]["schemas"]["Problem"]["properties"])


def test_the_page_shows_every_operation_to_people_and_to_tokens(house: House) -> None:
    answer = house.browser(house.alice).get("/docs")
    page = soup(answer)
    shown = {
        (code.get_text(), head.get_text().split()[0].lower())
        for head in page.select(".op h2")
        for code in head.select("code")
    }
    assert shown == FIXED
    assert house.program(house.alice).get("/docs").status_code == 200
    assert house.program(house.alice).get("/openapi.json").json()["openapi"].startswith("3.")


def test_the_answers_have_the_documented_shape(house: House, doc: dict[str, Any]) -> None:
    session = house.session(house.alice, house.patient(house.alice).id)
    answer = house.program(house.alice).get(f"/api/v1/sessions/{session.id}").json()
    schema = doc["components"]["schemas"]["Session"]
    assert set(answer) == set(schema["properties"])
    assert set(answer["trials"][0]) == set(doc["components"]["schemas"]["Trial"]["properties"])
