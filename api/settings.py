"""What the web side can be told from outside."""

from __future__ import annotations

import os
from dataclasses import dataclass

LOOPBACK = ("localhost", "127.0.0.1", "[::1]")


@dataclass(frozen=True)
class WebSettings:
    """How the pages are reached.

    Attributes
    ----------
    behind_tls : bool
        A proxy in front speaks TLS: cookies are ``Secure`` with the ``__Host-`` prefix and HSTS is sent.
        Without it the server is for this machine only, and the cookie has a plain name: not every browser
        takes a ``Secure`` cookie over plain http, even from the loopback address.
    allowed_hosts : tuple of str
        Host names the server answers to; others get 400.
    small_body_bytes : int
        Limit of every request that is not an upload.
    """

    behind_tls: bool = False
    allowed_hosts: tuple[str, ...] = LOOPBACK
    small_body_bytes: int = 1024 * 1024

    @property
    def cookie_name(self) -> str:
        return "__Host-gait" if self.behind_tls else "gait"

    @classmethod
    def from_environment(cls) -> WebSettings:
        """Read ``GAITLAB_BEHIND_TLS`` (1) and ``GAITLAB_ALLOWED_HOSTS`` (names, commas between)."""
        named = tuple(
            h.strip().lower() for h in os.environ.get("GAITLAB_ALLOWED_HOSTS", "").split(",") if h.strip()
        )
        return cls(behind_tls=os.environ.get("GAITLAB_BEHIND_TLS", "") == "1", allowed_hosts=LOOPBACK + named)
