"""Dates, sizes and names for people; measured values get their digits from ``gaitlab.report.wording``."""

from __future__ import annotations

import base64
import datetime as dt
from collections.abc import Callable
from urllib.parse import quote as _quote

from gaitlab.recording.model import Placement
from gaitlab.report.build import TESTS
from gaitlab.report.wording import STATUS_LABELS, count, percent

METHODS = {"gaitlab": "gaitlab", "ikizoglu2018": "İkizoğlu et al. 2018, to the letter"}
"""Methods by name, as short as a list of choices needs them."""


def quote(path: str) -> str:
    """A path as a query value."""
    return _quote(path, safe="/")


def day(date: dt.date) -> str:
    """``21 Nov 2026``: no two countries read it differently."""
    return f"{date.day} {date:%b} {date.year}"


def moment(at: dt.datetime) -> str:
    """``21 Nov 2026, 14:03 UTC``."""
    at = at.astimezone(dt.UTC)
    return f"{day(at.date())}, {at:%H:%M} UTC"


def size(n_bytes: int) -> str:
    """``1.4 MB``."""
    if n_bytes < 1000:
        return f"{n_bytes} B"
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e6 else f"{n_bytes / 1e3:.0f} kB"


def mebibytes(n_bytes: int) -> str:
    """A limit as it was set: ``256 MiB``."""
    return f"{n_bytes / 2**20:g} MiB"


def data_url(svg: bytes) -> str:
    """A figure as the address of an image: it comes with the page, and nothing in it can run or reach out."""
    return f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"


def general(value: float | None, factor: float = 1.0) -> str:
    """A number as it was typed in: ``7.62``, ``86``; a dash where there is none."""
    return "–" if value is None else f"{value * factor:.6g}"


def method(name: str) -> str:
    """A method as people know it; an old one that is gone keeps its name."""
    return METHODS.get(name, name)


def placement(name: str) -> str:
    """``left foot``."""
    return Placement(name).label


FILTERS: dict[str, Callable[..., str]] = {
    "day": day,
    "moment": moment,
    "size": size,
    "mebibytes": mebibytes,
    "data_url": data_url,
    "general": general,
    "percent": percent,
    "plural": count,
    "placement": placement,
    "test_name": lambda key: TESTS[key],
    "method_name": method,
    "status_name": lambda key: STATUS_LABELS[key],
}
