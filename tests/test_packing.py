"""Packing: nothing overlaps, nothing leaves the room, all or a refusal that counts right."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.packing import PackingArea, in_rows, pack

SIDES = st.floats(2.0, 60.0, allow_nan=False).map(lambda x: round(x, 3))
SIZES = st.lists(st.tuples(SIDES, SIDES), min_size=1, max_size=40)
ROOMS = st.builds(PackingArea, st.floats(80, 400), st.floats(80, 400), st.floats(0, 10), st.floats(0.5, 8))


def boxes(sizes, places):
    for (width, depth), place in zip(sizes, places, strict=True):
        across, along = (depth, width) if place.turned else (width, depth)
        yield place.x, place.y, place.x + across, place.y + along


def gap(one, other):
    """Distance along the axis that parts two boxes most; negative where they overlap."""
    return max(one[0] - other[2], other[0] - one[2], one[1] - other[3], other[1] - one[3])


@given(SIZES, ROOMS)
def test_all_are_placed_apart_inside_the_room_or_the_tray_is_refused(sizes, room):
    try:
        places = pack(sizes, room)
    except InputError as error:
        fit, asked = map(int, re.search(r"(\d+) of (\d+) parts fit", str(error)).groups())
        assert asked == len(sizes)
        assert fit < asked
        return
    found = list(boxes(sizes, places))
    for left, low, right, high in found:
        assert left >= room.margin - 1e-9 and low >= room.margin - 1e-9
        assert right <= room.width - room.margin + 1e-6 and high <= room.depth - room.margin + 1e-6
    for k, one in enumerate(found):
        for other in found[:k]:
            assert gap(one, other) >= room.spacing - 1e-6
    assert places == pack(sizes, room)


@given(st.tuples(SIDES, SIDES), ROOMS)
def test_equal_squares_fill_the_grid_that_they_can(size, room):
    """The trivial bound: rows times columns. Shelves reach it, and one square more is refused."""
    side = size[0]
    columns, rows = (
        math.floor((length - 2 * room.margin + room.spacing + 1e-9) / (side + room.spacing))
        for length in (room.width, room.depth)
    )
    count = columns * rows
    # Places are rounded up to a micrometre: the last column may be lost where it fits to less than one a column.
    slack = min(
        (length - 2 * room.margin + room.spacing) - n * (side + room.spacing)
        for length, n in ((room.width, columns), (room.depth, rows))
    )
    if slack < 1e-3 * max(columns, rows) or count == 0:
        return
    assert len(pack([(side, side)] * count, room)) == count
    with pytest.raises(InputError, match=f"{count} of {count + 1} parts fit"):
        pack([(side, side)] * (count + 1), room)


@given(st.lists(st.tuples(st.floats(4, 12), st.floats(4, 12)), min_size=60, max_size=120))
def test_shelves_waste_less_than_half(sizes):
    """What next-fit decreasing height is known to keep (Coffman et al. 1980): depth at most twice the area plus one row."""
    room = PackingArea(150.0, 1000.0, 0.0, 0.5)
    places = pack(sizes, room)
    depth = max(box[3] for box in boxes(sizes, places)) + room.spacing
    area = sum((w + room.spacing) * (d + room.spacing) for w, d in sizes)
    tallest = max(max(size) for size in sizes) + room.spacing
    assert depth <= 2 * area / (room.width - 12) + tallest


def test_a_long_part_is_turned_where_only_that_fits():
    (place,) = pack([(10.0, 90.0)], PackingArea(100.0, 50.0, 2.0, 1.0))
    assert place.turned
    assert (place.x, place.y) == (2.0, 2.0)


def test_a_part_that_fits_no_way_is_refused():
    with pytest.raises(InputError, match="0 of 1 parts fit on the tray of 100 x 50 mm"):
        pack([(60.0, 60.0)], PackingArea(100.0, 50.0, 0.0, 1.0))


def plain_rows(sizes, room):
    """How many of ``sizes`` go into rows one after another, none turned; those that do not fit are passed over."""
    x, y, depth, count = room.margin, room.margin, 0.0, 0
    for width, length in sizes:
        inside = x + width <= room.width - room.margin + 1e-9
        if not (count and inside and length <= depth + 1e-9):
            start = y + depth + room.spacing if count else y
            if start + length > room.depth - room.margin + 1e-9 or width > room.width - 2 * room.margin + 1e-9:
                continue
            x, y, depth = room.margin, start, length
        x += width + room.spacing
        count += 1
    return count


FEW = st.lists(st.tuples(SIDES, SIDES), min_size=5, max_size=25)
SMALL = st.builds(PackingArea, st.floats(80, 160), st.floats(80, 160), st.just(2.0), st.just(2.0))


@given(FEW, SMALL)
def test_filling_gaps_places_no_fewer_than_plain_rows(sizes, room):
    places = in_rows(sizes, room)
    found = [place for place in places if place is not None]
    assert len(found) >= plain_rows(sizes, room)
    placed = list(boxes([size for size, place in zip(sizes, places, strict=True) if place is not None], found))
    for k, one in enumerate(placed):
        assert one[2] <= room.width - room.margin + 1e-6 and one[3] <= room.depth - room.margin + 1e-6
        for other in placed[:k]:
            assert gap(one, other) >= room.spacing - 1e-6


def test_a_gap_is_not_filled_where_that_costs_a_part():
    """Gaps filled, two of the seven do not fit; in plain rows one does not."""
    sizes = [(19.0, 27.0), (26.0, 23.0), (28.0, 4.0), (12.0, 27.0), (20.0, 20.0), (6.0, 27.0), (17.0, 39.0)]
    assert in_rows(sizes, PackingArea(60.0, 60.0, 0.0, 1.0)).count(None) == 1
