"""Bodies of every design and of random ones: closed, apart, meeting on the seat, clamped where the mechanics clamps."""

from __future__ import annotations

import itertools
import math
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.body.solid import welded
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.parts.connector import seat_area
from pneutouch.parts.membrane import HELD
from pneutouch.printability.rules.bodies import shared_area
from pneutouch.spec.read import parse_changes
from tests.catalogue.store import BASE, KINDS, SMALL, assembled, combinations
from tests.conftest import ROOT
from tests.parts.overlap import overlap_volume
from tests.refusals import refused

LIBRARY = Library((ROOT,))
DESIGNS = sorted(LIBRARY.paths("designs"))
PARTS = combinations(LIBRARY)


def check_bodies(assembly):
    tolerance = assembly.scene.mesh_tolerance
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        assert body.is_closed()
        assert body.moved(assembly.print_offset).welded().is_closed()
        assert body.volume == pytest.approx(solid.volume, rel=1e-3)
        assert solid.deviation(body) <= tolerance
        assert (body.bounds[0] + assembly.print_offset).min() > 0
    for one, other in itertools.combinations(assembly.bodies, 2):
        assert overlap_volume(one, other) < 1e-9
    if seat_area(assembly.scene.seat, assembly.solid("connector")):
        assert shared_area(*assembly.bodies[:2]) == pytest.approx(
            seat_area(assembly.scene.seat, assembly.solid("connector")), rel=1e-3
        )


@pytest.mark.parametrize("name", DESIGNS)
def test_every_design_has_sound_bodies(name):
    check_bodies(assemble(load_scene(name, None, LIBRARY)))


def everyday(parts):
    """Every port with every seat and every seat with every mount; the other triples are left to the slow run."""
    port, seat, mount = (
        sorted(LIBRARY.paths(kind)).index(part) for kind, part in zip(KINDS.values(), parts, strict=True)
    )
    return mount == (port + 2 * seat) % len(LIBRARY.paths("mounts"))


@pytest.mark.parametrize(
    "parts",
    [pytest.param(parts, id=" ".join(parts), marks=() if everyday(parts) else pytest.mark.slow) for parts in PARTS],
)
def test_every_combination_of_parts_has_sound_bodies(parts):
    check_bodies(assembled(LIBRARY, parts, *SMALL))


def test_a_plug_that_does_not_pass_through_the_sleeve_is_refused():
    parts = ("barb-4x2.5", "one-piece", "finger-16")
    with pytest.raises(
        InputError, match=r'9\.25: too large for connector\.mount = "finger-16": the plug, which goes in'
    ):
        assembled(LIBRARY, parts)
    assembled(LIBRARY, parts, *SMALL)


def check_size(radius, share, parts):
    wall = max(share * radius, 0.05)
    try:
        assembly = assembled(LIBRARY, parts, f"membrane.inner_radius_mm={radius}", f"membrane.wall_thickness_mm={wall}")
    except InputError as error:
        assert "too small for" in str(error) or "too large for" in str(error)
        return
    check_bodies(assembly)


SIZES = given(st.floats(1, 70), st.floats(0.05, 0.6), st.sampled_from(PARTS))


@pytest.mark.slow
@settings(max_examples=8)
@SIZES
def test_a_size_gives_sound_bodies_or_says_what_there_is_no_room_for(radius, share, parts):
    check_size(radius, share, parts)


@pytest.mark.slow
@settings(max_examples=100)
@SIZES
def test_any_size_gives_sound_bodies_or_says_what_there_is_no_room_for(radius, share, parts):
    check_size(radius, share, parts)


def test_the_rim_is_held_up_to_the_base_plane_and_no_further():
    assembly = assemble(load_scene("paper-dome", None, LIBRARY))
    held = assembly.solids[0].meridian.tagged(HELD)
    assert max(piece.bounds()[3] for piece in held) == 0.0
    layout = assembly.layout
    groove = (layout.groove_inner, layout.groove_outer)
    assert groove == (pytest.approx(layout.inner_radius - 0.3), pytest.approx(layout.flange_radius + 0.3))


def test_fit_clearance_follows_the_print_profiles():
    ours = assemble(load_scene("fingertip-dome", None, LIBRARY)).layout
    assert ours.clearance == pytest.approx(0.2)


def test_cavity_and_internal_volume_are_exact():
    assembly = assemble(load_scene("long-tube", None, LIBRARY))
    assert assembly.layout.shape.cavity_volume == pytest.approx(2 / 3 * math.pi * 9.25**3, rel=1e-12)
    layout, port = assembly.layout, assembly.scene.port
    channel = math.pi * layout.channel_radius**2 * -layout.plate_low
    bore = math.pi * (0.5 * port.bore_diameter) ** 2 * (port.stem_length + port.barb_length)
    assert assembly.internal_volume == pytest.approx(channel + bore, rel=1e-12)


def test_a_stated_dead_volume_is_taken_as_the_total():
    assert assemble(load_scene("long-tube", {"pneumatics.dead_volume_mL": 1.5}, LIBRARY)).dead_volume == 1500.0


def test_channel_is_open_from_the_cavity_to_the_port():
    """Points along the axis lie outside the connector: winding number zero."""
    connector = assemble(load_scene("paper-dome", None, LIBRARY)).bodies[1]
    corners = connector.corners
    for z in np.linspace(connector.bounds[0][2] - 1, 0.5, 30):
        a, b, c = np.moveaxis(corners - np.array([0.0, 0.0, z]), 1, 0)
        lengths = [np.linalg.norm(side, axis=1) for side in (a, b, c)]
        triple = np.einsum("ij,ij->i", a, np.cross(b, c))
        rest = lengths[0] * lengths[1] * lengths[2] + (
            np.einsum("ij,ij->i", a, b) * lengths[2]
            + np.einsum("ij,ij->i", b, c) * lengths[0]
            + np.einsum("ij,ij->i", c, a) * lengths[1]
        )
        assert abs(np.sum(2 * np.arctan2(triple, rest)) / (4 * np.pi)) < 1e-6


def test_mounting_holes_lie_on_a_whole_millimetre_circle_and_clear_the_seat():
    for mount in sorted(LIBRARY.paths("mounts")):
        assembly = assembled(LIBRARY, ("barb-4x2.5", "glued-flange", mount))
        layout = assembly.layout
        assert 2 * layout.bolt_circle_radius == pytest.approx(round(2 * layout.bolt_circle_radius))
        for bore in assembly.solids[1].bores:
            assert math.hypot(bore.x, bore.y) == pytest.approx(layout.bolt_circle_radius)
            if not bore.closed:
                assert layout.bolt_circle_radius - bore.radius > layout.ring_radius
            else:
                assert bore.high < layout.plate_high


def test_holes_are_drawn_wider_by_what_the_printer_makes_them_smaller():
    bores = {
        profile: assemble(
            load_scene("paper-dome", {"connector.material": material, "print.connector_profile": profile}, LIBRARY)
        )
        .solid("connector")
        .bores[0]
        .radius
        for profile, material in (("abs-filament", "ABS"), ("objet260-connex", "VeroClear"))
    }
    printers = {name: LIBRARY.load("printers", name).hole_undersize_mm.nominal for name in bores}
    assert printers["abs-filament"] > printers["objet260-connex"]
    for name, radius in bores.items():
        assert 2 * radius == pytest.approx(3.4 + printers[name])


def test_a_membrane_grown_onto_its_connector_shares_three_faces_with_it():
    assembly = assembled(LIBRARY, ("barb-4x2.5", "one-piece", "plain"))
    held = sum(piece.area() for piece in assembly.solids[0].meridian.tagged(HELD))
    assert seat_area(assembly.scene.seat, assembly.solid("connector")) == pytest.approx(held, rel=1e-12)
    assert shared_area(*assembly.bodies[:2]) == pytest.approx(held, rel=1e-3)
    assert assembly.job("membrane") == assembly.job("connector") != assembly.job("plug")


def test_a_clamping_ring_rests_on_the_flange_and_closes_by_the_squeeze():
    assembly = assembled(LIBRARY, ("barb-4x2.5", "clamped-flange-M2", "plain"))
    seat, ring, layout = assembly.scene.seat, assembly.solid("ring"), assembly.layout
    assert ring.meridian.tagged("clamp face")[0].start[1] == 0.0
    skirt = min(piece.bounds()[2] for piece in ring.meridian.pieces)
    assert skirt - layout.plate_high == pytest.approx(seat.squeeze * layout.flange_thickness)
    assert len(ring.bores) == seat.screw_count
    places = [[(round(b.x, 9), round(b.y, 9)) for b in solid.bores] for solid in (ring, assembly.solid("connector"))]
    assert places[0] == places[1]


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        (
            "connector.seat=one-piece",
            ['connector.seat = "one-piece"', 'print.connector_profile = "abs-filament"', '"objet260-connex"'],
        ),
        ("pneumatics.tube=6x4", ['pneumatics.tube = "6x4"', "barb-4x2.5 takes 4x2.5"]),
        ("pneumatics.tube=5x3", ['pneumatics.tube = "5x3"', "no such name among the tubes"]),
        ("connector.port=barb-4.2x2.5", ["no such name among the ports", "Did you mean barb-4x2.5"]),
    ],
)
def test_parts_that_do_not_go_together_are_refused(setting, words):
    with pytest.raises(InputError) as error:
        assemble(load_scene("paper-dome", parse_changes([setting]), LIBRARY))
    assert all(word in str(error.value) for word in words), str(error.value)


def test_a_port_larger_than_the_body_is_refused():
    small = ["membrane.inner_radius_mm=4", "membrane.wall_thickness_mm=0.6", "connector.mount=plain"]
    with refused("membrane.inner_radius_mm", 4):
        assemble(
            load_scene(BASE, parse_changes([*small, "connector.seat=one-piece", "connector.port=thread-M5"]), LIBRARY)
        )


@pytest.mark.parametrize("radius", [1.5, 2.7, 4.0])
def test_the_radius_named_to_a_dome_too_small_has_space(radius):
    """For every port, seat and mount: where several lengths are too small the greatest decides, and holes stand on
    circles of whole millimetres."""

    def laid(inner_radius, parts):
        sizes = {"membrane.inner_radius_mm": inner_radius, "membrane.wall_thickness_mm": 0.16 * inner_radius}
        chosen = {f"connector.{kind}": part for kind, part in zip(("port", "seat", "mount"), parts, strict=True)}
        return assemble(load_scene(BASE, {**chosen, **sizes}, LIBRARY))

    small = 0
    for parts in PARTS:
        try:
            laid(radius, parts)
        except InputError as error:
            named = re.fullmatch(r"take at least ([\d.]+), or another port, mount or printer", error.remedy or "")
            if named:
                small += 1
                assert float(named[1]) > radius and laid(float(named[1]), parts)
    assert small > 3


FITTED = [parts for parts in PARTS if parts[0] in ("barb-4x2.5", "thread-M5", "push-in-6")]


@pytest.mark.parametrize("parts", FITTED, ids=" ".join)
def test_fits_go_together(parts):
    """What goes into something is smaller than it, by at least the accuracy of its printer."""
    assembly = assembled(LIBRARY, parts, *SMALL)
    scene, layout, accuracy = assembly.scene, assembly.layout, assembly.scene.connector_printer.accuracy_mm.nominal
    if scene.mount.family == "robot-flange":
        boss = assembly.solid("connector").meridian.tagged("boss")[0].start[0]
        assert 2 * boss <= scene.mount.boss_diameter - 2 * accuracy
    if scene.mount.family == "sleeve":
        finger = assembly.solid("connector").meridian.tagged("finger")[0].start[0]
        assert 2 * finger >= scene.mount.finger_diameter + 2 * accuracy
    if scene.port.family == "thread":
        assert 2 * min(r for r, _ in layout.port.hollow[:2]) >= scene.port.core_diameter + scene.hole_undersize
    if scene.port.family == "push-in":
        assert 2 * layout.port.hollow[0][0] >= scene.tube.outer_diameter + scene.hole_undersize
    if "plug" in [solid.name for solid in assembly.solids]:
        plug = max(piece.bounds()[1] for piece in assembly.solid("plug").meridian.tagged("plug"))
        assert layout.opening_radius - plug == pytest.approx(scene.fit_clearance)


@pytest.mark.parametrize("parts", [parts for parts in PARTS if parts[1].startswith("clamped")], ids=" ".join)
@pytest.mark.parametrize("wall", [0.6, 1.2, 1.8])
def test_screw_heads_of_a_ring_lie_flat_and_blind_holes_keep_a_wall(parts, wall):
    assembly = assembled(LIBRARY, parts, "membrane.inner_radius_mm=9", f"membrane.wall_thickness_mm={wall}")
    seat, layout, ring = assembly.scene.seat, assembly.layout, assembly.solid("ring").meridian
    least = assembly.scene.connector_printer.smallest.wall_rigid_mm.recommended
    (flat,) = ring.tagged("ring top")
    inner, outer = sorted((flat.start[0], flat.end[0]))
    head, hole = 0.5 * seat.head_diameter, ring_hole(assembly)
    assert layout.screw_circle - head >= inner - 1e-9
    assert layout.screw_circle + head <= outer
    assert layout.screw_circle + hole + least <= outer + 1e-9
    assert layout.groove_outer + least <= layout.screw_circle - hole + 1e-9
    bores = assembly.solid("connector").bores
    for one, other in itertools.combinations(bores, 2):
        beside = math.hypot(one.x - other.x, one.y - other.y) - one.radius - other.radius
        above = max(one.low - other.high, other.low - one.high)
        assert max(beside, above) >= least - 1e-9


def ring_hole(assembly):
    return assembly.solid("ring").bores[0].radius


@pytest.mark.parametrize("port", LIBRARY.paths("ports"))
def test_a_plug_leaves_a_side_port_as_wide_a_way_as_its_passage(port):
    """The curtain between the passage's rim and the plug, and the ring around its neck, against the passage."""
    assembly = assembled(LIBRARY, (port, "one-piece", "robot-50-4-M6"), *SMALL)
    layout, plug = assembly.layout, assembly.solid("plug").meridian
    neck = plug.tagged("neck")[-1].start[0]
    top, bottom = plug.tagged("neck")[-1].bounds()[3], plug.tagged("neck")[-1].bounds()[2]
    gap, passage = layout.opening_radius - neck, layout.port.passage
    assert bottom < layout.port_axis - passage < layout.port_axis + passage < top == 0.0
    assert 2 * math.pi * passage * gap >= math.pi * passage**2
    assert math.pi * (layout.opening_radius**2 - neck**2) >= math.pi * passage**2


@pytest.mark.parametrize("tolerance", [0.025, 0.01, 0.006])
def test_no_triangle_of_a_luer_lock_vanishes_in_a_file(tolerance):
    """Its lugs nearly meet an edge of the body at these tolerances: corners 1e-9 mm apart were left."""
    changes = {"print.profile": "form3", "membrane.material": "Elastic50A", "connector.port": "luer-female"}
    solid = next(one for one in assemble(load_scene("paper-dome", changes)).solids if one.name == "connector")
    body = solid.mesh(tolerance)
    corners = body.vertices[body.triangles]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).min() > 1e-5
    _, triangles = welded(body.vertices, body.triangles)
    assert (triangles != np.roll(triangles, 1, axis=1)).all()


@pytest.mark.parametrize("seat", ["clamped-flange-M2", "clamped-flange-M2-insert", "clamped-flange-M2-gasket"])
def test_no_edge_of_a_clamping_ring_that_touches_the_flange_is_sharp(seat):
    """Corners of the meridian at the base plane: none turns by more than a right angle."""
    pieces = assemble(load_scene("cast-dome", {"connector.seat": seat})).solid("ring").meridian.pieces
    for one, other in pairwise([pieces[-1], *pieces]):
        before, after = (np.subtract(piece.end, piece.start) / piece.length for piece in (one, other))
        if other.start[1] == 0.0:
            assert before @ after > -1e-9
    (lip,) = assemble(load_scene("cast-dome", {"connector.seat": seat})).solid("ring").meridian.tagged("lip")
    assert lip.length >= 2 * 0.15
