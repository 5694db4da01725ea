"""The mould: its void is the membrane, its parts stay apart, nothing holds the silicone back, volumes are exact."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.body import Body
from pneutouch.catalogue import DesignSource, load_scene
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.parts.connector import seat_area
from pneutouch.parts.glue import glue_volume
from pneutouch.parts.layout import lay_out
from pneutouch.parts.membrane import membrane_meridian
from pneutouch.parts.mould import MouldAssembly, mould_of, silicone_batch
from pneutouch.parts.mould.filling import filling, release_of
from pneutouch.parts.mould.pieces import core, lay_out_mould, mould_solids, ring, screw_places
from pneutouch.parts.mould.size import SCREW
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.printability.rules.bodies import shared_area
from pneutouch.shape.meridian import Arc, Line, Meridian
from pneutouch.units import ML
from tests.parts.mould.random_moulds import checked, random_moulds
from tests.parts.overlap import overlap_volume
from tests.parts.space import measured_volume

CAST = {"membrane": {"material": "DragonSkin20"}, "print": {"profile": "silicone-casting"}}


def mould(**changes) -> MouldAssembly:
    values = {key.replace("__", "."): value for key, value in changes.items()}
    return mould_of(load_scene(DesignSource("cast", CAST, "cast.toml"), values))


@st.composite
def moulds(draw, most_cavities: int = 2) -> MouldAssembly:
    radius = draw(st.floats(3, 12))
    return mould(
        membrane__inner_radius_mm=radius,
        membrane__wall_thickness_mm=draw(st.floats(0.05, 0.3)) * radius,
        indentation__depth_mm=0.3 * radius,
        mould__cavities=draw(st.integers(1, most_cavities)),
        mould__wall_mm=draw(st.floats(2, 8)),
        mould__draft_deg=draw(st.floats(0.5, 4)),
        mould__fastener=draw(st.sampled_from(["screws", "clips"])),
        mould__vent_diameter_mm=draw(st.floats(1.5, 1.75)),
        mould__sprue_diameter_mm=draw(st.floats(1.5, 1.75)),
        mould__clearance_mm=draw(st.floats(0.05, 0.3)),
        mould__shrinkage_percent=draw(st.floats(0, 3)),
    )


def test_the_membrane_of_a_mould_is_the_one_of_the_design():
    made = mould(mould__shrinkage_percent=2.0)
    designed = membrane_meridian(lay_out(made.scene))
    assert made.size.faces.meridian.volume() * 0.98**3 == pytest.approx(designed.volume(), rel=1e-12)
    shrunk = made.size.faces.rim.start[0] * 0.98, made.size.faces.high * 0.98
    assert shrunk == pytest.approx((9.25, 10.75), rel=1e-12)


def test_shrinkage_left_out_is_the_materials():
    made = mould()
    assert made.size.shape.shrinkage == 0.01 * made.scene.membrane_material.casting.shrinkage_percent.nominal > 0


@settings(max_examples=4)
@given(moulds())
def test_the_closed_mould_leaves_the_membrane_and_nothing_else(made):
    match = cavity_match(made.size, made.closed, made.tolerance)
    exact = made.size.faces.meridian.volume()
    assert match.membrane == pytest.approx(exact, rel=1e-3)
    assert match.offset < made.tolerance / 100
    assert match.missing < 1e-6 * exact
    assert overlaps(made.closed) == {}


@settings(max_examples=4)
@given(moulds(most_cavities=1))
def test_nothing_holds_the_silicone_back(made):
    assert undercuts(made.size, made.bodies, made.tolerance) == []


@settings(max_examples=4)
@given(moulds())
def test_parts_are_closed_and_their_volumes_exact(made):
    for body, solid in zip(made.bodies, made.solids, strict=True):
        assert body.is_closed()
        assert body.volume == pytest.approx(solid.volume, rel=1e-3)


def test_the_meshes_are_within_their_tolerance():
    made = mould()
    for body, solid in zip(made.bodies, made.solids, strict=True):
        assert solid.distance(body.surface_points()).max() <= made.tolerance * 1.001


def test_parts_against_formulas_of_their_own():
    made = mould(mould__cavities=2)
    size = lay_out_mould(made.membrane, replace(made.size.shape, clearance=0.0))
    cap, ring_, core_, base = mould_solids(size, made.material)
    wide, deep = 2 * size.pitch + 2 * size.margin, size.pitch + 2 * size.margin
    area = wide * deep - (4 - math.pi) * 3.0**2
    holes = len(screw_places(size)) * math.pi * (0.5 * (SCREW.clearance_diameter + size.shape.hole_undersize)) ** 2
    assert base.volume == pytest.approx((area - holes - 2 * math.pi * size.window**2) * 4.0, rel=1e-12)
    # With no clearance ring, core, membrane and the cap's pocket fill one another, but for the foot's proud rim
    # and what both roundings leave of the corner: nothing, for they are equal then.
    proud = Meridian(
        (
            Line((0.0, size.foot_low), (size.seat(size.foot_low), size.foot_low), ""),
            Line((size.seat(size.foot_low), size.foot_low), (size.seat(size.cap_low), size.cap_low), ""),
            Line((size.seat(size.cap_low), size.cap_low), (0.0, size.cap_low), ""),
        )
    ).volume()
    pocket = cap.cuts[0].net
    batch = silicone_batch(replace(made, size=size))
    handle = sum(bore.volume() for bore in core_.bores)
    filled = ring_.volume + core_.volume + handle + (batch.cavity_mL + batch.channels_mL) * ML
    assert filled == pytest.approx(pocket + proud, rel=1e-12)


def test_an_undercut_and_an_overlap_are_seen():
    made = mould()
    size, edge = made.size, made.size.faces.edge
    # A ring whose edge leans to the other side holds the flange back.
    wide, narrow = edge.start[0], edge.end[0]
    lean = replace(
        size.faces,
        underside=replace(size.faces.underside, end=(narrow, size.low)),
        edge=Line((narrow, size.low), (wide, 0.0), edge.tag),
        top=replace(size.faces.top, start=(wide, 0.0)),
    )
    wrong = ring(replace(size, faces=lean), made.material).mesh(made.tolerance)
    places = undercuts(replace(size, faces=lean), [wrong], made.tolerance)
    assert {place.part for place in places} == {"mould-ring"}
    # A core with a bulge under its dome, as a neck would need.
    (inner,) = size.faces.inner
    low = -math.atan2(0.5, inner.radius)
    bulged = Arc((0.0, 0.5), math.hypot(inner.radius, 0.5), math.pi / 2, low, inner.tag)
    body = core(replace(size, faces=replace(size.faces, inner=(bulged,))), made.material).mesh(made.tolerance)
    assert undercuts(replace(size, faces=replace(size.faces, inner=(bulged,))), [body], made.tolerance)
    moved: list[Body] = [made.bodies[0], made.bodies[1].moved(np.array([0.0, 0.0, 0.1]))]
    assert set(overlaps(moved)) == {("mould-cap", "mould-ring")}


def test_a_part_out_of_place_shows_in_the_cavity():
    made = mould()
    lifted = [body.moved(np.array([0.0, 0.0, 0.2])) if body.name == "mould-core" else body for body in made.bodies]
    match = cavity_match(made.size, lifted, made.tolerance)
    assert match.missing == pytest.approx(0.2 * math.pi * made.size.faces.edge.start[0] ** 2, rel=0.05)
    assert match.offset > 0.02


@given(st.integers(1, 16), st.sampled_from(["screws", "clips"]))
def test_every_cavity_has_its_place_and_screws_keep_clear(cavities, fastener):
    size = mould(mould__cavities=cavities, mould__fastener=fastener).size
    assert len(set(size.places)) == cavities
    assert size.columns * size.rows >= cavities > size.columns * (size.rows - 1)
    widest = size.seat(size.foot_low)
    for x, y in screw_places(size):
        nearest = min(math.hypot(x - a, y - b) for a, b in size.places)
        assert nearest - widest > 0.5 * SCREW.clearance_diameter + 1.0
    assert bool(screw_places(size)) == (fastener == "screws")


def test_the_gaps_around_a_flange_that_leans_are_exact(library):
    seats = {}
    for seat in ("glued-flange", "clamped-flange-M2"):
        seats[seat] = assemble(load_scene("cast-dome", {"connector.seat": seat, "mould.draft_deg": 8.0}, library))
    glued, clamped = seats.values()
    layout, membrane = glued.layout, glued.solids[0]
    assert layout.flange_draft == pytest.approx(layout.flange_thickness * math.tan(math.radians(8)))
    dome = 2 / 3 * math.pi * (layout.outer_radius**3 - layout.inner_radius**3)
    groove = math.pi * (layout.groove_outer**2 - layout.groove_inner**2) * layout.flange_thickness
    assert glue_volume(glued.scene, layout) == pytest.approx(groove - (membrane.volume - dome), rel=1e-9)
    assert measured_volume(clamped) == pytest.approx(clamped.internal_volume, rel=2e-3)


@pytest.mark.parametrize("draft_deg", [0.5, 2.0, 8.0])
def test_a_flange_that_leans_rests_on_the_floor_of_its_groove(draft_deg, library):
    glued = assemble(load_scene("cast-dome", {"connector.seat": "glued-flange", "mould.draft_deg": draft_deg}, library))
    layout = glued.layout
    rim = layout.inner_radius + layout.flange_draft
    assert seat_area(glued.scene.seat, glued.solid("connector")) == pytest.approx(
        math.pi * (layout.flange_radius**2 - rim**2), rel=1e-12
    )
    assert shared_area(*glued.bodies) == pytest.approx(seat_area(glued.scene.seat, glued.solid("connector")), rel=1e-3)
    assert overlap_volume(*glued.bodies) < 1e-6


def test_a_printed_design_has_no_mould_and_keeps_its_form(library):
    scene = load_scene("paper-dome", None, library)
    assert "mould" not in scene.design.model_dump()
    assert lay_out(scene).flange_draft == 0.0
    with pytest.raises(TypeError, match="printed"):
        mould_of(scene)


@pytest.mark.parametrize(
    ("change", "key", "words"),
    [
        ({"mould__sprue_diameter_mm": 8.0}, "mould.sprue_diameter_mm", "wider than the flange"),
        ({"mould__vent_diameter_mm": 8.0}, "mould.vent_diameter_mm", "wider than the flange"),
        ({"mould__vent_diameter_mm": 0.5, "mould__draft_deg": 5.0}, "mould.vent_diameter_mm", "draft closes it"),
        ({"mould__clearance_mm": 1.0, "membrane__wall_thickness_mm": 0.5}, "mould.clearance_mm", "rounding"),
        ({"mould__profile": "silicone-casting"}, "mould.profile", "printed, not cast"),
        ({"mould__profile": "objet260-connex"}, "mould.profile", "cannot run"),
        ({"mould__material": "TangoPlus"}, "mould.material", "elastomer"),
        ({"mould__cavities": 17}, "mould.cavities", "from 1 to 16"),
        ({"mould__fastener": "glue"}, "mould.fastener", "screws"),
    ],
)
def test_what_makes_no_mould_is_refused_by_its_key(change, key, words):
    with pytest.raises(InputError) as caught:
        mould(**change)
    assert key in caught.value.message() and words in caught.value.message()
    assert "cast.toml" in caught.value.message()


def test_the_batch_adds_up_and_divides_by_mass():
    one, nine = silicone_batch(mould()), silicone_batch(mould(mould__cavities=9))
    assert one.filled_mL == pytest.approx(one.cavity_mL + one.channels_mL + one.overflow_mL)
    assert nine.filled_mL == pytest.approx(9 * one.filled_mL)
    assert one.volume_mL - one.filled_mL == 2.0
    assert nine.loss_mL == pytest.approx(0.15 * nine.filled_mL)
    assert sum(nine.parts_g) == pytest.approx(nine.mass_g) and nine.parts_g[0] == nine.parts_g[1]
    assert nine.mass_g == pytest.approx(nine.volume_mL * 1.08)


@settings(max_examples=8)
@given(moulds(most_cavities=1))
def test_the_membrane_passes_its_core(made):
    release = release_of(made.membrane, made.size)
    radius = made.scene.design.membrane.inner_radius_mm
    assert release.opening_mm == pytest.approx(2 * radius, rel=1e-9)
    # Shrinkage and draft alone make it stretch: there is no neck.
    draft = made.membrane.pieces[1].end[0] / radius
    assert 1 + release.passing_strain == pytest.approx(draft * made.size.shape.factor, rel=1e-9)
    assert release.strain >= 0.5


def test_filling_goes_as_the_viscosity_and_the_pour_channel():
    size = mould().size
    thin, thick = filling(size, 3.0, 1.08), filling(size, 30.0, 1.08)
    assert thick.pour_s == pytest.approx(10 * thin.pour_s)
    assert thick.bubble_s == pytest.approx(10 * thin.bubble_s)
    assert filling(mould(mould__sprue_diameter_mm=1.5).size, 3.0, 1.08).pour_s > 1.8 * thin.pour_s
    # A pipe of constant radius: Hagen and Poiseuille, within the taper.
    assert thin.syringe_s < thin.pour_s / 100


@pytest.mark.slow
def test_fifty_random_moulds_are_sound():
    assert [check.design for check in map(checked, random_moulds()) if not check.sound] == []
