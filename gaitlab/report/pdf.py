"""The report as a tagged PDF by Typst, with the results attached.

The template is compiled from memory and gets its data as data (one JSON text), so a name can never become markup;
no file is read but the fonts. PDF/UA-1 (accessible) and PDF/A-3a (archival, with attachments) at once.
"""

from __future__ import annotations

import dataclasses
import functools
import json
import tempfile
from pathlib import Path
from typing import Any

from gaitlab.paths import data_folder
from gaitlab.report.document import Report
from gaitlab.report.figures.model import Figure

_OWN_FONTS = ("Libertinus Serif", "DejaVu Sans", "DejaVu Sans Mono")
_LAST_FONT = "Last Resort High-Efficiency"


def report_pdf(report: Report) -> bytes:
    """Lay a report out on A4; the same report always gives the same bytes."""
    import typst

    data = _plain(report)
    data.pop("created_at")
    system = not _covered(data)
    fonts, families = load_fonts(system)
    with tempfile.TemporaryDirectory() as nothing:
        return typst.compile(
            (data_folder("templates") / "report.typ").read_bytes(),
            root=nothing,
            package_path=nothing,
            package_cache_path=nothing,
            font_paths=fonts,
            ignore_system_fonts=not system,
            format="pdf",
            sys_inputs={"report": json.dumps(data, ensure_ascii=False), "fonts": json.dumps(families)},
            pdf_standards=["ua-1", "a-3a"],
            timestamp=report.created_at.replace(microsecond=0),
        )


def _plain(value: Any) -> Any:
    """Dataclasses as mappings, pictures as text."""
    if isinstance(value, Figure):
        return {"title": value.title, "caption": value.caption, "alt": value.alt, "svg": value.svg.decode()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: _plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value


def _covered(data: dict[str, Any]) -> bool:
    """Whether our own fonts have all characters; if not, the machine's fonts are asked too (Chinese, say)."""
    return set(json.dumps(data, ensure_ascii=False)) <= _characters()


@functools.cache
def _characters() -> frozenset[str]:
    from matplotlib.ft2font import FT2Font

    return frozenset(chr(code) for code in FT2Font(str(_font_folder() / "DejaVuSans.ttf")).get_charmap())


def _font_folder() -> Path:
    """Typst brings a serif; the sans serif with the widest range comes with matplotlib."""
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts" / "ttf"


@functools.cache
def load_fonts(system: bool = False) -> tuple[Any, list[str]]:
    """The fonts, and their families in the order of trying; the last one has a sign for everything."""
    import typst

    fonts = typst.Fonts(include_system_fonts=system, font_paths=[str(_font_folder())])
    others = [name for name in fonts.families() if name not in (*_OWN_FONTS, _LAST_FONT)] if system else []
    return fonts, [*_OWN_FONTS[:2], *others, _LAST_FONT]
