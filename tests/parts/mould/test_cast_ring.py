"""A flange cast around a perforated ring: exact bodies, the mould that holds the ring, and what is refused."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pneutouch.catalogue import DesignSource, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.subject import subject_of, wetted
from pneutouch.export.step import exact_solid
from pneutouch.parts import Assembly, assemble
from pneutouch.parts.connector import seat_area
from pneutouch.parts.membrane import membrane_meridian
from pneutouch.parts.mould.pieces import silicone
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.printability.rules.bodies import shared_area
from pneutouch.printability.rules.feature_sizes import CHECKS
from pneutouch.printability.subject import PrintSubject
from pneutouch.printability.view import PrintView
from pneutouch.report.mould import mould_rows, mould_section
from pneutouch.workflows.build import exploded
from tests.parts.mould.random_moulds import checked, random_moulds
from tests.parts.overlap import overlap_volume

CAST = {
    "membrane": {"material": "DragonSkin20"},
    "connector": {"seat": "cast-ring", "mount": "plain"},
    "print": {"profile": "silicone-casting"},
}


def made(**changes) -> Assembly:
    values = {key.replace("__", "."): value for key, value in changes.items()}
    return assemble(load_scene(DesignSource("ring", CAST, "ring.toml"), values))


@st.composite
def rings(draw) -> Assembly:
    radius, hole = draw(st.floats(4, 15)), draw(st.floats(0.8, 3))
    try:
        return made(
            membrane__inner_radius_mm=radius,
            membrane__wall_thickness_mm=draw(st.floats(0.05, 0.3)) * radius,
            indentation__depth_mm=0.3 * radius,
            cast_ring__hole_diameter_mm=hole,
            cast_ring__hole_count=draw(st.none() | st.integers(3, 14)),
            cast_ring__thickness_mm=draw(st.floats(0.6, 3)),
            cast_ring__width_mm=hole + draw(st.floats(1.3, 3)),
            mould__cavities=draw(st.integers(1, 2)),
            mould__draft_deg=draw(st.floats(0.5, 4)),
            mould__fastener=draw(st.sampled_from(["screws", "clips"])),
            mould__clearance_mm=draw(st.floats(0.05, 0.3)),
            mould__shrinkage_percent=draw(st.floats(0, 3)),
        )
    except InputError:
        assume(False)
        raise


@settings(max_examples=6)
@given(rings())
def test_membrane_ring_and_connector_fill_one_another_exactly(assembly):
    ring, layout = assembly.layout.ring, assembly.layout
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        assert body.is_closed()
        assert body.volume == pytest.approx(solid.volume, rel=1e-3)
    for one, other in itertools.combinations(assembly.bodies, 2):
        assert overlap_volume(one, other) < 1e-9
    membrane, connector, body = assembly.bodies
    assert shared_area(membrane, connector) == pytest.approx(
        seat_area(assembly.scene.seat, assembly.solid("connector")), rel=1e-3
    )
    foot = math.pi * (ring.collar_radius**2 - ring.flange_radius**2)
    assert shared_area(body, connector) == pytest.approx(foot, rel=1e-3)
    # What the silicone has less than its outline is the web without its holes; the ring has the collar in addition.
    web = math.pi * (ring.flange_radius**2 - ring.web_inner**2) * (ring.web_high - ring.web_low)
    web -= ring.hole_count * math.pi * ring.hole_radius**2 * (ring.web_high - ring.web_low)
    whole = membrane_meridian(layout).volume()
    assert assembly.solid("membrane").volume == pytest.approx(whole - web, rel=1e-12)
    assert assembly.solid("ring").volume == pytest.approx(web + foot * layout.flange_thickness, rel=1e-12)
    assert min(-ring.web_high, ring.web_low - layout.plate_high, ring.web_inner - layout.outer_radius) > 1.49


@pytest.mark.slow
@settings(max_examples=6)
@given(rings())
def test_the_closed_mould_and_the_ring_leave_the_silicone_and_nothing_else(assembly):
    mould = assembly.mould
    match, exact = cavity_match(mould.size, mould.closed, mould.tolerance), mould.size.cavity_volume
    assert match.void == pytest.approx(exact, rel=1e-3)
    assert match.membrane == pytest.approx(exact, rel=1e-3)
    assert match.offset < mould.tolerance / 100
    assert match.missing < 1e-6 * exact
    assert overlaps(mould.closed) == {}
    assert undercuts(mould.size, mould.bodies, mould.tolerance) == []
    for body, solid in zip(mould.bodies, mould.solids, strict=True):
        assert body.is_closed()
        assert body.volume == pytest.approx(solid.volume, rel=1e-3)


@settings(max_examples=3)
@given(rings())
def test_the_piece_leaves_the_mould_with_its_ring(assembly):
    mould, slack = assembly.mould, 1e-4 * assembly.mould.size.cavity_volume
    cap, mould_ring, core, _ = mould.bodies
    piece = [silicone(mould.size, mould.material).mesh(mould.tolerance), mould.insert.mesh(mould.tolerance)]
    for lift in (0.5, 2.0, 8.0):
        up = np.array([0.0, 0.0, lift])
        assert all(overlap_volume(body.moved(up), core) < slack for body in piece)
        assert all(overlap_volume(body.moved(-up), cap) < slack for body in piece)
        assert overlap_volume(piece[1].moved(-up), mould_ring) == 0.0


def test_the_ring_keeps_its_size_and_what_it_holds_while_the_dome_shrinks():
    assembly = made(mould__shrinkage_percent=2.0)
    size, layout = assembly.mould.size, assembly.layout
    assert size.insert == layout.ring and assembly.mould.insert == assembly.solid("ring")
    assert size.faces.rim.start[0] * 0.98 == pytest.approx(layout.inner_radius, rel=1e-12)
    assert size.faces.high * 0.98 == pytest.approx(layout.outer_radius, rel=1e-12)
    assert (size.low, size.faces.edge.start[0]) == (layout.plate_high, layout.flange_radius)
    unshrunk = made(mould__shrinkage_percent=0.0)
    assert unshrunk.mould.size.cavity_volume == pytest.approx(unshrunk.solids[0].volume, rel=1e-12)


def test_a_ring_out_of_place_or_too_high_shows_in_the_closed_mould():
    mould = made().mould
    raised = [body.moved(np.array([0.0, 0.0, 0.3])) if body.name == "ring" else body for body in mould.closed]
    assert ("mould-cap", "ring") in overlaps(raised)
    match = cavity_match(mould.size, raised, mould.tolerance)
    assert match.missing > 10 and match.extra > 10
    high = replace(mould.size.insert, low=mould.size.insert.low - 0.1).solid(mould.material).mesh(mould.tolerance)
    assert set(overlaps([*mould.bodies, high])) == {("mould-core", "ring")}


def test_left_out_the_holes_are_as_far_apart_as_they_are_wide():
    for radius in (4.0, 9.25, 30.0):
        ring = made(membrane__inner_radius_mm=radius, indentation__depth_mm=1.0).layout.ring
        assert 2 * ring.hole_radius <= ring.bridge * 1.03 < 2 * (2 * ring.hole_radius)
        assert ring.rim == pytest.approx(1.6)


def test_every_cavity_has_a_ring_and_the_drawings_show_it():
    mould = made(mould__cavities=3).mould
    assert [body.name for body in mould.closed if body.name.startswith("ring")] == ["ring", "ring-2", "ring-3"]
    assert "ring" not in mould.counts and len(exploded(mould)) == 11
    assert "3, one in each cavity" in dict(mould_rows(mould))["Cast around"]
    assert f"{mould.insert.bores and len(mould.insert.bores)} holes" in mould_section(mould)


def test_exact_volumes_are_those_of_the_cad_kernel():
    for solid in made().solids[::2]:
        other = cq.Shape.cast(exact_solid(solid))
        assert other.isValid()
        assert other.Volume() == pytest.approx(solid.volume, rel=1e-9)


def test_the_prediction_is_that_of_the_dome_held_at_its_base():
    ring, clamped = (
        made(connector__seat=seat, pneumatics__dead_volume_mL=0.0) for seat in ("cast-ring", "glued-flange")
    )
    assert sensor_of(ring) == sensor_of(clamped)


def test_narrow_bridges_are_reported_and_the_slot_of_the_web_is_not():
    assembly = made(cast_ring__hole_count=26, cast_ring__thickness_mm=1.0)
    subject = subject_of(assembly)
    (walls, *_) = [each for each in CHECKS["walls"](PrintView(subject)) if each.body == "ring"]
    assert walls.severity == "warning" and "cast_ring." in walls.fix

    def openings(items):
        view = PrintView(PrintSubject(tuple(items)))
        return [each for name in ("holes", "channels", "emboss") for each in CHECKS[name](view)]

    membrane = subject.items[0]
    assert openings([membrane]) == []
    assert openings([replace(membrane, insert=None)])


def test_the_silicone_cures_against_the_ring():
    assembly = made(connector__material="VeroClear", print__connector_profile="objet260-connex")
    assert wetted(assembly)[-1] == ("ring", assembly.scene.connector_material.label, "polyjet")


PRINTED = {"print__profile": "objet260-connex", "membrane__material": "TangoPlus"}


@pytest.mark.parametrize(
    ("change", "key", "words"),
    [
        (PRINTED, 'connector.seat = "cast-ring"', "prints the membrane"),
        ({"connector__seat": "glued-flange", "cast_ring__hole_count": 8}, "cast_ring", "has no ring"),
        ({"cast_ring__hole_count": 80}, "cast_ring.hole_count = 80", "give at most"),
        ({"cast_ring__hole_count": 2}, "cast_ring.hole_count", "from 3 to 400"),
        ({"cast_ring__width_mm": 2.0}, "cast_ring.width_mm = 2", "give at least 3.2"),
        (
            {"membrane__inner_radius_mm": 60.0, "mould__shrinkage_percent": 8.0},
            "mould.shrinkage_percent",
            "inside the ring",
        ),
    ],
)
def test_what_makes_no_ring_is_refused_by_its_key(change, key, words):
    with pytest.raises(InputError) as caught:
        assert made(**change).mould
    assert key in caught.value.message() and words in caught.value.message()
    assert "ring.toml" in caught.value.message()


def test_the_remedy_for_too_many_holes_is_the_most_that_fit():
    with pytest.raises(InputError) as caught:
        made(cast_ring__hole_count=80)
    most = int(caught.value.message().partition("give at most ")[2].partition(",")[0])
    made(cast_ring__hole_count=most)
    with pytest.raises(InputError):
        made(cast_ring__hole_count=most + 1)


@pytest.mark.slow
def test_fifty_random_moulds_with_a_ring_are_sound():
    assert [check.design for check in map(checked, random_moulds(seat="cast-ring")) if not check.sound] == []
