"""Packing of rectangles in rows: `pack` sorts and turns them, `in_rows` keeps their order and orientation."""

from collections.abc import Sequence
from dataclasses import dataclass

from pneutouch.errors import InputError

_ROUNDING = 1e-9
"""Tolerance of sums of lengths, mm."""

_DECIMALS = 3
"""Decimals of a position in mm: whole micrometres, because people read and write positions."""


@dataclass(frozen=True, slots=True)
class PackedPosition:
    """Lower left corner (x, y) of a rectangle, mm; ``turned``: True if rotated by 90 degrees counter-clockwise."""

    x: float
    y: float
    turned: bool = False


@dataclass(frozen=True, slots=True)
class PackingArea:
    """A rectangle to pack into, mm: width (x), depth (y), free border ``margin``, least gap ``spacing`` of parts."""

    width: float
    depth: float
    margin: float
    spacing: float


def pack(sizes: Sequence[tuple[float, float]], area: PackingArea, where: str = "tray") -> list[PackedPosition]:
    """Positions of rectangles of ``sizes`` (width, depth; mm), in the order of ``sizes``.

    Two layouts are tried: all longer sides along the rows, and all across them. In each the deepest rectangle is placed
    first, and gaps of earlier rows are filled. The layout that holds more is taken, of two equal ones the less deep.

    Raises InputError with the number that fits if not all do; ``where`` is the file that the error names.
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
    """Positions of rectangles (width, depth; mm) in their order, row after row, none turned; None: does not fit.

    Only if not all fit, gaps of earlier rows are filled too, unless that places fewer rectangles.
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
    """Number of rectangles placed, depth used (mm) and positions; ``flat`` puts the longer sides along the rows."""
    boxes = [_box(size, area, flat) for size in sizes]
    order = sorted(range(len(sizes)), key=lambda k: (-boxes[k][1], -boxes[k][0], k))
    depth, places = _rows(boxes, order, area, fill_gaps=True)
    return len(places) - places.count(None), depth, places


def _rows(
    boxes: Sequence[tuple[float, float, bool]], order: Sequence[int], area: PackingArea, *, fill_gaps: bool
) -> tuple[float, list[PackedPosition | None]]:
    """Depth used (mm), and positions of boxes (width, depth, turned), placed in the order of the indices ``order``.

    With ``fill_gaps`` a box goes into the first row with space, at whole micrometres; without, into the last row only.
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
    """Width, depth (mm), True if turned: depth is the shorter side if ``flat``, else the longer, where that fits."""
    options = [(size[0], size[1], False), (size[1], size[0], True)]
    options.sort(key=lambda option: (option[1] if flat else option[0], option[2]))
    within = (
        o for o in options if _fits(area.margin, o[0], area.width, area) and _fits(area.margin, o[1], area.depth, area)
    )
    return next(within, options[0])


def _fits(start: float, length: float, whole: float, area: PackingArea) -> bool:
    return start + length <= whole - area.margin + _ROUNDING


def _up(length: float) -> float:
    """A length (mm) rounded up to whole micrometres."""
    rounded = round(length, _DECIMALS)
    return rounded if rounded >= length - _ROUNDING else round(rounded + 10**-_DECIMALS, _DECIMALS)
