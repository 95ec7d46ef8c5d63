"""The pages: HTML for people, thin over the clinic; POST, redirect, GET."""

from api.web import account, comparison, docs, patients, sessions, site, tokens, upload
from api.web.templates import error_page

ROUTERS = (
    account.router,
    patients.router,
    upload.router,
    sessions.router,
    comparison.router,
    tokens.router,
    site.router,
    docs.router,
)

__all__ = ["ROUTERS", "error_page"]
