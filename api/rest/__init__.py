"""REST under ``/api/v1``: thin over the clinic, JSON in and out, bearer tokens."""

from api.rest import patients, sessions, trials

ROUTERS = (patients.router, sessions.router, trials.router)
