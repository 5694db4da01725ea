"""Short labels as flat shapes whose strokes and gaps a printer can make, and the least width of a flat shape."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array

FONTS = Path(__file__).with_name("fonts")
"""Inter, the typeface of labels, sheets and charts."""

_EM = 100.0
"""Font size at which outlines are taken: matplotlib flattens curves to a fixed length."""

_SMOOTH = 0.004
"""Size of detail in mm removed from outlines: a quarter of the finest layer of any shipped printer."""

_SEGMENTS = 32
"""Number of corners of the disc with which widths are measured."""

_SCAN = 0.02
"""Radius step in mm of the search for the first change."""

_FINEST = 1e-3
"""Accuracy of a measured width, mm."""


def lettering(text: str, height: float, least: float) -> Any:
    """CrossSection (manifold3d) of ``text``, centred, capitals ``height`` mm tall, in Inter SemiBold.

    Strokes thinner than ``least`` mm are widened to it, and glyphs are at least ``least`` apart.
    """
    from manifold3d import CrossSection, OpType

    gap, shapes, x = max(least, 0.12 * height), [], 0.0
    for character in text:
        glyph = _glyph(character, height, least)
        low, _, high, _ = glyph.bounds()
        shapes.append(glyph.translate((x - low, 0.0)))
        x += high - low + gap
    whole = CrossSection.batch_boolean(shapes, OpType.Add)
    low, bottom, high, top = whole.bounds()
    return whole.translate((-0.5 * (low + high), -0.5 * (bottom + top)))


def narrowest(shape: Any) -> float:
    """Least width in mm of a CrossSection: diameter of the largest disc whose erosion leaves all parts and holes.

    Searched in steps from thin to thick: beyond the first change, parts that split may vanish and seem whole again.
    """
    parts, contours = len(shape.decompose()), shape.num_contour()

    def keeps(radius: float) -> bool:
        eroded = shape.offset(-radius, _round(), 2.0, _SEGMENTS)
        return len(eroded.decompose()) == parts and eroded.num_contour() == contours

    thin, thick = 0.0, _SCAN
    while keeps(thick):
        thin, thick = thick, thick + _SCAN
    while thick - thin > 0.25 * _FINEST:
        middle = 0.5 * (thin + thick)
        thin, thick = (middle, thick) if keeps(middle) else (thin, middle)
    return 2 * thin


def is_clear(characters: str, height: float, least: float) -> bool:
    """True if neither the strokes of the glyphs nor the spaces enclosed by them are narrower than ``least`` mm."""
    return all(
        narrowest(shape) >= least - _FINEST
        for character in sorted(set(characters))
        for glyph in [_glyph(character, height, least)]
        for shape in (glyph, _enclosed(glyph))
        if not shape.is_empty()
    )


def rounded(shape: Any) -> Any:
    """Shape with its corners on a grid of 0.1 um, so that a reader in float32 does not merge any of them."""
    from manifold3d import CrossSection, FillRule

    return CrossSection([np.round(polygon, 4) for polygon in shape.to_polygons()], FillRule.EvenOdd)


@lru_cache
def _glyph(character: str, height: float, least: float) -> Any:
    """One glyph on its baseline, with thin strokes widened."""
    from manifold3d import CrossSection, FillRule

    capital = float(np.ptp(np.concatenate(_outlines("H"))[:, 1]))
    outlines = [polygon * (height / capital) for polygon in _outlines(character)]
    glyph = CrossSection(outlines, FillRule.NonZero).simplify(_SMOOTH)
    missing = least - narrowest(glyph)
    return glyph.offset(0.5 * missing + _FINEST, _round(), 2.0, _SEGMENTS).simplify(_SMOOTH) if missing > 0 else glyph


def _enclosed(glyph: Any) -> Any:
    """Spaces enclosed by a glyph, such as the inside of an A."""
    from manifold3d import CrossSection

    # Outlines run counter-clockwise, holes clockwise: with the outlines only, the positive rule fills everything.
    return CrossSection([line for line in glyph.to_polygons() if _area(line) > 0]) - glyph


@lru_cache
def _outlines(character: str) -> tuple[Array, ...]:
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    path = TextPath((0, 0), character, size=_EM, prop=FontProperties(fname=str(FONTS / "Inter-SemiBold.otf")))
    return tuple(np.asarray(polygon)[:-1] for polygon in path.to_polygons())


def _area(line: Array) -> float:
    x, y = line.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _round() -> Any:
    from manifold3d import JoinType

    return JoinType.Round
