"""The page as a browser shows and prints it; left out, and said so, where there is no browser."""

from __future__ import annotations

import os

import pypdfium2
import pytest

from tests.browser import FOUND, WITHOUT_WEBGL, Pages, launched, leave_out_or_fail
from tests.report.test_datasheet import SECTIONS

pytestmark = pytest.mark.slow

_TOO_WIDE = """[...document.querySelectorAll('main *')].filter(e => !e.closest('svg') && !e.closest('script') &&
e.getBoundingClientRect().right > innerWidth + 0.5).map(e => e.tagName + ': ' + e.textContent.slice(0, 40))"""
_WIDER_THAN_THE_PAGE = """(m => [...document.querySelectorAll('table, figure, .tiles')].filter(e =>
e.getBoundingClientRect().right > m.getBoundingClientRect().right - parseFloat(getComputedStyle(m).paddingRight) + 0.5)
.map(e => e.textContent.slice(0, 60)))(document.querySelector('main'))"""
_UNFOLD = "document.querySelectorAll('details').forEach(e => { e.open = true })"
_CUT = """[...document.querySelectorAll('td, th, h1, dd, figcaption, p, li')].filter(e =>
e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display != 'contents' &&
getComputedStyle(e).display != 'inline').map(e => e.textContent)"""


@pytest.fixture(scope="module", params=["paper-dome", "graded-dome", "agilus-dome"])
def sheet(request, built):
    return (built(request.param) / "datasheet.html").resolve().as_uri()


@pytest.fixture
def show(sheet, pages):
    """Opens the datasheet in a window of a width in pixels."""

    def opened(width):
        return pages.open(sheet, width, is_mobile=width < 600)

    return opened


@pytest.mark.parametrize("width", [360, 400, 800, 1400])
def test_the_page_needs_no_scrolling_sideways(width, show):
    screen = show(width)
    assert screen.evaluate("innerWidth") == width
    folded = screen.evaluate("document.querySelectorAll('details:not([open])').length")
    assert (folded > 9) == (width <= 760)
    screen.evaluate(_UNFOLD)
    assert screen.evaluate("document.documentElement.scrollWidth") <= width
    assert screen.evaluate(_TOO_WIDE) == []
    assert screen.evaluate(_WIDER_THAN_THE_PAGE) == []
    assert screen.evaluate(_CUT) == []


def test_letters_of_figures_can_be_read_on_a_narrow_screen(show):
    """The smallest of a figure are 6.5 points at its own width: at least 7 pixels on the screen."""
    screen = show(400)
    screen.evaluate(_UNFOLD)
    sizes = screen.evaluate(
        "[...document.querySelectorAll('figure svg')].map(e => 6.5 * e.clientWidth / e.viewBox.baseVal.width)"
    )
    assert len(sizes) >= 13
    assert min(sizes) >= 7


def test_a_narrow_screen_shows_the_front_and_folds_the_annex(show):
    """Seven screens of 900 pixels hold all that the first page of the PDF has."""
    screen = show(400)
    assert screen.evaluate("document.documentElement.scrollHeight") < 7 * 900
    assert screen.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(233, 238, 242)"
    screen.emulate_media(color_scheme="dark")
    assert screen.evaluate("getComputedStyle(document.querySelector('main')).backgroundColor") == "rgb(24, 33, 42)"


def test_with_webgl_the_dome_is_drawn_as_in_the_picture(show):
    screen = show(1400)
    assert screen.evaluate("document.getElementById('view').className") == "view live"
    assert screen.evaluate("getComputedStyle(document.querySelector('#view img')).visibility") == "hidden"
    # Both are drawn small and in gray: what a person sees first is the same.
    apart = screen.evaluate(
        """(async () => {
        const gray = source => { const c = document.createElement('canvas'); c.width = 45; c.height = 32;
            const d = c.getContext('2d'); d.fillStyle = '#fff'; d.fillRect(0, 0, 45, 32);
            const w = source.naturalWidth || source.width, h = source.naturalHeight || source.height;
            const s = Math.min(45 / w, 32 / h); d.drawImage(source, (45 - w * s) / 2, (32 - h * s) / 2, w * s, h * s);
            const p = d.getImageData(0, 0, 45, 32).data; const out = [];
            for (let k = 0; k < p.length; k += 4) out.push((p[k] + p[k + 1] + p[k + 2]) / 3); return out; };
        const canvas = document.querySelector('#view canvas');
        canvas.dispatchEvent(new KeyboardEvent('keydown', {key: '+'}));
        canvas.dispatchEvent(new KeyboardEvent('keydown', {key: '-'}));
        const drawn = await new Promise(done => requestAnimationFrame(() => done(gray(canvas))));
        const picture = gray(document.querySelector('#view img'));
        return drawn.reduce((sum, value, k) => sum + Math.abs(value - picture[k]), 0) / drawn.length; })()"""
    )
    assert apart < 25


def test_a_key_turns_the_dome(show):
    screen = show(800)
    first = screen.screenshot()
    screen.evaluate(
        "document.querySelector('#view canvas').dispatchEvent(new KeyboardEvent('keydown', "
        "{key: 'ArrowLeft'})); new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    assert screen.screenshot() != first


def test_without_webgl_the_picture_is_shown_and_nothing_fails(sheet):
    leave_out_or_fail(FOUND, os.environ)
    with launched(*WITHOUT_WEBGL) as browser:
        pages = Pages(browser)
        plain = pages.open(sheet, 800)
        assert plain.evaluate("document.createElement('canvas').getContext('webgl')") is None
        assert pages.errors == []
        assert plain.evaluate("document.querySelectorAll('#view canvas').length") == 0
        seen = "(i => [i.naturalWidth, i.clientWidth > 200, getComputedStyle(i).visibility])"
        assert plain.evaluate(f"{seen}(document.querySelector('#view img'))") == [900, True, "visible"]


def test_the_page_prints_every_section_on_light_ground_within_the_paper(show):
    screen = show(1400)
    document = pypdfium2.PdfDocument(screen.pdf(prefer_css_page_size=True))
    text = "\n".join(sheet.get_textpage().get_text_range() for sheet in document)
    for section in SECTIONS:
        assert section in text
    assert len(document) <= 10
    for number, sheet in enumerate(document):
        image = sheet.render(scale=1).to_numpy()[..., :3]
        # The ground is the paper, and nothing reaches into the margins.
        assert (image.min(axis=2) > 200).mean() > 0.6, number
        assert (image[:, :25] > 245).all(), number
        assert (image[:, -25:] > 245).all(), number
    # The picture of the sensor is on the first sheet, in colour.
    first = document[0].render(scale=1).to_numpy()[..., :3].astype(int)
    assert (abs(first[..., 0] - first[..., 2]) > 60).sum() > 2000


def test_no_figure_and_no_row_is_cut_by_the_end_of_a_sheet(show):
    """Printed on endless paper and on sheets there are as many letters, and no figure is higher than a sheet."""
    screen = show(1400)
    screen.emulate_media(media="print")
    high = screen.evaluate("[...document.querySelectorAll('figure, tr, .tiles')].map(e => e.offsetHeight)")
    assert max(high) < 900
    kept = screen.evaluate(
        "[...document.querySelectorAll('figure, tr, .tiles, .view')].every("
        "e => getComputedStyle(e).breakInside == 'avoid')"
    )
    assert kept
