"""The web application: one factory, everything guarded."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import FastAPI

from api import errors, guard, rest, web
from api.middleware import Envelope
from api.settings import WebSettings
from gaitlab import __version__
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.settings import ClinicSettings

DESCRIPTION = (
    "Store the recordings of a walk under a patient and get the gait parameters, each with its uncertainty "
    "and its evidence. Every request carries `Authorization: Bearer TOKEN`; "
    "problems come as `application/problem+json`."
)


def create_app(clinic: Clinic | None = None, settings: WebSettings | None = None) -> FastAPI:
    """Build the application: ``uvicorn api.app:create_app --factory``.

    Parameters
    ----------
    clinic : Clinic, optional
        An open clinic, which stays the caller's to close; without it one is opened from the environment and
        closed with the application.
    settings : WebSettings, optional
        How the pages are reached; without it they are read from the environment.

    Raises
    ------
    Misconfigured
        If any route has no policy.
    """
    web_settings = settings or WebSettings.from_environment()

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        if clinic is not None:
            yield
            return
        app.state.clinic = Clinic.open(ClinicSettings.from_environment())
        try:
            yield
        finally:
            app.state.clinic.close()

    app = FastAPI(
        title="gaitlab",
        version=__version__,
        description=DESCRIPTION,
        lifespan=lifespan,
        # The framework's own pages know no policy and load scripts from elsewhere; ours are in api.web.docs.
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
    )
    app.state.clinic = clinic
    app.state.web = web_settings
    errors.install(app, web.error_page)
    for router in (*rest.ROUTERS, *web.ROUTERS):
        app.include_router(router)
    app.add_middleware(Envelope, web=web_settings, page=web.error_page)
    guard.audit(app)
    return app
