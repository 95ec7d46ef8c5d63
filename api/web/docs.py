"""The REST interface described: a page of our own, since the usual one loads its script from elsewhere."""

from __future__ import annotations

import json

from fastapi import APIRouter
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from api.call import CurrentCall
from api.guard import GuardedRoute
from api.openapi import Document, document
from api.policy import person_or_token
from api.web.templates import page

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)


@router.get("/openapi.json")
@person_or_token()
def openapi(request: Request) -> Response:
    return JSONResponse(document(request.app))


@router.get("/docs")
@person_or_token()
def docs(call: CurrentCall, request: Request) -> Response:
    doc = document(request.app)
    schemas: Document = doc["components"]["schemas"]
    operations = [
        _operation(path, method, operation, schemas)
        for path, methods in doc["paths"].items()
        for method, operation in methods.items()
    ]
    shown = [
        _schema(name, schema) for name, schema in sorted(schemas.items()) if not name.startswith("Body_")
    ]
    origin = str(request.base_url).rstrip("/")
    return page(call, "docs.html", doc=doc, operations=operations, schemas=shown, origin=origin)


def _operation(path: str, method: str, operation: Document, schemas: Document) -> Document:
    media, body = _first(operation.get("requestBody", {}).get("content", {}), ("", {}))
    return {
        "id": operation["operationId"],
        "method": method.upper(),
        "path": path,
        "words": operation["description"],
        "permission": operation["x-permission"],
        "parameters": [_parameter(one) for one in operation.get("parameters", [])]
        + [{**field, "in": media} for field in _body_fields(body, schemas)],
        "responses": [
            {
                "status": status,
                "words": answer["description"],
                "media": kind,
                "type": type_name(content.get("schema", {})),
            }
            for status, answer in sorted(operation["responses"].items())
            for kind, content in (answer.get("content") or {"": {}}).items()
        ],
        "curl": _curl(path, method, media, body),
    }


def _parameter(parameter: Document) -> Document:
    return {
        "name": parameter["name"],
        "in": parameter["in"],
        "type": type_name(parameter["schema"]),
        "required": parameter.get("required", False),
        "words": parameter.get("description", ""),
    }


def _body_fields(body: Document, schemas: Document) -> list[Document]:
    name = type_name(body.get("schema", {})) if body else ""
    return _schema(name, schemas[name])["fields"] if name in schemas else []


def _schema(name: str, schema: Document) -> Document:
    required = schema.get("required", ())
    return {
        "name": name,
        "words": schema.get("description", ""),
        "fields": [
            {
                "name": field,
                "type": type_name(spec),
                "required": field in required,
                "words": spec.get("description", ""),
            }
            for field, spec in schema.get("properties", {}).items()
        ],
    }


def type_name(schema: Document) -> str:
    """``list of Trial``, ``number or null``, ``“t25fw” or “walk”``: a JSON schema in a few words."""
    if "$ref" in schema:
        return str(schema["$ref"].rsplit("/", 1)[-1])
    if "anyOf" in schema:
        return " or ".join(type_name(one) for one in schema["anyOf"])
    if "enum" in schema:
        return " or ".join(f"“{value}”" for value in schema["enum"])
    if "const" in schema:
        return f"“{schema['const']}”"
    if schema.get("type") == "array":
        return f"list of {type_name(schema.get('items', {}))}"
    if schema.get("contentMediaType") or schema.get("format") == "binary":
        return "file"
    return str(schema.get("format") or schema.get("type", "any"))


def _curl(path: str, method: str, media: str, body: Document) -> str:
    """The operation as one would try it out in a shell."""
    parts = ['curl -H "Authorization: Bearer $TOKEN"' + ("" if method == "get" else f" -X {method.upper()}")]
    if media == "multipart/form-data":
        fields = ["left_foot=@lf.txt", "right_foot=@rf.txt"]
        if path.endswith("/sessions"):
            fields = ["date=2026-11-21", "test=t25fw", *fields]
        parts += ['-H "Idempotency-Key: $(uuidgen)"', *(f"-F {field}" for field in fields)]
    elif media:
        _, example = _first(body.get("examples", {}), ("", {"value": {"weight_kg": 71.5}}))
        parts += ["-H 'Content-Type: application/json'", f"-d '{json.dumps(example['value'])}'"]
    name = path.rsplit("/", 1)[-1]
    if "." in name:
        parts.append(f"-o {name}")
    return " \\\n  ".join([*parts, f'"$GAITLAB{_in_shell(path)}"'])


def _in_shell(path: str) -> str:
    """The path with a shell variable in the place of each identifier: ``/patients/$PATIENT``."""
    parts = path.split("/")
    return "/".join(
        "$" + part[1:-1].removesuffix("_id").upper() if part.startswith("{") else part for part in parts
    )


def _first(mapping: Document, otherwise: tuple[str, Document]) -> tuple[str, Document]:
    return next(iter(mapping.items()), otherwise)
