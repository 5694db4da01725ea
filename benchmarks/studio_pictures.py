"""The studio's pictures of the documentation: ``python -m benchmarks.studio_pictures`` writes docs/howto/studio-*.png."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page
from tests.browser import WITH_WEBGL, Pages, launched, until
from tests.studio.served import SOLVED, Studio, served

DOCS = Path(__file__).resolve().parents[1] / "docs" / "howto"

_LONGEST = 300_000
"""Milliseconds that a build may take."""

_COLOURS = 128
"""Of a picture: enough for a page of few colours, at a third of the bytes."""

SIZES = {
    "wide": (1400, 900, False),
    "dark": (1400, 900, True),
    "narrow": (360, 780, False),
    "large": (2560, 1440, True),
}
"""Width and height in pixels, and whether in the dark."""

_PRESSED = """(slider => { slider.value = Math.round(0.6 * slider.max); slider.dispatchEvent(new Event('input')); })
(document.getElementById('press-depth'))"""


def write(name: str, page: Page) -> None:
    """What the window of a page shows, as docs/howto/studio-NAME.png with few colours."""
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    path = DOCS / f"studio-{name}.png"
    picture.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"wrote docs/howto/{path.name}: {path.stat().st_size} bytes")


def main() -> None:
    with served() as (address, process), launched(*WITH_WEBGL) as browser:
        studio, pages = Studio(address, process), Pages(browser)
        for name, (width, height, dark) in SIZES.items():
            page = studio.open(pages, width=width, height=height, dark=dark)
            until(page, SOLVED)
            page.evaluate(_PRESSED)
            page.wait_for_timeout(1000)
            write(name, page)
        page = studio.open(pages, width=1400, height=1000)
        page.get_by_role("tab", name="Target").click()
        page.get_by_role("button", name="Example").click()
        page.get_by_role("button", name="Find designs").click()
        page.get_by_role("button", name="Use this design").first.wait_for()
        write("target", page)
        page.get_by_role("tab", name="Files").click()
        page.get_by_role("button", name="Build", exact=True).click()
        page.get_by_role("link", name="Download all").wait_for(timeout=_LONGEST)
        page.wait_for_timeout(1000)
        write("files", page)


if __name__ == "__main__":
    main()
