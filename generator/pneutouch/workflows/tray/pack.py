"""Shelf packing: rectangles in rows, the deepest first, each turned by 90 degrees where that makes less of a row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pneutouch.errors import InputError

_ROUNDING = 1e-9
"""Sums of lengths may miss the room by this, mm."""

_DECIMALS = 3
"""Places are whole micrometres: positions are read and written by people."""


@dataclass(frozen=True, slots=True)
class PackedPosition:
    """Lower left corner of a rectangle in mm, and whether it is turned by 90 degrees counter-clockwise."""

    x: float
    y: float
    turned: bool


@dataclass(frozen=True, slots=True)
class PackingArea:
    """A rectangle to pack into: width and depth in mm, the free border, and the least gap between rectangles."""

    width: float
    depth: float
    margin: float
    spacing: float


def pack(sizes: Sequence[tuple[float, float]], room: PackingArea, where: str = "tray") -> list[PackedPosition]:
    """Places for rectangles of ``sizes`` (width, depth; mm), in their order; the same for the same input.

    Rectangles lie on shelves along the width. Each shelf is as deep as its first rectangle, and rectangles come in
    the order of their shorter side, which then stands across the shelf: equal ones share shelves. Both ways of
    standing the rectangles up are tried, and the one that needs the fewest shelves' depth is taken.

    Raises InputError, saying how many fit, where not all do.
    """
    tries = [_shelves(sizes, room, flat) for flat in (True, False)]
    best = min(tries, key=lambda found: (-found[0], found[1]))
    if best[0] < len(sizes):
        raise InputError(
            f"{where}: {best[0]} of {len(sizes)} parts fit on the tray of {room.width:g} x {room.depth:g} mm with "
            f"{room.spacing:g} mm between them and {room.margin:g} mm of border; take fewer copies, less spacing_mm or a larger printer"
        )
    return [place for place in best[2] if place is not None]


def _shelves(
    sizes: Sequence[tuple[float, float]], room: PackingArea, flat: bool
) -> tuple[int, float, list[PackedPosition | None]]:
    """How many were placed, the depth taken, and the places; ``flat`` lays the longer sides along the shelf."""
    laid = [_laid(size, room, flat) for size in sizes]
    order = sorted(range(len(sizes)), key=lambda k: (-laid[k][1], -laid[k][0], k))
    places: list[PackedPosition | None] = [None] * len(sizes)
    shelves: list[list[float]] = []  # y, depth, x where the next one may start
    top, count = room.margin, 0
    for k in order:
        width, depth, turned = laid[k]
        shelf = next((s for s in shelves if _fits(s[2], width, room.width, room) and depth <= s[1] + _ROUNDING), None)
        if shelf is None:
            if not _fits(top, depth, room.depth, room) or not _fits(room.margin, width, room.width, room):
                continue
            shelf = [top, depth, room.margin]
            shelves.append(shelf)
            top = _up(top + depth + room.spacing)
        places[k] = PackedPosition(shelf[2], shelf[0], turned)
        shelf[2] = _up(shelf[2] + width + room.spacing)
        count += 1
    return count, top, places


def _laid(size: tuple[float, float], room: PackingArea, flat: bool) -> tuple[float, float, bool]:
    """Width, depth and whether turned: as ``flat`` asks, else the way that fits at all."""
    ways = [(size[0], size[1], False), (size[1], size[0], True)]
    ways.sort(key=lambda way: (way[1] if flat else way[0], way[2]))
    fitting = [
        way for way in ways
        if _fits(room.margin, way[0], room.width, room) and _fits(room.margin, way[1], room.depth, room)
    ]  # fmt: skip
    return (fitting or ways)[0]


def _fits(start: float, length: float, whole: float, room: PackingArea) -> bool:
    return start + length <= whole - room.margin + _ROUNDING


def _up(length: float) -> float:
    """The next whole micrometre that is not less."""
    rounded = round(length, _DECIMALS)
    return rounded if rounded >= length - _ROUNDING else round(rounded + 10**-_DECIMALS, _DECIMALS)
