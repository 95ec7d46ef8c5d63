"""``docs/methods.md`` is what the command makes of the methods that there are."""

from __future__ import annotations

import re
from pathlib import Path

from gaitlab.methods.catalogue import catalogue, of
from gaitlab.methods.model import Question

PAGE = Path(__file__).resolve().parents[2] / "docs" / "methods.md"
JUDGED = (
    Question.STEP,
    Question.LENGTH,
    Question.HEADING,
    Question.POSITION,
    Question.THIGH,
    Question.CALIBRATION,
)


def test_the_page_holds_every_method_that_is_judged_and_none_that_is_gone() -> None:
    """Where it fails: gaitlab validate methods DIR --markdown --all > docs/methods.md"""
    text = PAGE.read_text(encoding="utf-8")
    rows = set(re.findall(r"^\| ([a-z0-9_]+) \|", text, re.MULTILINE)) - {"method", "heading", "model"}
    assert rows == {method.name for question in JUDGED for method in of(question)}
    assert rows <= {name for _, name in catalogue()}
    assert "`gaitlab validate methods DIR --markdown --all`" in text
