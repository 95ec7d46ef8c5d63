"""Requests that change something must come from our own pages: Fetch Metadata, Origin, a token per form."""

from __future__ import annotations

import hmac
from urllib.parse import urlsplit

from starlette.requests import Request

from gaitlab.errors import NotAllowed

SAFE_METHODS = frozenset({"GET", "HEAD"})
TOKEN_FIELD = "form_token"  # noqa: S105 (a field's name)
TOKEN_HEADER = "x-form-token"  # noqa: S105


def check_same_origin(request: Request) -> None:
    """Refuse a request that another site made a browser send.

    ``Sec-Fetch-Site`` decides where the browser sends it (https, and http on the loopback address); otherwise
    ``Origin`` must name our own host. A request with neither is refused: no browser sends one.

    Raises
    ------
    NotAllowed
        If the request does not come from our own pages.
    """
    site = request.headers.get("sec-fetch-site")
    if site is not None:
        allowed = site == "same-origin"
    else:
        host = request.headers.get("host", "")
        allowed = bool(host) and urlsplit(request.headers.get("origin", "")).netloc == host
    if not allowed:
        raise NotAllowed(
            "cross_site",
            "This request did not come from a page of this server, so nothing was changed.",
            "Open the page here and send the form again.",
        )


def check_form_token(expected: str, given: str) -> None:
    """Refuse a form that does not carry its web session's token.

    Raises
    ------
    NotAllowed
        If the token is missing or another session's.
    """
    if not expected or not hmac.compare_digest(expected.encode(), given.encode()):
        raise NotAllowed(
            "form_token",
            "This form belongs to another or an ended log-in, so nothing was changed.",
            "Go back, reload the page and send the form again.",
        )
