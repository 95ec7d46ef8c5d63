"""Help, health and static files."""

from __future__ import annotations

from fastapi import APIRouter
from starlette.responses import JSONResponse, Response

from api.call import CurrentCall
from api.guard import GuardedRoute
from api.policy import open_to_all, person
from api.web.templates import page, static_file
from gaitlab.errors import NotFound
from gaitlab.recording.file import LIMITS

router = APIRouter(include_in_schema=False, route_class=GuardedRoute)

STATIC = {"app.css": "text/css", "upload.js": "text/javascript", "icon.svg": "image/svg+xml"}
"""All files that are served as they are; there is no folder to walk out of."""

_ASSETS = "Style, script and icon hold nothing of anybody, and the log-in page needs them."
_PROBES = "A supervisor asks without an account, and learns nothing but yes or no."


@router.get("/help")
@person()
def show_help(call: CurrentCall) -> Response:
    return page(call, "help.html", limits=LIMITS, clinic=call.clinic.settings)


@router.get("/health/live")
@open_to_all(_PROBES)
async def live() -> Response:
    return JSONResponse({"status": "live"})


@router.get("/health/ready")
@open_to_all(_PROBES)
def ready(call: CurrentCall) -> Response:
    is_ready = call.clinic.ready()
    return JSONResponse({"status": "ready" if is_ready else "not ready"}, 200 if is_ready else 503)


@router.get("/static/{name}")
@open_to_all(_ASSETS)
async def static(name: str, v: str = "") -> Response:
    if name not in STATIC:
        raise NotFound("not_found", "There is no such file.")
    content, digest = static_file(name)
    cache = "public, max-age=31536000, immutable" if v == digest else "no-cache"
    return Response(content, media_type=STATIC[name], headers={"Cache-Control": cache, "ETag": f'"{digest}"'})


@router.get("/favicon.ico")
@open_to_all(_ASSETS)
async def favicon() -> Response:
    return await static("icon.svg")
