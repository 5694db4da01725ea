"""The studio's three areas side by side: ``python -m benchmarks.filmstrip`` makes docs/filmstrip.png of docs/howto/studio-*.png."""

from __future__ import annotations

from pathlib import Path

from PIL import Image, ImageDraw

DOCS = Path(__file__).resolve().parents[1] / "docs"
AREAS = ("target", "wide", "files")
"""From a target to a design to its files, as ``benchmarks.studio_pictures`` draws them."""

WIDTH, HEIGHT, GAP = 640, 411, 16
"""Pixels of one screen and between two; a screen is cut to 1400 by 900 before."""

_FRAME = "#9aa5b1"

_COLOURS = 128
"""As in ``benchmarks.studio_pictures``."""


def strip(screens: list[Image.Image]) -> Image.Image:
    """Screens side by side on white, each scaled to one size from its upper left part."""
    whole = Image.new("RGB", (len(screens) * (WIDTH + GAP) - GAP, HEIGHT), "white")
    draw = ImageDraw.Draw(whole)
    for place, screen in enumerate(screens):
        part = screen.convert("RGB").crop((0, 0, screen.width, round(screen.width * HEIGHT / WIDTH)))
        left = place * (WIDTH + GAP)
        whole.paste(part.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS), (left, 0))
        draw.rectangle((left, 0, left + WIDTH - 1, HEIGHT - 1), outline=_FRAME)
    return whole


def main() -> None:
    whole = strip([Image.open(DOCS / "howto" / f"studio-{area}.png") for area in AREAS])
    path = DOCS / "filmstrip.png"
    whole.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"wrote docs/{path.name}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
