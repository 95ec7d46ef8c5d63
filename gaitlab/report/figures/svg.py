"""From matplotlib's SVG to one that can stand inside a page: small, described, without a single inline style.

A page that forbids inline styles (``style-src 'self'``) would draw matplotlib's own SVG all black, and two of
them in one page would share their ids.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

_SVG = "http://www.w3.org/2000/svg"
_LINK = "{http://www.w3.org/1999/xlink}href"
_LONG_NUMBER = re.compile(r"-?\d+\.\d{3,}(?:e-?\d+)?")
_NO_TURN = re.compile(r"\s*rotate\(-?0(?:\.0+)?[ ,][^)]*\)")
_FONT = re.compile(r"(?:(?P<weight>bold|[1-9]00) )?(?P<size>[\d.]+)px (?P<family>.+)")
_DEFAULTS = {
    "stroke-miterlimit": None,
    "stroke-dashoffset": "0",
    "stroke-linecap": "butt",
    "stroke-linejoin": "miter",
    "stroke-width": "1",
    "text-anchor": "start",
}

ET.register_namespace("", _SVG)


def tidy(raw: bytes, *, name: str, title: str, description: str) -> bytes:
    """Return matplotlib's SVG as a described picture for screen and paper.

    ``name`` prefixes every id, so that several figures can stand in one page. Styles become attributes, text
    stays text, coordinates keep two decimals (1/100 pt).
    """
    root = ET.fromstring(raw)  # noqa: S314  our own bytes
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in {f"{{{_SVG}}}metadata", f"{{{_SVG}}}style"}:
                parent.remove(child)
    for element in root.iter():
        _style_to_attributes(element)
        _shorten_numbers(element)
    _rename_ids(root, name)
    _unwrap(root)
    width, height = (root.attrib.pop(side).removesuffix("pt") for side in ("width", "height"))
    root.attrib.clear()
    root.attrib.update(
        {
            "viewBox": f"0 0 {width} {height}",
            "width": width,
            "height": height,
            "role": "img",
            "aria-labelledby": f"{name}-title {name}-desc",
        }
    )
    for at, (tag, text) in enumerate((("title", title), ("desc", description))):
        element = ET.Element(f"{{{_SVG}}}{tag}", {"id": f"{name}-{tag}"})
        element.text = text
        root.insert(at, element)
    for element in root.iter():
        element.tail = None
    return ET.tostring(root, encoding="unicode").encode()


def _style_to_attributes(element: ET.Element) -> None:
    for declaration in element.attrib.pop("style", "").split(";"):
        key, _, value = (part.strip() for part in declaration.partition(":"))
        if key == "font":
            font = _FONT.fullmatch(value)
            if font is not None:
                element.set("font-size", font["size"])
                element.set("font-family", "DejaVu Sans, sans-serif")
                if font["weight"]:
                    element.set("font-weight", font["weight"])
        elif key and not (key in _DEFAULTS and _DEFAULTS[key] in (None, value)):
            element.set(key, value)


def _shorten_numbers(element: ET.Element) -> None:
    for key in ("d", "x", "y", "width", "height", "transform", "points"):
        text = element.attrib.get(key)
        if text is None:
            continue
        text = _LONG_NUMBER.sub(lambda found: f"{float(found[0]):.2f}".rstrip("0").rstrip("."), text)
        if key == "transform":
            text = _NO_TURN.sub("", text).strip()
            if not text:
                del element.attrib[key]
                continue
        element.set(key, re.sub(r"\s+", " ", text).strip())


def _rename_ids(root: ET.Element, name: str) -> None:
    wanted: dict[str, str] = {}
    for element in root.iter():
        target = element.attrib.pop(_LINK, None) or element.get("href")
        if target is not None:
            wanted.setdefault(target[1:], f"{name}-{len(wanted)}")
            element.set("href", f"#{wanted[target[1:]]}")
        clip = element.get("clip-path")
        if clip is not None:
            wanted.setdefault(clip[5:-1], f"{name}-{len(wanted)}")
            element.set("clip-path", f"url(#{wanted[clip[5:-1]]})")
    for element in root.iter():
        old = element.attrib.pop("id", None)
        if old in wanted:
            element.set("id", wanted[old])


def _unwrap(parent: ET.Element) -> None:
    """Replace groups that say nothing by what is in them."""
    at = 0
    while at < len(parent):
        child = parent[at]
        if child.tag == f"{{{_SVG}}}g" and not child.attrib:
            parent.remove(child)
            for offset, inner in enumerate(list(child)):
                parent.insert(at + offset, inner)
        elif child.tag == f"{{{_SVG}}}defs" and len(child) == 0:
            parent.remove(child)
        else:
            _unwrap(child)
            at += 1
