"""What the measurements say of shapes whose sizes are known, in any position."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold

from pneutouch.parts.coupons import COUPONS, CouponContext
from pneutouch.parts.coupons.gauge import HOLES, PINS, SLOTS, WALLS
from pneutouch.printability import PrintItem
from pneutouch.printability.measure.cavities import NARROW, balls, build_frame, fill, pockets, seen, supported, unseen
from pneutouch.printability.view import NARROW as NARROW_HOLE
from pneutouch.printability.view import PrintPart
from tests.printability.gallery import ball, box, cup, item, material, meander, printer, prism, rod

SIZES = st.floats(0.2, 0.95)
ANGLES = st.tuples(st.floats(0, 360), st.floats(0, 360), st.floats(0, 360))
EXACT = 1e-6


def places(shape: Manifold, **more):
    return PrintPart(item(shape, **more)).places


def thinnest(shape: Manifold, kind: str, **more):
    found = [place for place in places(shape, **more) if place.kind == kind]
    assert found, kind
    return found[0]


@settings(max_examples=12)
@given(SIZES, ANGLES)
def test_a_plate_measures_its_thickness_in_any_position(thickness, angles):
    found = places(box(15, 12, thickness).rotate(angles))
    assert [place.kind for place in found] == ["wall"]
    assert found[0].size == pytest.approx(thickness, abs=EXACT)


@settings(max_examples=12)
@given(SIZES, ANGLES)
def test_a_rod_measures_its_diameter_in_any_position(diameter, angles):
    solid = box(8, 8, 4) + rod(0.5 * diameter, 8, (4.0, 4.0, 3.0))
    found = places(solid.rotate(angles))
    assert [place.kind for place in found] == ["pin"]
    # Flat to flat of a polygon of 96 sides.
    assert found[0].size == pytest.approx(diameter * math.cos(math.pi / 96), abs=1e-4)
    assert found[0].length == pytest.approx(7.0, rel=0.15)


@settings(max_examples=12)
@given(SIZES, ANGLES)
def test_a_square_pin_measures_its_side_in_any_position(side, angles):
    found = places((box(8, 8, 4) + box(side, side, 8, (4.0, 4.0, 3.0))).rotate(angles))
    assert [place.kind for place in found] == ["pin"]
    assert found[0].size == pytest.approx(side, abs=EXACT)


@settings(max_examples=12)
@given(SIZES, ANGLES)
def test_a_bore_measures_its_diameter_and_length_in_any_position(diameter, angles):
    found = places((box(8, 8, 6) - rod(0.5 * diameter, 8, (4.0, 4.0, -1.0))).rotate(angles))
    assert [place.kind for place in found] == ["channel"]
    assert found[0].size == pytest.approx(diameter * math.cos(math.pi / 96), abs=1e-4)
    assert found[0].length == pytest.approx(6.0, rel=0.1)


@settings(max_examples=12)
@given(SIZES, ANGLES)
def test_a_slot_measures_its_width_in_any_position(width, angles):
    found = places((box(12, 12, 8) - box(width, 14, 4, (6.0, -1.0, 4.5))).rotate(angles))
    assert [place.kind for place in found] == ["gap"]
    assert found[0].size == pytest.approx(width, abs=EXACT)


@settings(max_examples=12)
@given(st.floats(0.2, 0.45), st.floats(0.45, 0.9), ANGLES)
def test_a_ridge_and_a_groove_measure_width_and_height_in_any_position(width, height, angles):
    ridge = box(12, 12, 5) + box(8, width, height + 1, (2.0, 6.0, 4.0))
    groove = box(12, 12, 5) - box(8, width, height + 1, (2.0, 6.0, 5.0 - height))
    for solid, kind in ((ridge, "raised"), (groove, "engraved")):
        found = places(solid.rotate(angles))
        assert [place.kind for place in found] == [kind]
        assert found[0].size == pytest.approx(width, abs=1e-5)


@settings(max_examples=15)
@given(st.floats(0.3, 0.95), ANGLES)
def test_a_tube_measures_its_wall_in_any_position(wall, angles):
    found = places((rod(4.0 + wall, 8) - rod(4.0, 10, (0.0, 0.0, -1.0))).rotate(angles))
    assert [place.kind for place in found] == ["wall"]
    assert found[0].size == pytest.approx(wall, abs=0.005)


@settings(max_examples=10)
@given(st.floats(0.3, 0.95), ANGLES)
def test_a_dome_measures_its_wall_in_any_position(wall, angles):
    found = [place for place in places(cup(10, wall).rotate(angles)) if place.kind == "wall"]
    assert found[0].size == pytest.approx(wall, abs=0.012)


class Ball:
    """The exact shell between two spheres."""

    name, volume = "ball", 0.0

    def __init__(self, *radii):
        self.radii = radii

    def distance(self, points):
        away = np.linalg.norm(points, axis=1)
        return np.min([np.abs(away - radius) for radius in self.radii], axis=0)


@pytest.mark.parametrize("wall", [0.3, 0.61, 0.99])
def test_the_exact_solid_makes_a_thickness_exact(wall):
    """The mesh alone is off by its chords; from exact face to exact face the wall is right to a micrometre."""
    shell = ball(10, sides=64) - ball(10 - wall, sides=48)
    assert abs(thinnest(shell, "wall").size - wall) > 0.003
    assert thinnest(shell, "wall", solid=Ball(10, 10 - wall)).size == pytest.approx(wall, abs=1e-3)


@pytest.mark.parametrize("angle", [50, 60, 80])
def test_a_wide_wedge_has_no_thin_place(angle):
    assert places(prism([(0, 0), (15, 0), (15, 15 * math.tan(math.radians(angle)))], 10)) == []


@pytest.mark.parametrize("angle", [10, 20, 40])
def test_a_sharp_wedge_is_left_to_the_rule_on_edges(angle):
    assert places(prism([(0, 0), (15, 0), (15, 15 * math.tan(math.radians(angle)))], 10)) == []


def test_a_blunt_taper_counts_half_a_millimetre_from_its_end():
    slope = 0.1
    found = thinnest(prism([(0, 0), (15, 0), (15, 0.5 + 15 * slope), (0, 0.5)], 10), "wall")
    assert found.size == pytest.approx(0.5 + 0.5 * slope, abs=0.005)


def test_a_web_between_a_hole_and_an_edge_is_a_wall():
    web = box(12, 12, 2) - rod(2, 4, (2.6, 6.0, -1.0))
    assert [place.kind for place in places(web)] == ["wall"]
    assert thinnest(web, "wall").size == pytest.approx(0.6, abs=0.005)


def test_small_things_on_a_large_part_are_seen():
    solid = box(100, 100, 5) + rod(0.15, 4, (13.7, 71.3, 4.0)) - rod(0.15, 7, (77.1, 20.9, -1.0))
    assert {place.kind for place in places(solid)} == {"pin", "channel"}


def test_the_gauge_is_measured_feature_by_feature():
    """The coupon that tells what a machine resolves has a row each of walls, pins, holes and slots of known sizes."""
    context = CouponContext(material("VeroClear"))
    gauge = next(solid for solid in COUPONS["gauge"].draw(context) if solid.name == "gauge")
    body = gauge.mesh(printer().finest_step(printer().mode[0]))
    found = PrintPart(PrintItem(body, printer(), printer().mode[0], gauge)).places
    for kinds, sizes, most in (
        (("wall",), WALLS, 1.0),
        (("pin",), PINS, 1.0),
        (("hole", "channel"), HOLES, NARROW_HOLE),
        (("gap",), SLOTS, NARROW_HOLE),
    ):
        measured = sorted(place.size for place in found if place.kind in kinds)
        assert measured == pytest.approx([size for size in sizes if size <= most], abs=0.005), kinds


def voxels(solid: Manifold, up=(0.0, 0.0, 1.0)):
    return fill([PrintPart(item(solid)).surface.corners], build_frame(np.asarray(up)))


def test_cubes_fill_the_volume_whichever_way_up():
    solid = ball(6) + box(5, 4, 12)
    for up in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)):
        model = voxels(solid, up)
        assert (model.label > 0).sum() * model.cube == pytest.approx(solid.volume(), rel=0.02)
        # What is outside is joined all around: the cubes at the six sides are empty.
        assert not any(model.label.take(end, axis).any() for axis in range(3) for end in (0, -1))


@pytest.mark.parametrize("opening", [1.5, 2.5, 3.5, 4.5])
def test_a_bottle_measures_its_neck(opening):
    bottle = box(14, 14, 14) - ball(5, (7.0, 7.0, 7.0)) - rod(0.5 * opening, 8, (7.0, 7.0, 7.0))
    model = voxels(bottle)
    (pocket,) = pockets(model, balls(model))
    assert pocket.opening == pytest.approx(opening, abs=2 * model.pitch)
    assert pocket.width == pytest.approx(10, abs=2 * model.pitch)
    assert pocket.volume == pytest.approx(4 / 3 * math.pi * 125, rel=0.15)
    assert pocket.where == pytest.approx((7, 7, 7), abs=1.0)


@pytest.mark.parametrize("opening", [8.0, 9.0, 10.0])
def test_a_pot_has_no_neck(opening):
    assert 0.1 * opening > NARROW
    model = voxels(box(14, 14, 14) - ball(5, (7.0, 7.0, 7.0)) - rod(0.5 * opening, 8, (7.0, 7.0, 7.0)))
    assert pockets(model, balls(model)) == []


def test_a_jet_sees_into_a_cup_and_not_around_corners():
    for solid, hidden in ((cup(), False), (box(12, 12, 12) - rod(1.5, 14, (6.0, 6.0, -1.0)), False), (meander(), True)):
        model = voxels(solid)
        assert bool(unseen(model, balls(model), seen(model)).any()) is hidden


def test_support_fills_what_lies_under_something():
    """Under a table: its top less its legs, times the height."""
    table = box(20, 20, 2, (0.0, 0.0, 8.0)) + box(4, 4, 9, (0.0, 0.0, 0.0)) + box(4, 4, 9, (16.0, 16.0, 0.0))
    model = voxels(table)
    assert supported(model).sum() * model.cube == pytest.approx((400 - 32) * 8, rel=0.06)
