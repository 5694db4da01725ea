"""Pictures of the studio and of the tutorials: ``python -m pictures.studio [DIR]`` writes PNG files into docs/.

Without DIR it makes the studio's own, docs/howto/studio-*.png and docs/filmstrip.png, and needs a browser. With the
folder of ``python -m tests.pages docs/tutorials/*.md --keep DIR`` it makes those of the tutorials.
"""

from __future__ import annotations

import io
import shutil
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page
from tests.browser import WITH_WEBGL, Pages, launched, until
from tests.studio.served import SOLVED, Studio, served

DOCS = Path(__file__).resolve().parents[2]
SIZES = {
    "wide": (1400, 900, False),
    "dark": (1400, 900, True),
    "narrow": (360, 780, False),
    "large": (2560, 1440, True),
}
"""Width and height in pixels, and whether in the dark."""

PRESSED = "tutorials/first-sensor-pressed.png", "first-sensor/outputs/my-sensor/my-sensor-pressed.png"
MOULD = "tutorials/cast-sensor-mould.svg", "cast-sensor/outputs/my-cast/mould/my-cast-mould.svg"
"""A picture of a tutorial and the file in DIR that it is made of."""

_AREAS = ("target", "wide", "files")
"""From a target to a design to its files: the screens of the film strip."""

_WIDTH, _HEIGHT, _GAP = 640, 411, 16
_COLOURS = 128
"""Enough for a page of few colours, at a third of the bytes."""

_LONGEST = 300_000
"""Milliseconds that a build may take."""

_TO_PRESSED = """(slider => { slider.value = Math.round(0.6 * slider.max); slider.dispatchEvent(new Event('input')); })
(document.getElementById('press-depth'))"""


def write(name: str, picture: Image.Image) -> None:
    """A picture with few colours as a file of docs/."""
    few = picture.convert("RGB").quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    few.save(DOCS / name, optimize=True)
    sys.stdout.write(f"wrote docs/{name}: {(DOCS / name).stat().st_size} bytes\n")


def screen(name: str, page: Page) -> None:
    """The window of a page as docs/howto/studio-NAME.png."""
    write(f"howto/studio-{name}.png", Image.open(io.BytesIO(page.screenshot())))


def studio() -> None:
    """Every screen of the studio."""
    with served() as (address, process), launched(*WITH_WEBGL) as browser:
        shown, pages = Studio(address, process), Pages(browser)
        for name, (width, height, dark) in SIZES.items():
            page = shown.open(pages, width=width, height=height, dark=dark)
            until(page, SOLVED)
            page.evaluate(_TO_PRESSED)
            page.wait_for_timeout(1000)
            screen(name, page)
        page = shown.open(pages, width=1400, height=1000)
        page.get_by_role("tab", name="Target").click()
        page.get_by_role("button", name="Example").click()
        page.get_by_role("button", name="Find designs").click()
        page.get_by_role("button", name="Use this design").first.wait_for()
        screen("target", page)
        page.get_by_role("tab", name="Files").click()
        page.get_by_role("button", name="Build", exact=True).click()
        page.get_by_role("link", name="Download all").wait_for(timeout=_LONGEST)
        page.wait_for_timeout(1000)
        screen("files", page)


def strip(screens: list[Image.Image]) -> Image.Image:
    """Screens side by side on white, each scaled to one size from its upper left part."""
    whole = Image.new("RGB", (len(screens) * (_WIDTH + _GAP) - _GAP, _HEIGHT), "white")
    for place, one in enumerate(screens):
        part = one.convert("RGB").crop((0, 0, one.width, round(one.width * _HEIGHT / _WIDTH)))
        left = place * (_WIDTH + _GAP)
        whole.paste(part.resize((_WIDTH, _HEIGHT), Image.Resampling.LANCZOS), (left, 0))
    return whole


def tutorials(folder: Path) -> None:
    """The pictures of the tutorials from the folder of their outputs."""
    picture = Image.open(folder / PRESSED[1])
    size = _WIDTH, round(_WIDTH * picture.height / picture.width)
    write(PRESSED[0], picture.convert("RGB").resize(size, Image.Resampling.LANCZOS))
    shutil.copy(folder / MOULD[1], DOCS / MOULD[0])


def main(*folder: str) -> None:
    """The studio's pictures, or those of the tutorials from a folder."""
    if folder:
        tutorials(Path(folder[0]))
        return
    studio()
    write("filmstrip.png", strip([Image.open(DOCS / "howto" / f"studio-{area}.png") for area in _AREAS]))


if __name__ == "__main__":
    main(*sys.argv[1:])
