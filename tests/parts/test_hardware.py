"""Bought parts of a connector: gasket, heat-set inserts, O-ring and hose clamp, drawn, checked and named on the sheet."""

from __future__ import annotations

import io
import itertools
import math
import re
from dataclasses import replace

import ezdxf
import pytest
from ezdxf.units import MM

from pneutouch.body import Solid
from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.export import templates
from pneutouch.parts import assemble
from pneutouch.parts.connector import gasket_radii, travel
from pneutouch.printability.rules import working
from pneutouch.printability.view import PrintView
from pneutouch.report.pages import TEMPLATES, filled
from pneutouch.report.print_sheet import making
from pneutouch.spec.part import ORingStub
from pneutouch.workflows.build import build
from tests.conftest import ROOT
from tests.parts.space import measured_volume
from tests.printability.working import dome

LIBRARY = Library((ROOT,))
INSERTED = {
    "connector.seat": "clamped-flange-M2-insert",
    "connector.mount": "rear-4xM3-insert",
    "connector.material": "ABS",
    "print.connector_profile": "abs-filament",
}


def assembly(changes, name="paper-dome"):
    return assemble(load_scene(name, changes, LIBRARY))


def hardware(changes, name="paper-dome"):
    scene = load_scene(name, changes, LIBRARY)
    return templates(TEMPLATES, autoescape=False).get_template("hardware.j2").make_module({"scene": scene})


# Gasket


@pytest.mark.parametrize("name", ["paper-dome", "cast-dome"])
def test_a_gasket_lowers_the_plate_and_leaves_the_membrane_as_it_is(name):
    plain, sealed = (assembly({"connector.seat": f"clamped-flange-M2{end}"}, name) for end in ("", "-gasket"))
    thickness = sealed.scene.seat.gasket_thickness
    assert sealed.solids[0] == plain.solids[0]
    assert sealed.layout.plate_high == pytest.approx(plain.layout.plate_high - thickness)
    assert sealed.layout.plate_high - sealed.layout.plate_low == plain.layout.plate_high - plain.layout.plate_low
    one, other = (sensor_of(each).replace(dead_volume=1.0) for each in (plain, sealed))
    assert one == other


def test_the_ring_comes_down_by_the_squeeze_of_flange_and_gasket():
    made = assembly({"connector.seat": "clamped-flange-M2-gasket"})
    seat, layout, ring = made.scene.seat, made.layout, made.solid("ring").meridian
    skirt = min(piece.bounds()[2] for piece in ring.pieces)
    squeezed = seat.squeeze * layout.flange_thickness + seat.gasket_squeeze * seat.gasket_thickness
    assert skirt - layout.plate_high == pytest.approx(squeezed) == pytest.approx(travel(seat, layout))
    # Solid rubber: at least what seals, at most what it stands (elastoproxy.com).
    assert 0.1 <= seat.gasket_squeeze <= 0.5


@pytest.mark.parametrize("name", ["stiff-dome", "cast-dome"])
def test_the_gas_beside_a_gasket_is_counted(name):
    made = assembly({"connector.seat": "clamped-flange-M2-gasket", "pneumatics.dead_volume_mL": None}, name)
    assert made.internal_volume == pytest.approx(measured_volume(made), rel=2e-3)


def test_the_outline_for_the_laser_is_that_of_the_flange():
    made = assembly({"connector.seat": "clamped-flange-M2-gasket", "membrane.inner_radius_mm": 12})
    inner, outer = gasket_radii(made.layout)
    assert made.layout.groove_inner < inner < outer < made.layout.groove_outer
    drawing = ezdxf.read(io.StringIO(filled("gasket.dxf.j2", radii=(inner, outer))))
    assert not drawing.audit().errors and drawing.units == MM
    circles = [(edge.dxftype(), tuple(edge.dxf.center), edge.dxf.radius) for edge in drawing.modelspace()]
    assert circles == [("CIRCLE", (0, 0, 0), pytest.approx(radius, abs=1e-4)) for radius in (inner, outer)]


@pytest.mark.slow
def test_a_build_writes_the_outline_and_names_it(tmp_path):
    changes = {"connector.seat": "clamped-flange-M2-gasket"}
    folder = build(evaluate("paper-dome", changes, model="membrane", library=LIBRARY), tmp_path)
    name = "paper-dome-gasket.dxf"
    assert ezdxf.readfile(folder / name).audit().has_errors is False
    assert name in (folder / "manifest.json").read_text()
    assert (folder / "print-sheet.md").read_text().count(name) == 2


# Inserts


def inserts():
    """Every part with inserts, as changes of a design, and the part."""
    for kind in ("seats", "mounts"):
        for name, part in sorted(LIBRARY.all(kind, object).items()):
            if getattr(part, "insert", None) is not None:
                yield {**INSERTED, f"connector.{kind[:-1]}": name}, kind[:-1]


def test_there_are_inserts_of_three_sizes():
    screws = {getattr(load_scene("paper-dome", changes, LIBRARY), kind).screw for changes, kind in inserts()}
    assert screws == {"M2", "M2.5", "M3"}


@pytest.mark.parametrize("wall", [0.8, 1.5, 3.0])
@pytest.mark.parametrize(("changes", "kind"), list(inserts()))
def test_an_insert_has_the_plastic_around_it_that_its_maker_asks_for(changes, kind, wall):
    made = assembly({**changes, "membrane.wall_thickness_mm": wall})
    part, layout, connector = getattr(made.scene, kind), made.layout, made.solid("connector")
    diameter = part.core_diameter if kind == "seat" else part.hole_diameter
    holes = [bore for bore in connector.bores if 2 * bore.radius == pytest.approx(diameter + made.scene.hole_undersize)]
    assert holes
    for bore in holes:
        reach = math.hypot(bore.x, bore.y)
        assert layout.plate_radius - reach - 0.5 * diameter >= 1.6
        assert min(bore.low - layout.plate_low, layout.plate_high - bore.high) == pytest.approx(0.0, abs=1e-9)
        assert max(bore.low - layout.plate_low, layout.plate_high - bore.high) >= 1.6 - 1e-9
    for one, other in itertools.combinations(connector.bores, 2):
        beside = math.hypot(one.x - other.x, one.y - other.y) - one.radius - other.radius
        above = max(one.low - other.high, other.low - one.high)
        assert max(beside, above) >= 1.6 - 1e-9


@pytest.mark.parametrize(
    ("material", "profile", "rigid"),
    [("ABS", "abs-filament", True), ("VeroClear", "objet260-connex", False), ("ClearResin", "form3", False)],
)
def test_inserts_are_refused_where_nothing_melts(material, profile, rigid):
    changes = {**INSERTED, "connector.material": material, "print.connector_profile": profile}
    found = [(one.severity, one.body) for one in found_by(working.check_inserts, changes)]
    assert found == ([] if rigid else [("error", "connector")] * 2)
    tapped = {**changes, "connector.seat": "clamped-flange-M2", "connector.mount": "plain"}
    assert not found_by(working.check_inserts, tapped)


def found_by(rule, changes, **parts):
    subject, context = dome([0])
    scene = replace(load_scene("paper-dome", changes, LIBRARY), **parts)
    return rule(PrintView(subject, replace(context, scene=scene)))


def test_holes_of_inserts_are_not_tapped_and_inserts_are_told_before_the_screws():
    lines, made = making(assembly(INSERTED)), hardware(INSERTED)
    first = [line.partition(":")[0].partition(" ")[0] for line in lines]
    assert first.index("Drilling") < first.index("Inserts") < first.index("Joining") < first.index("Mount")
    assert made.taps == [] and {3.2, 4.0} <= set(made.drills)
    tapped = hardware({"connector.seat": "clamped-flange-M2"})
    assert tapped.taps == ["M2"] and not tapped.seat_insert


# O-ring


def test_the_gland_is_that_of_its_maker():
    """1.27 to 1.40 mm deep, 18 to 32 % of squeeze for a section of 1.78 mm, static, radial (Apple Rubber)."""
    port = load_scene("paper-dome", {"connector.port": "o-ring-9"}, LIBRARY).port
    made = working.gland(port, 0.0)
    assert 1.27 <= 0.5 * (port.bore - port.groove_diameter) <= 1.40
    assert 0.18 <= made.squeeze <= 0.32 and made.fill < 0.85 and 0.0 <= made.stretch <= 0.05
    # The volume of a ring stays when it is stretched: its area by Pappus's theorem, to second order in the stretch.
    middle, stretched = port.ring_diameter + port.section, port.groove_diameter + port.section
    area = 0.25 * math.pi * port.section**2 * middle / stretched
    assert made.fill == pytest.approx(area / (0.5 * (port.bore - port.groove_diameter) * port.groove_width), rel=0.02)


@pytest.mark.parametrize("accuracy", [0.05, 0.1, 0.2])
def test_tolerances_of_a_gland_are_those_of_its_parts(accuracy):
    port = load_scene("paper-dome", {"connector.port": "o-ring-9"}, LIBRARY).port
    exact, made = working.gland(port, 0.0).squeeze, working.gland(port, accuracy)

    def squeeze(**changes):
        return working.gland(port.model_copy(update=changes), 0.0).squeeze

    groove = squeeze(groove_diameter=port.groove_diameter + accuracy) - exact
    bore = exact - squeeze(bore=port.bore + port.bore_tolerance)
    ring = squeeze(section=port.section + port.section_tolerance) - exact
    assert made.most - exact == pytest.approx(math.hypot(groove, bore, ring))
    assert exact - made.least == pytest.approx(made.most - exact)


@pytest.mark.parametrize(
    ("changes", "count"),
    [
        ({}, 0),
        ({"groove_diameter": 6.0}, 2),
        ({"groove_diameter": 6.8}, 2),
        ({"groove_width": 2.0}, 1),
        ({"section_tolerance": 0.3}, 2),
    ],
)
def test_the_rule_of_the_o_ring_turns_at_each_of_its_bounds(changes, count):
    made = {"connector.port": "o-ring-9", "connector.material": "ABS", "print.connector_profile": "abs-filament"}
    port = load_scene("paper-dome", made, LIBRARY).port.model_copy(update=changes)
    assert isinstance(port, ORingStub)
    found = found_by(working.check_gland, made, port=port)
    assert [one.severity for one in found] == ["warning"] * count
    for one in found:
        assert one.excess.measured != pytest.approx(one.excess.limit)


@pytest.mark.parametrize("printer", ["abs-filament", "form3", "objet260-connex"])
def test_the_stub_goes_into_its_bore_and_keeps_a_wall_under_the_groove(printer):
    scene = load_scene("paper-dome", {"connector.port": "o-ring-9"}, LIBRARY)
    port, made = scene.port, LIBRARY.load("printers", printer)
    assert port.stub_diameter + made.accuracy_mm.nominal < port.bore
    assert 0.5 * (port.groove_diameter - port.passage_diameter) >= made.smallest.wall_rigid_mm.recommended
    solid = assembly({"connector.port": "o-ring-9"}).solid("connector")
    assert isinstance(solid, Solid)
    groove = [piece.bounds() for piece in solid.meridian.tagged("groove")]
    assert max(high[3] for high in groove) - min(low[2] for low in groove) == pytest.approx(port.groove_width)


# Hose clamp


@pytest.mark.parametrize(
    ("port", "tube", "pressure", "clamped"),
    [
        ("barb-6x4", "6x4-silicone", 0, True),
        ("barb-6x4", "6x4", 22, False),
        ("barb-4x2.5", "4x2.5", 60, True),
        ("push-in-6", "6x4", 60, False),
    ],
)
def test_a_clamp_holds_soft_tube_and_any_tube_at_pressure(port, tube, pressure, clamped):
    changes = {"connector.port": port, "pneumatics.tube": tube, "pneumatics.driving_pressures_kPa": [pressure]}
    made = assembly(changes, "stiff-dome")
    width = hardware(changes, "stiff-dome").clamp_mm
    line = next(line for line in making(made) if line.startswith("Port"))
    if not clamped:
        assert not width and "clamp" not in line
        return
    wall = 0.5 * (made.scene.tube.outer_diameter - made.scene.tube.inner_diameter)
    assert width == pytest.approx(made.scene.port.stem_diameter + 2 * wall)
    assert re.search(rf"\b{width:g} mm", line)
