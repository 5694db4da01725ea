"""The area Files in the browser: build, download, cancel, open, save; and what it looks like to a screen reader."""

from __future__ import annotations

import base64
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.browser import Pages, until
from tests.conftest import ROOT
from tests.export import test_threemf_unsafe as unsafe
from tests.export.threemf_files import read_strictly
from tests.studio.access import violations
from tests.studio.served import Studio, served, solved
from tests.studio.test_opening import HOSTILE

_DROP = """(files) => {
  const data = new DataTransfer();
  for (const [name, text] of files) data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
  const send = (kind) => document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
  send("dragenter");
  const marked = !document.getElementById("drop").hidden;
  send("dragover");
  send("drop");
  return marked && document.getElementById("drop").hidden;
}"""
_STATUS = "(document.getElementById('build-status')?.textContent ?? '')"
_NOTICE = "document.getElementById('notice').textContent"
_BUILT = f"{_STATUS}.startsWith('Built')"
_NOTE_STATUS = (
    f"(() => {{ window.said = []; new MutationObserver(() => said.push({_STATUS}))"
    ".observe(document.body, { childList: true, characterData: true, subtree: true }); })()"
)
"""Keep every text that the status of a build shows, in ``said``."""


def dropped(page: Page, *files: tuple[str, bytes]) -> None:
    """Drop files on the page, which shows that it takes them while they are above it."""
    assert page.evaluate(_DROP, [[name, base64.b64encode(content).decode()] for name, content in files])


def shown(page: Page, area: str = "Files") -> Page:
    page.get_by_role("tab", name=area).click()
    return page


@pytest.fixture(scope="module")
def home(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("home")


@pytest.fixture(scope="module")
def own(chromium, home) -> Iterator[Studio]:
    """A studio of this file alone: it builds, and saves into a folder of its own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PNEUTOUCH_HOME", str(home))
        with served() as (address, process):
            yield Studio(address, process)


@pytest.fixture
def page(own: Studio, pages: Pages) -> Page:
    return shown(own.open(pages))


@pytest.mark.slow
def test_a_dropped_design_file_becomes_the_design_and_a_hostile_one_a_message(page):
    dropped(page, ("mine.toml", b"[membrane]\nwall_thickness_mm = 1.25\n"))
    until(page, f"{_NOTICE}.startsWith('Opened mine.toml')")
    assert "membrane.wall_thickness_mm=1.25" in page.evaluate("location.hash")
    assert page.locator("#build-command").text_content().endswith("--name mine")
    assert page.get_by_label("Name").first.input_value() == "mine"
    before = page.evaluate("location.hash")
    dropped(page, ("bad.3mf", unsafe.bomb(2**28 + 1)))
    until(page, f"{_NOTICE}.includes('bad.3mf: inflates to more than 256 MiB')")
    dropped(page, ("../x.toml", b""), ("b.toml", b""))
    until(page, f"{_NOTICE}.includes('One file is opened at a time')")
    assert page.evaluate("location.hash") == before
    page.get_by_role("button", name="Close this message").click()
    assert page.locator("#notice").text_content() == ""
    page.get_by_role("button", name="Undo").click()
    until(page, "location.hash === '#paper-dome'")
    assert page.get_by_label("Name").first.input_value() == ""
    assert violations(page) == []


@pytest.mark.slow
def test_what_is_built_and_downloaded_is_what_the_command_writes(page, pages, command, tmp_path):
    page.evaluate("location.hash = '#paper-dome&membrane.wall_thickness_mm=1.4'")
    page.evaluate(_NOTE_STATUS)
    page.get_by_role("button", name="Build", exact=True).click()
    assert violations(page) == []
    until(page, _BUILT)
    # Which steps a page gets to see depends on its machine.
    assert any("of 9" in words for words in page.evaluate("said"))
    words = page.locator("#build-command").text_content().split()
    assert words == ["pneutouch", "build", "paper-dome", "--set", "membrane.wall_thickness_mm=1.4"]
    done = command(*words[1:])
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "outputs/paper-dome"
    written = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with page.expect_download() as taken:
        page.get_by_role("link", name="paper-dome.3mf").click()
    sensor = tmp_path / taken.value.suggested_filename
    taken.value.save_as(sensor)
    assert sensor.name == "paper-dome.3mf"
    assert sensor.read_bytes() == written["paper-dome.3mf"]
    _, reader = read_strictly(sensor)
    assert reader.GetWarningCount() == 0
    with page.expect_download() as taken:
        page.get_by_role("link", name="Download all").click()
    with zipfile.ZipFile(taken.value.path()) as archive:
        assert {name.removeprefix("paper-dome/"): archive.read(name) for name in archive.namelist()} == written
    listed = page.locator("#built .groups a").all_text_contents()
    assert sorted(listed) == sorted(written)
    _sheet_is_shown(page, pages)
    assert violations(page) == []
    # What was built becomes the design again, from the 3MF alone.
    page.evaluate("location.hash = '#soft-pad'")
    until(page, "document.querySelector('#built .old').textContent.includes('was changed since')")
    page.get_by_label("File", exact=True).set_input_files(sensor)
    until(page, f"{_NOTICE}.startsWith('Opened paper-dome.3mf')")
    assert page.evaluate("location.hash") == "#paper-dome&membrane.wall_thickness_mm=1.4"
    assert page.locator("#built .old").text_content() == ""


def _sheet_is_shown(page: Page, pages: Pages) -> None:
    """The datasheet stands in its frame, its scripts draw, and it reaches nothing of the page."""
    frame = next(each for each in page.frames if "datasheet.html" in each.url)
    frame.wait_for_selector("canvas")
    assert frame.evaluate("origin") == "null"
    reached = frame.evaluate(
        "fetch('/api/form').then(() => 'reached', () => 'refused').then((word) => { try { return word + parent.document.title; }"
        "catch { return word; } })"
    )
    assert reached == "refused"
    # The attempt, and nothing else, is against the policy of the sheet.
    assert pages.errors
    assert all("/api/form" in each and "Content Security Policy" in each for each in pages.errors), pages.errors
    pages.errors.clear()


@pytest.mark.slow
def test_every_unsafe_file_is_a_message_at_the_page_and_the_studio_goes_on(page, own, built, tmp_path):
    files = {name: tmp_path / f"{name.replace(' ', '-')}.3mf" for name in HOSTILE}
    for name, path in files.items():
        HOSTILE[name](built("paper-dome") / "paper-dome.3mf", path)
        dropped(page, (path.name, path.read_bytes()))
        until(page, f"document.querySelector('#notice .wrong')?.textContent.startsWith({path.name!r})")
        assert str(path.parent) not in page.locator("#notice").text_content()
    assert page.evaluate("location.hash") == "#paper-dome"
    assert own.process.poll() is None


@pytest.mark.slow
def test_a_build_is_cancelled_here_or_from_another_page(page, own, pages):
    # The model harmonic at 24 pressures takes minutes of processor time: no build ends before it is cancelled.
    ball = "contact.object=ball&contact.ball_radius_mm=6&contact.offset_mm=3"
    pressures = ",".join(map(str, range(24)))
    page.evaluate(f"location.hash = '#paper-dome&{ball}&pneumatics.driving_pressures_kPa={pressures}'")
    other = shown(own.open(pages))

    def begin():
        page.get_by_role("button", name="Build", exact=True).press("Enter")
        until(page, f"{_STATUS}.includes(' of 9')")

    begin()
    # The page may show the files of an earlier build of this studio.
    before = page.locator("#built").text_content()
    assert page.evaluate("document.activeElement.id") == "build-cancel"
    page.keyboard.press("Enter")
    until(page, f"{_STATUS} === 'Cancelled. Nothing was kept.'")
    assert page.evaluate("document.activeElement.id") == "build"
    begin()
    other.get_by_role("button", name="Build", exact=True).click()
    until(other, "document.getElementById('build-problems').textContent.includes('another job is running: build')")
    # A page that is opened now finds the build.
    late = shown(own.open(pages))
    until(late, f"{_STATUS}.includes(' of 9')")
    assert violations(other) == []
    other.get_by_role("button", name="Cancel the other job").click()
    for each in (page, late):
        until(each, f"{_STATUS} === 'Cancelled. Nothing was kept.'")
    assert other.locator("#build-problems").text_content() == ""
    assert page.locator("#built").text_content() == before


@pytest.mark.slow
def test_a_design_is_saved_exported_and_opened_again(page, home, tmp_path):
    page.evaluate("location.hash = '#paper-dome&membrane.wall_thickness_mm=1.3'")
    name = page.get_by_label("Name").last
    name.fill("mine")
    assert page.locator("#save-command").text_content() == (
        "pneutouch new mine --from paper-dome --set membrane.wall_thickness_mm=1.3"
    )
    name.press("Enter")
    until(page, "location.hash === '#mine'")
    assert (home / "designs/mine.toml").is_file()
    assert page.locator("#base").input_value() == "mine"
    page.evaluate("location.hash = '#mine&membrane.wall_thickness_mm=1.2'")
    name.fill("mine")
    name.press("Enter")
    until(page, "document.getElementById('save-problems').textContent.includes('there is such a file already')")
    assert "wall_thickness_mm = 1.3" in (home / "designs/mine.toml").read_text()
    assert violations(page) == []
    assert page.evaluate("document.activeElement.id") == "save-replace"
    page.keyboard.press("Space")
    page.get_by_role("button", name="Save", exact=True).click()
    until(page, "location.hash === '#mine'")
    assert "wall_thickness_mm = 1.2" in (home / "designs/mine.toml").read_text()
    page.evaluate("location.hash = '#mine&membrane.wall_thickness_mm=1.1'")
    with page.expect_download() as taken:
        page.get_by_role("button", name="Export").click()
    exported = json.loads(taken.value.path().read_text())
    assert (exported["base"], exported["values"]) == ("mine", {"membrane.wall_thickness_mm": "1.1"})
    page.evaluate("location.hash = '#soft-pad'")
    dropped(page, (taken.value.suggested_filename, taken.value.path().read_bytes()))
    until(page, "location.hash === '#mine&membrane.wall_thickness_mm=1.1'")


def save_over(page: Page, name: str) -> None:
    """Save the design of a page by a name, over the file that is there."""
    field = shown(page).get_by_label("Name").last
    field.fill(name)
    field.press("Enter")
    until(page, "document.activeElement.id === 'save-replace'")
    page.keyboard.press("Space")
    page.get_by_role("button", name="Save", exact=True).click()


@pytest.mark.slow
def test_a_page_says_that_another_one_saved_its_design(own, pages, home):
    file, wall = home / "designs/shared.toml", "document.getElementById('field-membrane-wall_thickness_mm').value"
    first, second = own.open(pages), own.open(pages)
    name = shown(first).get_by_label("Name").last
    name.fill("shared")
    name.press("Enter")
    for page in (first, second):
        page.evaluate("location.hash = '#shared'")
        solved(page, "#shared")
    first.evaluate("location.hash = '#shared&membrane.wall_thickness_mm=1.3'")
    save_over(first, "shared")
    solved(first, "#shared")
    saved = file.read_text()
    assert "wall_thickness_mm = 1.3" in saved
    # The form of the second page has the other wall still: nothing is computed with what it does not show.
    second.get_by_label("Friction").first.fill("0.2")
    said = "document.getElementById('status').textContent"
    until(second, f"{said}.includes('was changed since this page read it')")
    assert second.evaluate(wall) == "1.5"
    assert second.evaluate("document.getElementById('area-design').classList.contains('stale')")
    shown(second).get_by_label("Name").last.fill("shared")
    second.get_by_role("button", name="Save", exact=True).click()
    until(second, "document.getElementById('save-problems').textContent.includes('was changed since')")
    assert file.read_text() == saved
    second.get_by_role("button", name="Reset").click()
    solved(second, "#shared")
    assert second.evaluate(wall) == "1.3"


@pytest.mark.slow
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [360, 1400, 2560])
def test_the_area_breaks_no_rule_and_scrolls_in_one_way(width, dark, own, pages):
    page = shown(own.open(pages, "#graded-dome", width=width, dark=dark, is_mobile=width < 600))
    dropped(page, ("paper-dome.toml", (ROOT / "designs/stiff-dome.toml").read_bytes()))
    until(page, f"{_NOTICE}.startsWith('Opened')")
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
