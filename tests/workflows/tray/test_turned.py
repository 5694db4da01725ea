"""Parts turned to fit: where they come to lie on the tray, by their own vertices."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.body import Body
from pneutouch.packing import PackedPosition, PackingArea, pack
from pneutouch.parts.lettering.mark import Mark
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.tray.lay import TrayPart, lay
from pneutouch.workflows.tray.order import order_of_flags

SIDES = st.floats(2.0, 40.0).map(lambda x: round(x, 3))


def brick(library, x, y, place, name="A1-brick"):
    """A part whose vertices are four corners of a box: all that bounds and transforms look at."""
    vertices = np.array([[0, 0, 0], [x, 0, 0], [x, y, 3.0], [0, y, 0]], float)
    body = Body(name, "connector", library.load("materials", "ABS"), vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    return TrayPart(name, None, 1, (), (body,), (Mark("none"),), place)


def boxes(part):
    low = np.min([body.bounds[0] for body in part.on_tray()], axis=0)
    return low, np.max([body.bounds[1] for body in part.on_tray()], axis=0)


def apart(one, other):
    return np.maximum(one[0] - other[1], other[0] - one[1])[:2].max()


def test_a_turned_part_lies_in_its_place(library):
    part = brick(library, 30.0, 10.0, PackedPosition(5.0, 7.0, True))
    low, high = boxes(part)
    assert low == pytest.approx([5.0, 7.0, 0.0])
    assert high == pytest.approx([15.0, 37.0, 3.0])
    assert part.footprint == (10.0, 30.0)
    # Counter-clockwise: what was along x is along y.
    assert part.transform[0] == pytest.approx([0, 1, 0])


@given(st.lists(st.tuples(SIDES, SIDES), min_size=1, max_size=12))
def test_packed_bricks_lie_in_their_places_and_apart(library, sizes):
    room = PackingArea(120.0, 600.0, 4.0, 2.0)
    parts = [brick(library, x, y, place) for (x, y), place in zip(sizes, pack(sizes, room), strict=True)]
    found = [boxes(part) for part in parts]
    for part, (low, high) in zip(parts, found, strict=True):
        assert low[:2] == pytest.approx([part.place.x, part.place.y])
        assert high[:2] - low[:2] == pytest.approx(part.footprint)
        assert (low[:2] >= 4.0 - 1e-6).all() and (high[:2] <= [116.0 + 1e-6, 596.0 + 1e-6]).all()
    assert all(apart(one, other) >= 2.0 - 1e-6 for one, other in combinations(found, 2))


def test_a_laid_tray_with_turned_parts_keeps_them_in_their_places_and_apart(library):
    changes = ["connector.mount=finger-16"]
    laid = lay(
        order_of_flags(["paper-dome"], [], 6, parse_changes(changes), profile="abs-filament", marks="none"), library
    )
    turned = [part for part in laid.parts if part.place.turned and abs(part.size[0] - part.size[1]) > 1]
    assert turned, "no part that is not square was turned"
    found = [boxes(part) for part in laid.parts]
    for part, (low, high) in zip(laid.parts, found, strict=True):
        assert low[:2] == pytest.approx([part.place.x, part.place.y], abs=2e-3)
        assert (high[:2] <= np.add([part.place.x, part.place.y], part.footprint) + 2e-3).all()
    assert all(apart(one, other) >= laid.order.tray.tray.spacing_mm - 2e-3 for one, other in combinations(found, 2))
