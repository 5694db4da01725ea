"""Shelf packing: rectangles in rows, the deepest first, each turned by 90 degrees where that makes a row less deep."""

from collections.abc import Sequence
from dataclasses import dataclass

from pneutouch.errors import InputError

_ROUNDING = 1e-9
"""Tolerance of sums of lengths, mm."""

_DECIMALS = 3
"""Places are whole micrometres: positions are read and written by people."""


@dataclass(frozen=True, slots=True)
class PackedPosition:
    """Lower left corner of a rectangle in mm, and whether it is turned by 90 degrees counter-clockwise."""

    x: float
    y: float
    turned: bool = False


@dataclass(frozen=True, slots=True)
class PackingArea:
    """A rectangle to pack into: width and depth in mm, the free border, and the least gap between rectangles."""

    width: float
    depth: float
    margin: float
    spacing: float


def pack(sizes: Sequence[tuple[float, float]], area: PackingArea, where: str = "tray") -> list[PackedPosition]:
    """Places for rectangles of ``sizes`` (width, depth; mm), in their order; the same for the same input.

    Rectangles are placed by the length of their shorter side, which stands across the row: equal ones share rows, and
    gaps of earlier rows are filled. Both orientations are tried; the one whose rows are less deep in all is taken.

    Raises InputError, stating how many fit, where not all do.
    """
    trials = [_oriented(sizes, area, flat) for flat in (True, False)]
    count, _, places = min(trials, key=lambda trial: (-trial[0], trial[1]))
    if count < len(sizes):
        raise InputError(
            f"{count} of {len(sizes)} parts fit on the tray of {area.width:g} x {area.depth:g} mm with "
            f"{area.spacing:g} mm between them and {area.margin:g} mm of border",
            file=where,
            remedy="take fewer copies, less spacing_mm or a larger printer",
        )
    return [place for place in places if place is not None]


def in_rows(sizes: Sequence[tuple[float, float]], area: PackingArea) -> list[PackedPosition | None]:
    """Places for rectangles in their order, row after row, none turned; None for one that does not fit.

    Gaps of earlier rows are filled where not all fit without that, unless plain rows then hold more.
    """
    boxes = [(width, depth, False) for width, depth in sizes]
    plain = _rows(boxes, range(len(sizes)), area, fill_gaps=False)[1]
    if None not in plain:
        return plain
    filled = _rows(boxes, range(len(sizes)), area, fill_gaps=True)[1]
    # A gap may take a part that would have begun a row, and the row then has no space for the parts after it.
    return min(filled, plain, key=lambda places: places.count(None))


def _oriented(
    sizes: Sequence[tuple[float, float]], area: PackingArea, flat: bool
) -> tuple[int, float, list[PackedPosition | None]]:
    """Number of rectangles placed, the depth taken, and the places; ``flat`` puts the longer sides along the row."""
    boxes = [_box(size, area, flat) for size in sizes]
    order = sorted(range(len(sizes)), key=lambda k: (-boxes[k][1], -boxes[k][0], k))
    depth, places = _rows(boxes, order, area, fill_gaps=True)
    return len(places) - places.count(None), depth, places


def _rows(
    boxes: Sequence[tuple[float, float, bool]], order: Sequence[int], area: PackingArea, *, fill_gaps: bool
) -> tuple[float, list[PackedPosition | None]]:
    """The depth taken, and places of boxes (width, depth, turned); ``order`` is that of placing.

    ``fill_gaps`` tries every row, the first one first, and places on whole micrometres; else the last row alone.
    """
    places: list[PackedPosition | None] = [None] * len(boxes)
    rows: list[list[float]] = []  # y, depth, x where the next one may start
    step = _up if fill_gaps else float
    top = area.margin
    for k in order:
        width, depth, turned = boxes[k]
        tried = rows if fill_gaps else rows[-1:]
        row = next((r for r in tried if _fits(r[2], width, area.width, area) and depth <= r[1] + _ROUNDING), None)
        if row is None:
            if not _fits(top, depth, area.depth, area) or not _fits(area.margin, width, area.width, area):
                continue
            row = [top, depth, area.margin]
            rows.append(row)
            top = step(top + depth + area.spacing)
        places[k] = PackedPosition(row[2], row[0], turned)
        row[2] = step(row[2] + width + area.spacing)
    return top, places


def _box(size: tuple[float, float], area: PackingArea, flat: bool) -> tuple[float, float, bool]:
    """Width, depth and whether turned: as ``flat`` requires, else the orientation that fits at all."""
    options = [(size[0], size[1], False), (size[1], size[0], True)]
    options.sort(key=lambda option: (option[1] if flat else option[0], option[2]))
    within = (
        o for o in options if _fits(area.margin, o[0], area.width, area) and _fits(area.margin, o[1], area.depth, area)
    )
    return next(within, options[0])


def _fits(start: float, length: float, whole: float, area: PackingArea) -> bool:
    return start + length <= whole - area.margin + _ROUNDING


def _up(length: float) -> float:
    """The next whole micrometre that is not less."""
    rounded = round(length, _DECIMALS)
    return rounded if rounded >= length - _ROUNDING else round(rounded + 10**-_DECIMALS, _DECIMALS)
