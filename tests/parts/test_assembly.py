"""Bodies of every design and of random ones: closed, apart, meeting on the seat, clamped where the mechanics clamps."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.parts.connector import SEAT
from pneutouch.parts.membrane import HELD
from pneutouch.printability.rules.contact_faces import overlap_volume, shared_area
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
DESIGNS = sorted(LIBRARY.shelf("designs"))
PARTS = list(itertools.product(*(sorted(LIBRARY.shelf(kind)) for kind in ("ports", "seats", "mounts"))))


def check_bodies(assembly):
    membrane, connector = assembly.bodies
    tolerance = assembly.scene.mesh_tolerance
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        assert body.is_closed()
        assert body.moved(assembly.print_offset).welded().is_closed()
        assert body.volume == pytest.approx(solid.volume, rel=1e-3)
        assert assembly.deviation(body) <= tolerance
        assert (body.bounds[0] + assembly.print_offset).min() > 0
    assert overlap_volume(membrane, connector) == 0.0
    seat = sum(piece.area() for piece in assembly.solids[1].meridian.tagged(SEAT))
    assert shared_area(membrane, connector) == pytest.approx(seat, rel=1e-3)


@pytest.mark.parametrize("name", DESIGNS)
def test_every_design_has_sound_bodies(name):
    check_bodies(assemble(load_scene(name, [], LIBRARY)))


@pytest.mark.parametrize(("port", "seat", "mount"), PARTS)
def test_every_combination_of_parts_has_sound_bodies(port, seat, mount):
    chosen = [f"connector.port={port}", f"connector.seat={seat}", f"connector.mount={mount}"]
    check_bodies(assemble(load_scene("paper-dome", chosen, LIBRARY)))


@settings(max_examples=25)
@given(st.floats(1, 70), st.floats(0.05, 0.6), st.sampled_from([part[2] for part in PARTS]))
def test_any_size_gives_sound_bodies_or_says_that_it_is_too_small(radius, share, mount):
    wall = max(share * radius, 0.05)
    sizes = [f"membrane.inner_radius_mm={radius}", f"membrane.wall_thickness_mm={wall}", f"connector.mount={mount}"]
    scene = load_scene("paper-dome", sizes, LIBRARY)
    try:
        assembly = assemble(scene)
    except InputError as error:
        assert "too small" in str(error)
        return
    check_bodies(assembly)


def test_the_rim_is_held_up_to_the_base_plane_and_no_further():
    assembly = assemble(load_scene("paper-dome", [], LIBRARY))
    held = assembly.solids[0].meridian.tagged(HELD)
    assert max(piece.bounds()[3] for piece in held) == 0.0
    layout = assembly.layout
    groove = (layout.groove_inner, layout.groove_outer)
    assert groove == (pytest.approx(layout.inner_radius - 0.3), pytest.approx(layout.flange_radius + 0.3))


def test_fit_clearance_follows_the_print_profiles():
    ours = assemble(load_scene("fingertip-dome", [], LIBRARY)).layout
    assert ours.clearance == pytest.approx(0.2)


def test_cavity_and_dead_volume_are_exact():
    assembly = assemble(load_scene("long-tube", [], LIBRARY))
    assert assembly.cavity_volume == pytest.approx(2 / 3 * math.pi * 9.25**3, rel=1e-12)
    layout, port = assembly.layout, assembly.scene.port
    channel = math.pi * layout.channel_radius**2 * -layout.plate_low
    bore = math.pi * (0.5 * port.bore_diameter) ** 2 * (port.stem_length + port.barb_length)
    assert assembly.channel_volume == pytest.approx(channel + bore, rel=1e-12)
    assert assembly.tube_volume == pytest.approx(math.pi / 4 * 2.5**2 * 1000, rel=1e-12)
    assert assembly.dead_volume == pytest.approx(assembly.channel_volume + assembly.tube_volume)


def test_a_stated_dead_volume_is_taken_as_the_total():
    assert assemble(load_scene("long-tube", ["pneumatics.dead_volume_mL=1.5"], LIBRARY)).dead_volume == 1500.0


def test_channel_is_open_from_the_cavity_to_the_port():
    """Points along the axis lie outside the connector: winding number zero."""
    connector = assemble(load_scene("paper-dome", [], LIBRARY)).bodies[1]
    corners = connector.corners
    for z in np.linspace(connector.bounds[0][2] - 1, 0.5, 30):
        a, b, c = np.moveaxis(corners - np.array([0.0, 0.0, z]), 1, 0)
        lengths = [np.linalg.norm(side, axis=1) for side in (a, b, c)]
        triple = np.einsum("ij,ij->i", a, np.cross(b, c))
        rest = lengths[0] * lengths[1] * lengths[2] + (
            np.einsum("ij,ij->i", a, b) * lengths[2] + np.einsum("ij,ij->i", b, c) * lengths[0]
            + np.einsum("ij,ij->i", c, a) * lengths[1]
        )  # fmt: skip
        assert abs(np.sum(2 * np.arctan2(triple, rest)) / (4 * np.pi)) < 1e-6


def test_mounting_holes_lie_on_a_whole_millimetre_circle_and_clear_the_seat():
    for mount in sorted(LIBRARY.shelf("mounts")):
        assembly = assemble(load_scene("paper-dome", [f"connector.mount={mount}"], LIBRARY))
        layout = assembly.layout
        assert 2 * layout.bolt_circle_radius == pytest.approx(round(2 * layout.bolt_circle_radius))
        for bore in assembly.solids[1].bores:
            assert math.hypot(bore.x, bore.y) == pytest.approx(layout.bolt_circle_radius)
            if not bore.blind:
                assert layout.bolt_circle_radius - bore.radius > layout.ring_radius
            else:
                assert bore.high < layout.plate_high
