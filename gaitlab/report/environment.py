"""How templates are read: everything is escaped, whatever the file is called; nothing undefined is silent."""

from __future__ import annotations

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from gaitlab.paths import data_folder
from gaitlab.report.figures.model import Figure


def template_environment() -> Environment:
    """A new environment over ``templates/``.

    Jinja's usual choice escapes by file ending and leaves ``.svg``, ``.css`` and ``.html.j2`` open; here all is
    escaped. The filter ``inline_svg`` is the only way for markup into a page, and takes only our own figures.
    """
    environment = Environment(
        loader=FileSystemLoader(data_folder("templates")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        auto_reload=False,
    )
    environment.filters["inline_svg"] = inline_svg
    return environment


def inline_svg(figure: Figure) -> Markup:
    """The picture as an element of the page."""
    if not isinstance(figure, Figure):
        raise TypeError("inline_svg takes a Figure drawn by gaitlab")
    return Markup(figure.svg.decode())  # noqa: S704  written by our own figures, texts in it escaped
