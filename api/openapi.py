"""The OpenAPI document: what FastAPI derives, and beside it policies, problem documents and files."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import iter_route_contexts

from api.errors import Problem
from api.policy import Policy, policy_of

Document = dict[str, Any]

_EXAMPLES: dict[str, dict[str, Any]] = {
    "401": {"code": "not_logged_in", "detail": "The token is missing, wrong, expired or revoked."},
    "403": {"code": "not_allowed", "detail": "Your account or token may not do this."},
    "404": {"code": "not_found", "detail": "There is no such thing."},
    "409": {"code": "conflict", "detail": "The request contradicts what is stored."},
    "413": {"code": "too_large", "detail": "The request is larger than its limit."},
    "422": {
        "code": "not_a_number",
        "detail": "“abc” is not a number.",
        "hint": "Export the file again.",
        "file": "walk_lf.txt",
        "line": 12,
        "column": "Acc_X",
    },
}
_TITLES = {
    "401": "Unauthorized",
    "403": "Forbidden",
    "404": "Not Found",
    "409": "Conflict",
    "413": "Content Too Large",
    "422": "Unprocessable Content",
}
_MEDIA_OF_FILES = {
    ".html": "text/html",
    ".pdf": "application/pdf",
    ".csv": "text/csv",
}


def document(app: FastAPI) -> Document:
    """Build the OpenAPI document of all routes under ``/api/v1``."""
    doc: Document = get_openapi(
        title=app.title, version=app.version, description=app.description, routes=app.routes
    )
    schemas = doc.setdefault("components", {}).setdefault("schemas", {})
    for generated in ("HTTPValidationError", "ValidationError"):
        schemas.pop(generated, None)
    problem = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas.update(problem.pop("$defs", {}))
    schemas["Problem"] = problem
    doc["components"]["securitySchemes"] = {"token": {"type": "http", "scheme": "bearer"}}
    doc["security"] = [{"token": []}]
    policies = _policies(app)
    for path, operations in doc["paths"].items():
        for method, operation in operations.items():
            _complete(operation, path, method, policies[path, method])
    return doc


def _policies(app: FastAPI) -> dict[tuple[str, str], Policy]:
    found = {}
    for context in iter_route_contexts(app.routes):
        policy = policy_of(context.endpoint) if context.endpoint else None
        for method in context.methods or ():
            if policy is not None and context.path is not None:
                found[context.path, method.lower()] = policy
    return found


def _complete(operation: Document, path: str, method: str, policy: Policy) -> None:
    operation["x-permission"] = policy.permission
    statuses = ["401", "403"]
    if "{" in path:
        statuses.append("404")
    if method in ("post", "patch"):
        statuses += ["409", "413", "422"]
    elif operation.get("parameters"):
        statuses.append("422")
    operation["responses"].pop("422", None)
    operation["responses"].update({status: _problem_response(status) for status in statuses})
    media = next((media for ending, media in _MEDIA_OF_FILES.items() if path.endswith(ending)), None)
    if media is not None:
        operation["responses"]["200"]["content"] = {media: {"schema": {"type": "string"}}}


def _problem_response(status: str) -> Document:
    example = {"type": "about:blank", "title": _TITLES[status], "status": int(status), **_EXAMPLES[status]}
    content = {"schema": {"$ref": "#/components/schemas/Problem"}, "example": example}
    return {"description": _TITLES[status], "content": {"application/problem+json": content}}
