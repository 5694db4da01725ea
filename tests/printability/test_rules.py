"""The rules over the shipped designs and every part, what a check promises, and what it says of meshes it cannot measure."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from manifold3d import Manifold

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.subject import subject_of
from pneutouch.parts import assemble
from pneutouch.printability import PrintItem, PrintSubject, check
from pneutouch.printability.rulebook import RULES
from pneutouch.printability.rules.bodies import shared_area
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.spec.read import parse_changes
from tests.conftest import ROOT
from tests.parts.overlap import overlap_volume
from tests.printability.gallery import BAD, ball, box, item, one

LIBRARY = Library((ROOT,))
DESIGNS = sorted(LIBRARY.paths("designs"))
PARTS = [(kind, name) for kind in ("port", "seat", "mount") for name in sorted(LIBRARY.paths(f"{kind}s"))]


def subject(name, *assignments):
    return subject_of(assemble(load_scene(name, parse_changes(assignments), LIBRARY)))


def told(found):
    return [(finding.severity, finding.rule, finding.body) for finding in found]


@pytest.mark.slow  # every day the stored findings of every design say so
@pytest.mark.parametrize("name", DESIGNS)
def test_no_shipped_design_breaks_a_rule(name):
    assert "error" not in [finding.severity for finding in check(subject(name))]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "part"), PARTS)
def test_no_part_breaks_a_rule_on_a_polyjet_printer(kind, part):
    try:
        found = check(subject("stiff-dome", f"connector.{kind}={part}"))
    except InputError as error:
        pytest.skip(str(error))
    assert "error" not in [finding.severity for finding in found], found


def test_the_barb_is_found_as_it_is_drawn():
    """The barb's bore of 1 mm and the wall that its taper leaves: nothing else of the paper's sensor is narrow."""
    found = check(subject("paper-dome", "connector.port=barb-4x2.5"))
    assert sorted(told(found)) == [("warning", "channels", "connector"), ("warning", "walls", "connector")]
    sizes = {finding.rule: finding.excess.measured for finding in found}
    assert sizes["channels"] == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize(("wall", "severity"), [(0.5, "error"), (0.8, "warning"), (1.02, None)])
def test_a_dome_s_wall_is_measured(wall, severity):
    found = [
        finding
        for finding in check(subject("paper-dome", f"membrane.wall_thickness_mm={wall}"))
        if (finding.rule, finding.body) == ("walls", "membrane")
    ]
    assert [finding.severity for finding in found] == ([severity] if severity else [])
    for finding in found:
        assert finding.excess.measured == pytest.approx(wall, abs=0.003)
        assert f"{wall:.2f} mm" in finding.message
        assert finding.fix == "raise membrane.wall_thickness_mm"
        assert 9.25 < np.linalg.norm(finding.where_mm) < 12


def test_findings_come_errors_first_and_repeat():
    parts = subject("paper-dome", "membrane.wall_thickness_mm=0.5")
    found = check(parts)
    order = [finding.severity for finding in found]
    assert order == sorted(order, key=["error", "warning", "note"].index)
    assert found == check(parts)


@pytest.mark.parametrize(
    "turn", [*(pytest.param(t, marks=pytest.mark.slow) for t in ((90, 0, 0), (0, 37, 11))), (12, 34, 56)]
)
def test_findings_do_not_depend_on_the_position(turn):
    for name in ("thin fin", "needle", "capillary", "saw cut", "hairline", "knife", "bubble"):
        plain = BAD[name].make().items[0]
        turned = Manifold(PrintPart(plain).manifold.to_mesh64()).rotate(turn).translate((31.7, -5.3, 12.1))
        assert {f.rule: f.severity for f in check(one(turned))} == BAD[name].breaks, name


def test_a_mesh_that_is_no_solid_gets_the_findings_that_need_none():
    whole = item(box(300, 10, 10))
    broken = replace(whole.body, triangles=whole.body.triangles[:-1])
    found = check(PrintSubject((replace(whole, body=broken),)))
    assert sorted(told(found)) == [("error", "envelope", "part"), ("error", "mesh", "part")]


def test_a_mesh_is_held_against_the_exact_solid():
    class Ball:
        name, volume = "ball", 4 / 3 * np.pi * 1000

        def distance(self, points):
            return np.abs(np.linalg.norm(points, axis=1) - 10.0)

    coarse = check(one(ball(10, sides=48), solid=Ball()))
    assert told(coarse) == [("warning", "mesh", "part")]
    dense = Ball().distance(item(ball(10, sides=48)).body.surface_points(16)).max()
    assert coarse[0].excess.measured == pytest.approx(dense, rel=0.02)
    assert check(one(ball(10, sides=96), solid=Ball())) == []


def test_overlap_and_shared_area_of_two_blocks():
    bodies = [
        item(box(10, 10, 10)).body,
        item(box(10, 10, 10, (0, 0, 10))).body,
        item(box(10, 10, 10, (0, 0, 9.5))).body,
    ]
    assert overlap_volume(bodies[0], bodies[1]) == 0.0
    assert overlap_volume(bodies[0], bodies[2]) == pytest.approx(50.0)
    assert shared_area(bodies[0], bodies[1]) == pytest.approx(100.0)
    assert shared_area(bodies[0], bodies[2]) == 0.0
    assert shared_area(bodies[0], bodies[0]) == pytest.approx(600.0)


def test_an_overlap_is_told_once_and_says_how_much():
    (finding,) = check(BAD["overlap"].make())
    assert (finding.body, finding.excess.measured) == ("one", pytest.approx(50.0))
    assert "other" in finding.message


def test_a_job_s_name_joins_parts_and_no_name_keeps_them_apart():
    pair = [item(box(5, 5, 5), "a"), item(box(5, 5, 5, (9, 0, 0)), "b"), item(box(5, 5, 5, (18, 0, 0)), "c")]
    view = PrintView(PrintSubject((replace(pair[0], job="tray"), pair[1], replace(pair[2], job="tray"))))
    assert [[part.name for part in job.parts] for job in view.jobs] == [["a", "c"], ["b"]]


def test_the_heavy_libraries_load_only_where_they_are_used():
    code = "import sys, pneutouch.printability; print([n for n in ('scipy', 'pymeshlab', 'manifold3d') if n in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_hints_replace_the_plain_advice():
    plate = item(box(30, 30, 0.45), hints={"walls": "raise coupon.thickness_mm"})
    assert isinstance(plate, PrintItem)
    assert check(PrintSubject((plate,)))[0].fix == "raise coupon.thickness_mm"
    assert set(RULES) >= {"walls", "pins", "holes", "channels", "gaps", "emboss"}
