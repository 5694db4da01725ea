"""Coupons: exact volumes, the standards' dimensions, the membrane's flange, a known cavity."""

from __future__ import annotations

import itertools
import math

import cadquery as cq
import numpy as np
import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.export.step import exact_solid
from pneutouch.parts.coupons import COUPONS, CouponContext, dumbbell, gauge
from pneutouch.parts.coupons.leak_cap import cap
from pneutouch.parts.coupons.volume_plug import cavity_size, cavity_volume
from pneutouch.parts.layout import lay_out
from pneutouch.parts.membrane import membrane_meridian
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.shape.meridian import Arc
from pneutouch.spec.read import parse_changes
from tests.catalogue.store import CAST
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
SEATS = sorted(LIBRARY.paths("seats"))
TOLERANCE = 0.016


def context(material="TangoPlus", seat="glued-flange", *more):
    chosen = [f"connector.seat={seat}", *CAST.get(seat, ()), *more]
    if seat == "one-piece":
        chosen += ["connector.material=VeroClear", "print.connector_profile=objet260-connex"]
    return CouponContext(LIBRARY.load("materials", material), load_scene("paper-dome", parse_changes(chosen), LIBRARY))


def drawn():
    for name, coupon in COUPONS.items():
        for seat in SEATS if coupon.belongs == "design" else SEATS[:1]:
            for solid in coupon.draw(context(seat=seat)):
                yield pytest.param(solid, id=f"{solid.name}-{seat}" if coupon.belongs == "design" else name)


@pytest.mark.parametrize("solid", list(drawn()))
def test_every_coupon_is_exact_and_closed(solid):
    body = solid.mesh(TOLERANCE)
    assert body.is_closed()
    assert body.welded().is_closed()
    assert body.volume == pytest.approx(solid.volume, rel=1e-3)
    # The finest pins have so few vertices that the leading term by which they are counted is a little short.
    assert solid.distance(body.surface_points()).max() <= 1.02 * TOLERANCE
    assert cq.Shape.cast(exact_solid(solid)).Volume() == pytest.approx(solid.volume, rel=1e-9)
    assert solid.role == "coupon"


def test_every_family_says_what_is_measured_and_how():
    for name, coupon in COUPONS.items():
        assert coupon.name == name
        nominals = coupon.nominals(context())
        assert nominals and coupon.steps and coupon.formulas
        assert all(nominal.instrument and nominal.unit for nominal in nominals)
        assert len({(nominal.feature, nominal.value) for nominal in nominals}) == len(nominals)


def test_the_puck_is_the_papers():
    (solid,) = COUPONS["puck"].draw(context())
    assert solid.volume == pytest.approx(math.pi * 10**2 * 3, rel=1e-12)
    assert [n.value for n in COUPONS["puck"].nominals(context())] == [27.6, pytest.approx(solid.mass), 20, 3]
    assert COUPONS["puck"].copies * COUPONS["puck"].nominals(context())[0].readings == 20
    assert COUPONS["puck"].nominals(context("VeroClear"))[0].unit == "Shore D"


def test_the_dumbbell_is_die_c_and_smooth():
    pieces = dumbbell.outline()
    for one, other in itertools.pairwise([*pieces, pieces[0]]):
        assert math.dist(one.end, other.start) < 1e-12
    points = np.array([piece.start for piece in pieces])
    assert np.ptp(points, axis=0) == pytest.approx([115, 25])
    narrow = [piece for piece in pieces if piece.tag == "narrow"]
    assert [piece.length for piece in narrow] == [pytest.approx(33)] * 2
    assert [abs(piece.start[1]) for piece in narrow] == [pytest.approx(3)] * 2
    radii = [piece.radius for piece in pieces if isinstance(piece, Arc)]
    assert sorted(radii) == [14] * 4 + [25] * 4
    for one, other in itertools.pairwise([*pieces, pieces[0]]):
        if isinstance(one, Arc) or isinstance(other, Arc):
            assert direction(one, 1) @ direction(other, 0) == pytest.approx(1, abs=1e-12)


def direction(piece, end):
    """Unit tangent of a piece at its start (0) or end (1)."""
    if not isinstance(piece, Arc):
        along = np.subtract(piece.end, piece.start)
        return along / np.linalg.norm(along)
    angle, sense = (piece.first, piece.last)[end], math.copysign(1, piece.last - piece.first)
    return sense * np.array([-math.sin(angle), math.cos(angle)])


def test_gauge_features_stand_apart_on_the_plate():
    rows = gauge.rows()
    assert [row.feature for row in rows] == ["wall", "pin", "hole", "slot"]
    for row in rows:
        assert list(row.sizes) == sorted(row.sizes)
        ends = [(x - size / 2, x + size / 2) for x, size in row.places()]
        assert all(after[0] - before[1] == pytest.approx(4) for before, after in itertools.pairwise(ends))
    plate, block = COUPONS["gauge"].draw(context())
    assert plate.mesh(TOLERANCE).bounds[1] == pytest.approx([52.3, 46, 8])
    assert block.mesh(TOLERANCE).bounds.tolist() == [[0, 0, 0], [20, 20, 20]]
    assert block.volume == pytest.approx(20 * (20 * 5 + 15 * 5 + 10 * 5 + 5 * 5))


@pytest.mark.parametrize("seat", SEATS)
def test_the_cap_has_the_flange_of_the_membrane_and_no_cavity(seat):
    where = context(seat=seat)
    layout = lay_out(where.scene)
    fit = where.scene.fit_clearance - layout.clearance
    ours, theirs = cap(where, [], 0.0), membrane_meridian(layout)
    held, membrane = (np.array([piece.start for piece in one.tagged("held")]) for one in (ours, theirs))
    if layout.ring is not None:
        # It stands in for membrane and ring: as wide as the collar, and printed, without the draft of a mould.
        membrane[1:, 0] = layout.inner_radius, layout.held_radius
    inwards = np.where(membrane[:, 0] < layout.outer_radius, fit, -fit)
    assert held == pytest.approx(membrane + np.column_stack([inwards, np.zeros(3)]))
    assert fit == (pytest.approx(0.2) if seat == "one-piece" else 0.0)
    assert [piece.end[1] for piece in ours.tagged("base plane")] == [0.0]
    assert sum(piece.swept() for piece in ours.tagged("base plane")) == 0.0
    if "clamped" in seat:
        assert max(piece.end[0] for piece in ours.tagged("flange top")) == pytest.approx(layout.outer_radius)


@pytest.mark.parametrize("seat", SEATS)
def test_the_plug_adds_one_millilitre(seat):
    where = context(seat=seat)
    (plain,), (plug,) = COUPONS["leak-cap"].draw(where), COUPONS["volume-plug"].draw(where)
    radius, height = cavity_size(where)
    assert math.pi * radius**2 * height == pytest.approx(1000, rel=1e-12)
    assert abs(sum(piece.swept() for piece in plug.meridian.tagged("cavity"))) == pytest.approx(1000, rel=1e-12)
    rim = plug.meridian.tagged("side")[0].start[0]
    assert plug.volume == pytest.approx(plain.volume + math.pi * rim**2 * height - 1000, rel=1e-12)
    assert radius < lay_out(where.scene).inner_radius


def test_cavities_are_round_numbers_below_the_dome():
    for radius in np.geomspace(1, 100, 40):
        volume, dome = cavity_volume(Hemisphere(radius, 0.1)), 2 / 3 * math.pi * radius**3
        assert dome / 2.5 <= volume <= dome
        assert f"{volume:.0e}"[0] in "125"


def test_a_dome_too_small_for_a_plug_is_named():
    small = ["membrane.inner_radius_mm=3", "membrane.wall_thickness_mm=0.05", "connector.mount=plain"]
    where = context("TangoPlus", "clamped-flange-M2", *small)
    assert COUPONS["leak-cap"].draw(where)
    with pytest.raises(InputError, match=r"inner_radius_mm = 3: too small for a volume plug"):
        COUPONS["volume-plug"].draw(where)
