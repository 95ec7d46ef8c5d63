"""The PDF: the same words and numbers as the page, tagged, with the result inside."""

from __future__ import annotations

import io
import json

import pytest
from bs4 import BeautifulSoup
from pypdf import PdfReader

from gaitlab.report import Report, Subject, TrialReport, build_report, report_html, report_pdf
from gaitlab.result import Result, ResultWarning
from tests.report import walk
from tests.report.conftest import MADE_AT, report_of, squeezed
from tests.report.test_html import HOSTILE


def read(report: Report) -> PdfReader:
    return PdfReader(io.BytesIO(report_pdf(report)))


def text_of(pdf: PdfReader) -> str:
    return squeezed("".join(page.extract_text() for page in pdf.pages))


def texts_with_numbers(html: str) -> list[str]:
    """Every piece of visible text of a page that has a digit in it; pieces end at elements and at dots."""
    page = BeautifulSoup(html, "html.parser")
    for hidden in page.find_all(["style", "head", "title", "desc"]):
        hidden.decompose()
    pieces = (squeezed(piece) for text in page.find_all(string=True) for piece in text.split("·"))
    return [piece for piece in pieces if any(c.isdigit() for c in piece)]


def test_every_number_of_the_page_stands_in_the_pdf(report: Report) -> None:
    shown, printed = texts_with_numbers(report_html(report)), text_of(read(report))
    assert len(shown) > 100
    assert [text for text in shown if text not in printed] == []


def test_every_number_of_a_real_recordings_page_stands_in_the_pdf(real_trial: TrialReport) -> None:
    report = report_of(real_trial)
    shown, printed = texts_with_numbers(report_html(report)), text_of(read(report))
    assert len(shown) > 150
    assert [text for text in shown if text not in printed] == []


def test_two_trials_stand_beside_each_other_in_both(trial: TrialReport) -> None:
    report = report_of(trial, TrialReport(2, walk.result(knees=False), walk.series(knees=False)))
    printed = text_of(read(report))
    assert [text for text in texts_with_numbers(report_html(report)) if text not in printed] == []
    assert "Trialsbesideeachother" in printed


def test_the_result_is_attached_unchanged(trial: TrialReport, report: Report) -> None:
    attached = read(report).attachments
    assert list(attached) == ["result.json"]
    content = attached["result.json"][0]
    assert content.decode() == trial.result.to_json()
    assert Result.model_validate(json.loads(content)) == trial.result


def test_the_pdf_is_tagged_and_says_what_it_is(report: Report) -> None:
    pdf = read(report)
    catalogue = pdf.trailer["/Root"]
    assert catalogue["/MarkInfo"]["/Marked"]
    assert "/StructTreeRoot" in catalogue
    assert catalogue["/Lang"] == "en"
    assert pdf.metadata is not None
    assert pdf.metadata.title == "Gait report Patient VB-0042, 10-metre walk test, 2026-11-20"
    metadata = catalogue["/Metadata"].get_data().decode()
    assert "<pdfuaid:part>1</pdfuaid:part>" in metadata
    assert "<pdfaid:part>3</pdfaid:part>" in metadata


def test_every_figure_in_the_pdf_has_its_alternative_text(report: Report) -> None:
    alternatives = _alternatives(read(report).trailer["/Root"]["/StructTreeRoot"])
    drawn = [*report.trials[0].overview_figures, *(f for pair in report.trials[0].figure_pairs for f in pair)]
    assert [figure.alt for figure in drawn if figure.alt not in alternatives] == []


def _alternatives(node: object) -> set[str]:
    node = node.get_object() if hasattr(node, "get_object") else node
    if isinstance(node, list):
        return set().union(*(_alternatives(kid) for kid in node)) if node else set()
    if not isinstance(node, dict):
        return set()
    own = {str(node["/Alt"])} if "/Alt" in node else set()
    return own | (_alternatives(node["/K"]) if "/K" in node else set())


def test_pages_are_a4_and_carry_patient_page_and_hash(report: Report) -> None:
    pdf = read(report)
    for number, page in enumerate(pdf.pages, start=1):
        assert [round(float(side)) for side in page.mediabox[2:]] == [595, 842]
        text = squeezed(page.extract_text())
        assert "PatientVB-0042" in text
        assert f"page{number}of{len(pdf.pages)}" in text
        assert report.fingerprint[:16] in text


def test_hostile_texts_are_printed_as_text() -> None:
    for text in [*HOSTILE, '#read("/etc/passwd") #panic()']:
        warning = ResultWarning(code="x", message=text, placement=None)
        trial = TrialReport(1, walk.result(warnings=(warning,), names={"left_foot": text}), {})
        subject = Subject(code=text, diagnosis=text, note=text)
        printed = text_of(read(build_report(subject, None, [trial], created_at=MADE_AT)))
        assert printed.count(squeezed(text)) >= 4


@pytest.mark.parametrize("name", ["Žofie Łuczak-Øğüş", "Ελένη Ζήση", "Жанна", "שלום", "山田太郎"])
def test_names_of_any_script_give_a_pdf(name: str) -> None:
    trial = TrialReport(1, walk.result(), {})
    report = build_report(Subject(code=name), None, [trial], created_at=MADE_AT)
    pdf = read(report)
    assert pdf.metadata is not None
    assert name in (pdf.metadata.title or "")


def test_nothing_recorded_and_nothing_determinable_give_a_pdf() -> None:
    bare = walk.result([], knees=False, chosen=())
    report = build_report(None, None, [TrialReport(1, bare, {})], created_at=MADE_AT)
    assert "Notusable" in text_of(read(report))
    assert "Nogaitparametercouldbedetermined" in text_of(read(report))


def test_the_same_report_gives_the_same_bytes(report: Report, trial: TrialReport) -> None:
    assert report_pdf(report) == report_pdf(report_of(trial))
