"""The whole way in Chromium: set-up, log-in, patient, upload of a real walk, session page, PDF; and a wrong file.

``GAITLAB_CHROMIUM`` names another browser than ``/usr/bin/chromium``.
"""

from __future__ import annotations

import io
import os
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

import pytest
import uvicorn
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright
from pypdf import PdfReader

from api.app import create_app
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.clinic import Clinic, ClinicSettings
from gaitlab.report.parameters import key_table
from gaitlab.result import Result
from tests.api.test_problems import line_changed
from tests.clinic.people import PASSWORD

pytestmark = pytest.mark.browser

CHROMIUM = Path(os.environ.get("GAITLAB_CHROMIUM", "/usr/bin/chromium"))
WIDE, NARROW = {"width": 1280, "height": 900}, {"width": 390, "height": 844}


BROKEN_WORDS = """[...document.querySelectorAll('th, td.num, td.fixed')].flatMap(cell => {
  if (cell.classList.contains('free') || !cell.getClientRects().length) return [];
  const walk = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT), found = [];
  while (walk.nextNode()) for (const word of walk.currentNode.data.matchAll(/[^\\s-]+/g)) {
    const range = document.createRange();
    range.setStart(walk.currentNode, word.index);
    range.setEnd(walk.currentNode, word.index + word[0].length);
    if (new Set([...range.getClientRects()].map(r => Math.round(r.top))).size > 1) found.push(word[0]);
  }
  return found;
})"""
"""Words of headings and numbers that run over two lines."""


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    if not CHROMIUM.is_file():
        pytest.skip(f"There is no Chromium at {CHROMIUM}; GAITLAB_CHROMIUM can name one.")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=["--no-sandbox"])
        yield browser
        browser.close()


@dataclass
class Site:
    """A running server without an account, and the set-up code it printed."""

    address: str
    code: str
    clinic: Clinic


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    clinic = Clinic.open(ClinicSettings(tmp_path / "data"))
    server = uvicorn.Server(
        uvicorn.Config(
            create_app(clinic, WebSettings()), host="127.0.0.1", port=0, log_config=None, access_log=False
        )
    )
    thread = threading.Thread(target=server.run)
    thread.start()
    while not server.started:
        time.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    code = accounts.setup_code(clinic)
    assert code is not None
    yield Site(f"http://127.0.0.1:{port}", code, clinic)
    server.should_exit = True
    thread.join()
    clinic.close()


@dataclass
class Watch:
    """What a page said to the console, threw, and asked for elsewhere."""

    home: str
    complaints: list[str] = field(default_factory=list)
    elsewhere: list[str] = field(default_factory=list)

    def over(self, context: BrowserContext) -> None:
        context.on(
            "console", lambda m: self.complaints.append(m.text) if m.type in ("error", "warning") else None
        )
        context.on("weberror", lambda e: self.complaints.append(str(e.error)))
        context.on("request", lambda r: self._note(r.url))

    def _note(self, url: str) -> None:
        if urlsplit(url).scheme not in ("data", "blob") and not url.startswith(self.home):
            self.elsewhere.append(url)


@pytest.fixture
def watch(site: Site) -> Watch:
    return Watch(site.address)


@pytest.fixture
def page(chromium: Browser, site: Site, watch: Watch) -> Iterator[Page]:
    """A clinician's browser, logged in to a new installation by way of its pages."""
    context = chromium.new_context(viewport=WIDE, accept_downloads=True)  # type: ignore[arg-type]
    watch.over(context)
    page = context.new_page()
    page.goto(site.address)
    page.get_by_label("One-time code").fill(site.code)
    page.get_by_label("Your name").fill("Anna Keller")
    page.get_by_label("E-mail address").fill("anna@clinic.example")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_label("Password again").fill(PASSWORD)
    page.get_by_role("button", name="Create account").click()
    page.get_by_label("E-mail address").fill("anna@clinic.example")
    page.get_by_label("Password").fill(PASSWORD)
    page.get_by_role("button", name="Log in").click()
    expect(page.get_by_role("heading", name="No patients yet")).to_be_visible()
    yield page
    context.close()


def add_patient(page: Page) -> None:
    page.get_by_role("link", name="Add the first patient").click()
    page.get_by_label("Code").fill("MS-0142 <b>")
    page.get_by_label("Sex").select_option("female")
    page.get_by_label("Birth year").fill("1971")
    page.get_by_label("Height").fill("168")
    page.get_by_label("Diagnosis").fill("Relapsing-remitting MS")
    page.get_by_role("button", name="Add patient").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("MS-0142 <b>")
    page.get_by_role("link", name="New session").first.click()


def upload(page: Page, data_dir: Path, trial: str = "1-1") -> None:
    folder = data_dir / "mtw-10m-walk"
    page.get_by_label("Choose files").set_input_files(
        [folder / f"{trial}_lf.txt", folder / f"{trial}_rf.txt"]
    )
    expect(page.get_by_text("2 files read. Check where each sensor was worn.")).to_be_visible()
    expect(page.get_by_label(f"Placement of {trial}_lf.txt")).to_have_value("left_foot")
    expect(page.get_by_label(f"Placement of {trial}_rf.txt")).to_have_value("right_foot")
    page.get_by_role("button", name="Store and analyse").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Timed 25-foot walk")


def current_result(site: Site, page: Page) -> Result:
    answer = page.context.request.get(
        site.address + str(page.get_by_role("link", name="result.json").get_attribute("href"))
    )
    return Result.model_validate_json(answer.text())


def test_from_the_set_up_code_to_the_pdf(page: Page, site: Site, watch: Watch, data_dir: Path) -> None:
    add_patient(page)
    expect(page.get_by_label("Course length")).to_have_value("7.62")
    upload(page, data_dir)
    result = current_result(site, page)
    key = key_table(result)
    speed = next(row.both for row in key.rows if row.label == "Steady speed")
    assert speed is not None
    expect(page.locator(".summary")).to_contain_text(speed.value)
    assert page.locator(".figures img").count() >= 8
    broken = page.evaluate("[...document.images].filter(i => !(i.complete && i.naturalWidth)).length")
    assert broken == 0
    with page.expect_download() as waiting:
        page.get_by_role("link", name="PDF").click()
    pdf = PdfReader(io.BytesIO(Path(waiting.value.path()).read_bytes()))
    text = " ".join(" ".join(sheet.extract_text() for sheet in pdf.pages).split())
    assert "MS-0142 <b>" in text
    for row in key.rows:
        for cell in (row.left, row.right, row.both):
            if cell is not None:
                assert cell.value in text, row.label
    page.get_by_role("link", name="HTML report").click()
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    expect(page.locator("body")).to_contain_text(speed.value)
    assert page.locator("b", has_text="MS-0142").count() == 0
    assert watch.complaints == []
    assert watch.elsewhere == []


def test_a_wrong_file_is_told_at_once_and_what_was_typed_stays(
    page: Page, watch: Watch, data_dir: Path, tmp_path: Path
) -> None:
    add_patient(page)
    page.get_by_label("Note").fill("typed & kept")
    page.get_by_label("Test").select_option("10mwt")
    expect(page.get_by_label("Course length")).to_have_value("10")
    right = data_dir / "mtw-10m-walk" / "1-1_rf.txt"
    broken = tmp_path / "broken_lf.txt"
    broken.write_bytes(line_changed((data_dir / "mtw-10m-walk" / "1-1_lf.txt").read_bytes(), 12, 2, "abc"))
    page.get_by_label("Choose files").set_input_files([right, broken])
    alert = page.get_by_role("alert")
    expect(alert).to_contain_text("broken_lf.txt, line 12, column Acc_Y")
    expect(alert).to_contain_text("“abc” is not a number.")
    expect(page.get_by_label("Placement of 1-1_rf.txt")).to_have_value("right_foot")
    page.get_by_role("button", name="Store and analyse").click()
    expect(alert).to_contain_text("broken_lf.txt, line 12, column Acc_Y")
    assert page.url.endswith("/sessions/new")
    expect(page.get_by_label("Note")).to_have_value("typed & kept")
    expect(page.get_by_label("Test")).to_have_value("10mwt")
    page.get_by_role("button", name="Remove broken_lf.txt").click()
    expect(page.get_by_text("1 file read.")).to_be_visible()
    expect(page.get_by_role("alert")).to_have_count(0)
    page.get_by_role("button", name="Store and analyse").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("10-metre walk test")
    expect(page.locator("main")).to_contain_text("typed & kept")
    refused = [said for said in watch.complaints if "422" not in said]
    assert refused == []
    assert watch.elsewhere == []


def test_a_file_without_a_placement_must_get_one_before_it_is_sent(
    page: Page, data_dir: Path, tmp_path: Path
) -> None:
    add_patient(page)
    nameless = tmp_path / "sensor.txt"
    nameless.write_bytes((data_dir / "mtw-10m-walk" / "1-1_lf.txt").read_bytes())
    page.get_by_label("Choose files").set_input_files([nameless])
    expect(page.get_by_text("Say where one sensor was worn.")).to_be_visible()
    page.get_by_role("button", name="Store and analyse").click()
    assert page.url.endswith("/sessions/new")
    page.get_by_label("Placement of sensor.txt").select_option("left_foot")
    page.get_by_role("button", name="Store and analyse").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Timed 25-foot walk")


def test_files_can_be_dropped_and_sent_by_keyboard_alone(page: Page, data_dir: Path) -> None:
    add_patient(page)
    folder = data_dir / "mtw-10m-walk"
    contents = {f"1-1_{side}.txt": (folder / f"1-1_{side}.txt").read_text() for side in ("lf", "rf")}
    transfer = page.evaluate_handle(
        """contents => { const t = new DataTransfer();
        for (const [name, text] of Object.entries(contents)) t.items.add(new File([text], name)); return t; }""",
        contents,
    )
    page.dispatch_event("[data-drop]", "drop", {"dataTransfer": transfer})
    expect(page.get_by_text("2 files read.")).to_be_visible()
    page.get_by_label("Note").focus()
    page.keyboard.type("by keyboard")
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Store and analyse")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", level=1)).to_have_text("Timed 25-foot walk")


def test_the_upload_works_without_javascript(
    chromium: Browser, page: Page, site: Site, data_dir: Path, watch: Watch
) -> None:
    add_patient(page)
    context = chromium.new_context(java_script_enabled=False, storage_state=page.context.storage_state())
    watch.over(context)
    plain = context.new_page()
    plain.goto(page.url)
    folder = data_dir / "mtw-10m-walk"
    plain.locator("#files").set_input_files([folder / "1-1_lf.txt", folder / "1-1_rf.txt"])
    plain.get_by_role("button", name="Store and analyse").click()
    expect(plain.get_by_role("heading", level=1)).to_have_text("Timed 25-foot walk")
    expect(plain.locator(".lead")).to_contain_text("course 7.62 m")
    context.close()
    assert watch.complaints == []
    assert site.clinic.ready()


def test_after_the_log_in_ended_the_same_form_is_sent_from_a_new_one(page: Page, data_dir: Path) -> None:
    add_patient(page)
    page.get_by_label("Note").fill("typed & kept")
    folder = data_dir / "mtw-10m-walk"
    page.get_by_label("Choose files").set_input_files([folder / "1-1_lf.txt", folder / "1-1_rf.txt"])
    expect(page.get_by_text("2 files read.")).to_be_visible()
    page.context.clear_cookies()
    page.get_by_role("button", name="Store and analyse").click()
    alert = page.get_by_role("alert")
    expect(alert).to_contain_text("You were logged out.")
    with page.context.expect_page() as opened:
        alert.get_by_role("link", name="Log in").click()
    other = opened.value
    other.get_by_label("E-mail address").fill("anna@clinic.example")
    other.get_by_label("Password").fill(PASSWORD)
    other.get_by_role("button", name="Log in").click()
    expect(other.get_by_role("heading", level=1)).to_have_text("Patients")
    page.get_by_role("button", name="Store and analyse").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Timed 25-foot walk")
    expect(page.locator("main")).to_contain_text("typed & kept")


def test_a_second_file_of_the_same_name_does_not_replace_the_first(
    page: Page, data_dir: Path, tmp_path: Path
) -> None:
    add_patient(page)
    first, other = data_dir / "mtw-10m-walk" / "1-1_lf.txt", tmp_path / "1-1_lf.txt"
    other.write_bytes((data_dir / "mtw-10m-walk" / "1-1_rf.txt").read_bytes())
    chooser = page.get_by_label("Choose files")
    chooser.set_input_files(first)
    expect(page.get_by_text("1 file read.")).to_be_visible()
    chooser.set_input_files(other)
    expect(page.get_by_role("alert")).to_contain_text("Two different files are called 1-1_lf.txt")
    kept = "document.querySelector('input[type=file]').files[0].size"
    assert page.evaluate(kept) == first.stat().st_size
    page.get_by_role("button", name="Remove 1-1_lf.txt").click()
    chooser.set_input_files(other)
    expect(page.get_by_text("1 file read.")).to_be_visible()
    assert page.evaluate(kept) == other.stat().st_size


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["1280", "390"])
def test_no_page_is_wider_than_the_screen(
    page: Page, site: Site, data_dir: Path, size: dict[str, int]
) -> None:
    add_patient(page)
    form = page.url
    patient = form.removesuffix("/sessions/new")
    page.goto(f"{patient}/edit")
    page.get_by_label("Diagnosis").fill("d" * 150)
    page.get_by_role("button", name="Save").click()
    page.goto(form)
    page.get_by_label("Note").fill("n" * 150)
    upload(page, data_dir)
    session = page.url
    compared = str(page.get_by_role("link", name="Compare methods").get_attribute("href"))
    page.set_viewport_size(size)  # type: ignore[arg-type]
    paths = (form, session, patient, f"{patient}/edit", f"{session}/trials/new", f"{session}/report.html")
    for address in (
        *paths,
        *(
            site.address + path
            for path in ("/", "/tokens", "/help", "/docs", "/nothing", "/patients/new", compared)
        ),
    ):
        page.goto(address)
        over = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert over <= 0, address
        cut = page.evaluate(
            """[...document.querySelectorAll('main *')].filter(e => getComputedStyle(e).overflowX === 'hidden'
            && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 2).map(e => e.className)"""
        )
        assert cut == [], address
        broken = page.evaluate(BROKEN_WORDS)
        assert broken == [], address
