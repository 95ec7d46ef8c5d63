"""Start the server the way a clinic can leave it running."""

from __future__ import annotations

import importlib
import ipaddress
import logging
import socket
import sys
import threading

import uvicorn

from api.app import create_app
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.settings import ClinicSettings
from gaitlab.errors import Misconfigured


def serve(
    settings: ClinicSettings,
    host: str = "127.0.0.1",
    port: int = 8000,
    behind_proxy: bool = False,
    *,
    web: WebSettings | None = None,
) -> None:
    """Open the clinic and answer until stopped; prints the one-time code where there is no account yet.

    Parameters
    ----------
    behind_proxy : bool
        A proxy on this machine speaks TLS: its ``X-Forwarded-For`` is believed, cookies are ``Secure``.

    Raises
    ------
    Misconfigured
        If ``host`` is reachable from other machines and there is no account yet, or no proxy that speaks TLS; if the
        port is taken.
    """
    web = web or WebSettings.from_environment()
    if behind_proxy and not web.behind_tls:
        web = WebSettings(True, web.allowed_hosts, web.small_body_bytes)
    clinic = Clinic.open(settings)
    try:
        check_exposure(host, behind_proxy=behind_proxy, has_account=not accounts.needs_setup(clinic))
        with _listen(host, port) as listener:
            _announce(clinic, host, port)
            threading.Thread(target=_warm_up, daemon=True).start()
            _log_to_stderr()
            config = uvicorn.Config(
                create_app(clinic, web),
                log_config=None,
                access_log=False,  # it would write URLs; api.middleware writes the route's template
                server_header=False,
                proxy_headers=behind_proxy,
                forwarded_allow_ips="127.0.0.1,::1",
            )
            uvicorn.Server(config).run(sockets=[listener])
    finally:
        clinic.close()


def _listen(host: str, port: int) -> socket.socket:
    """Take the port before anything is announced: a second server must not replace the first one's set-up code."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host.strip("[]"), port))
        listener.listen(128)
    except OSError as error:
        listener.close()
        raise Misconfigured(
            "cannot_listen",
            f"Cannot listen on {host}, port {port}: {error.strerror or 'the address is not known'}.",
            "Stop whatever uses the port (perhaps another gaitlab serve), or choose another with --port.",
        ) from None
    return listener


def check_exposure(host: str, *, behind_proxy: bool, has_account: bool) -> None:
    """Refuse to be reachable from other machines without an account and without TLS in front.

    Raises
    ------
    Misconfigured
        With what to do first.
    """
    if _is_loopback(host):
        return
    if not has_account:
        raise Misconfigured(
            "no_account",
            f"{host} can be reached from other machines, and this installation has no account yet.",
            "Start on 127.0.0.1, create the first account there, and start again.",
        )
    if not behind_proxy:
        raise Misconfigured(
            "no_tls",
            f"{host} can be reached from other machines, and gaitlab itself does not speak TLS.",
            "Put a proxy that speaks TLS in front and say --behind-proxy, or stay on 127.0.0.1.",
        )


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


def _announce(clinic: Clinic, host: str, port: int) -> None:
    shown = f"[{host}]" if ":" in host else host
    code = accounts.setup_code(clinic)
    print(f"gaitlab is at http://{shown}:{port}/", file=sys.stderr)
    if code is not None:
        lines = (
            "There is no account yet. Create the first one within 24 hours:",
            f"  page   http://{shown}:{port}/setup",
            f"  code   {code}",
        )
        print("\n".join(lines), file=sys.stderr, flush=True)


def _warm_up() -> None:
    """Load now what the first walk would otherwise wait for: numerics, figures, PDF."""
    for room in ("gaitlab.analysis", "gaitlab.report.figures.route", "gaitlab.report.pdf"):
        importlib.import_module(room)


def _log_to_stderr() -> None:
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s %(message)s"))
    logging.basicConfig(level=logging.INFO, handlers=[handler])
