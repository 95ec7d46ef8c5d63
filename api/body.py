"""The body of a request as it comes: counted, cut off at its limit, and read as a form only if it is whole."""

from __future__ import annotations

from python_multipart.multipart import parse_options_header
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import Message, Receive

from api.errors import RequestRefused, UnsupportedBody

MAX_FILES = 64
MAX_FIELDS = 256
TAIL_BYTES = 256
"""So much of a body's end is kept: a boundary has at most 70 characters, and little may follow it."""
MULTIPART = "multipart/form-data"
FORMS = (MULTIPART, "application/x-www-form-urlencoded")


class Body:
    """Receives a body up to ``limit`` bytes and remembers how it ended.

    A declared length is believed only to refuse.
    """

    def __init__(self, receive: Receive, declared: str, limit: int) -> None:
        self._receive = receive
        self._limit = limit
        self._declared = int(declared) if declared.isdecimal() and len(declared) < 20 else 0
        self._seen = 0
        self.tail = b""

    async def receive(self) -> Message:
        """The next message of the request.

        Raises
        ------
        HTTPException
            413, if the body is larger than its limit or says it will be.
        """
        if self._declared > self._limit:
            raise self._too_large()
        message = await self._receive()
        part: bytes = message.get("body", b"")
        self._seen += len(part)
        if self._seen > self._limit:
            raise self._too_large()
        self.tail = (self.tail + part[-TAIL_BYTES:])[-TAIL_BYTES:]
        return message

    def _too_large(self) -> HTTPException:
        limit = f"{self._limit / 2**20:.3g} MiB" if self._limit >= 2**20 else f"{self._limit / 2**10:.3g} KiB"
        return HTTPException(413, f"The request is larger than its limit of {limit}.")


async def read_form(request: Request, body: Body, *, only_forms: bool) -> FormData:
    """Read the body of a form; the request keeps it, so nobody reads it twice.

    Raises
    ------
    UnsupportedBody
        If the route takes ``only_forms`` and something else came.
    RequestRefused
        If a multipart body ends before its closing boundary: the parser would drop the last file silently.
    """
    declared = request.headers.get("content-type", "")
    kind = declared.partition(";")[0].strip().lower()
    if kind not in FORMS:
        if only_forms and (kind or request.headers.get("content-length", "0") != "0"):
            raise UnsupportedBody(
                "not_a_form", "This address takes forms with files only.", f"Send the body as {MULTIPART}."
            )
        return FormData()
    form = await request.form(max_files=MAX_FILES, max_fields=MAX_FIELDS)
    if kind == MULTIPART:
        boundary = parse_options_header(declared)[1].get(b"boundary", b"")
        if b"--" + boundary + b"--" not in body.tail:
            raise RequestRefused("incomplete_body", "The upload was cut off; send it again.")
    return form
