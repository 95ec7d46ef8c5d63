"""What went wrong, told over HTTP: one table of statuses, RFC 9457 for programs, a page for people."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from api.call import trace_of
from gaitlab import errors


class RequestRefused(errors.GaitlabError):
    """The request itself is not one this server answers, whoever sends it."""


class UnsupportedBody(errors.GaitlabError):
    """The body comes in a form that is not taken."""


STATUS: Mapping[type[errors.GaitlabError], int] = {
    errors.TooLarge: 413,
    errors.InputError: 422,
    errors.NotAllowed: 403,
    errors.NotLoggedIn: 401,
    errors.NotFound: 404,
    errors.Conflict: 409,
    errors.TooManyAttempts: 429,
    errors.Misconfigured: 503,
    RequestRefused: 400,
    UnsupportedBody: 415,
}

_HTTP_WORDS: Mapping[int, tuple[str, str, str]] = {
    400: ("bad_request", "The request could not be read.", "Check how its body is made up."),
    404: ("not_found", "There is no such page.", "Check the address, or start from the list of patients."),
    405: (
        "method_not_allowed",
        "This address does not take this kind of request.",
        "See /docs for what it takes.",
    ),
    413: ("too_large", "The request is larger than its limit.", "Send fewer or smaller files."),
}


class FieldProblem(BaseModel):
    """One field of a request that cannot be used."""

    field: str
    message: str


class Problem(BaseModel):
    """A problem document (RFC 9457); ``file``, ``line`` and ``column`` point into the caller's own data."""

    type: str = "about:blank"
    title: str
    status: int
    code: str = Field(description="Stable machine-readable name of the problem.")
    detail: str = Field(description="What is wrong, in one sentence.")
    hint: str = Field(default="", description="What to do about it.")
    file: str | None = Field(default=None, description="Name of the file as it was sent.")
    line: int | None = Field(default=None, description="Line in that file, counted from 1.")
    column: str | None = Field(default=None, description="Heading of the column, or name of the form field.")
    errors: list[FieldProblem] = Field(default_factory=list, description="Each field that cannot be used.")
    request_id: str = Field(default="", description="Name of this request in the server's log.")

    @property
    def place(self) -> str:
        """Where the problem is, for people."""
        return errors.InputError("", "", file=self.file, line=self.line, column=self.column).place


ErrorPage = Callable[[Request, Problem], Response]


def status_of(error: errors.GaitlabError) -> int:
    """Status of an error: that of the nearest class in the table."""
    return next((STATUS[kind] for kind in type(error).__mro__ if kind in STATUS), 500)


def problem_of(error: Exception) -> Problem:
    """Tell any exception without its internals."""
    if isinstance(error, errors.GaitlabError):
        return _of_gaitlab_error(error)
    if isinstance(error, RequestValidationError):
        return _of_validation(error.errors())
    if isinstance(error, HTTPException):
        code, detail, hint = _HTTP_WORDS.get(error.status_code, ("refused", "The request was refused.", ""))
        if error.status_code == 413 and error.detail != HTTPStatus(413).phrase:
            detail = error.detail
        return _problem(error.status_code, code, detail, hint)
    return _problem(
        500,
        "internal_error",
        "Something went wrong inside gaitlab; it is not your fault.",
        "Try again; if it happens again, give the request number to the person who runs this installation.",
    )


def _of_gaitlab_error(error: errors.GaitlabError) -> Problem:
    problem = _problem(status_of(error), error.code, error.message, error.hint)
    if isinstance(error, errors.InputError):
        problem = problem.model_copy(update={"file": error.file, "line": error.line, "column": error.column})
    return problem


def _of_validation(found: Sequence[Any]) -> Problem:
    if any(one["loc"] and one["loc"][0] == "path" for one in found):
        return _of_gaitlab_error(errors.NotFound("not_found", "There is no such thing."))
    fields = [
        FieldProblem(field=".".join(map(str, one["loc"][1:])), message=_sentence(one["msg"])) for one in found
    ]
    first = fields[0]
    problem = _problem(
        422, "invalid_request", f"{first.field}: {first.message}" if first.field else first.message
    )
    return problem.model_copy(update={"errors": fields, "column": first.field or None})


def _sentence(text: str) -> str:
    text = text.removeprefix("Value error, ")
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def _problem(status: int, code: str, detail: str, hint: str = "") -> Problem:
    return Problem(title=HTTPStatus(status).phrase, status=status, code=code, detail=detail, hint=hint)


def wants_problem_document(request: Request) -> bool:
    """Is the other side a program? Decides only the shape of an error, never who may do what."""
    accept = request.headers.get("accept", "")
    return request.scope["path"].startswith("/api/") or ("json" in accept and "text/html" not in accept)


def problem_response(request: Request, error: Exception, page: ErrorPage) -> Response:
    """Answer with a problem document or with a page."""
    problem = problem_of(error).model_copy(update={"request_id": trace_of(request).request_id})
    if wants_problem_document(request):
        response: Response = JSONResponse(
            problem.model_dump(mode="json"), problem.status, media_type="application/problem+json"
        )
    else:
        response = page(request, problem)
    if isinstance(error, HTTPException):
        response.headers.update({k: v for k, v in (error.headers or {}).items() if k.lower() == "allow"})
    if problem.status == 401 and request.scope["path"].startswith("/api/"):
        response.headers["WWW-Authenticate"] = "Bearer"
    return response


def install(app: FastAPI, page: ErrorPage) -> None:
    """Tell every expected exception through ``problem_response``; the unexpected are caught further out."""

    async def tell(request: Request, error: Exception) -> Response:
        return problem_response(request, error, page)

    for kind in (errors.GaitlabError, RequestValidationError, HTTPException):
        app.add_exception_handler(kind, tell)
