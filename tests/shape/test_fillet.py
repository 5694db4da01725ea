"""A fillet between the outside of the dome and its flange: in the solid, the mould, the mesh and the figures."""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.contact_object import check_shape
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.atlas.coverage import outside_fit
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.parts import assemble
from pneutouch.printability.measure.mould import cavity_match
from pneutouch.shape import Hemisphere, shape_of

FILLET, DEPTH = "membrane.root_fillet_mm", "indentation.depth_mm"
PRESSURES = np.array([0.0, 0.012])


def filleted(design, fillet, **changes):
    return load_scene(design, {FILLET: fillet, **changes})


@given(st.floats(1, 100), st.floats(0.05, 0.6), st.floats(0.01, 0.5))
def test_the_faces_are_smooth_and_reach_from_the_base_to_the_pole(radius, wall, fillet):
    shape = shape_of("hemisphere", radius, wall * radius, {"root_fillet": fillet * radius})
    foot, dome = shape.outer
    assert foot.start == pytest.approx((shape.outer_radius, 0.0), abs=1e-9 * radius)
    assert foot.end == pytest.approx(dome.start, abs=1e-9 * radius)
    ends = np.array([0.0, 1.0])
    assert foot.normals(ends)[0] == pytest.approx([0.0, 1.0], abs=1e-9)
    assert foot.normals(ends)[1] == pytest.approx(dome.normals(ends)[0], abs=1e-9)
    assert shape.plain == Hemisphere(radius, wall * radius)
    assert (shape.height, shape.outer_height) == pytest.approx((radius, radius + wall * radius))
    assert shape.cavity_volume == pytest.approx(2 / 3 * math.pi * radius**3)


@pytest.mark.parametrize("fillet", [0.5, 2.0])
def test_the_solid_is_that_of_a_fillet_drawn_by_another_program(fillet):
    """CadQuery rounds the corner of a sharp membrane whose flange is as wide."""
    assembly = assemble(filleted("paper-dome", fillet))
    layout, membrane = assembly.layout, next(one for one in assembly.solids if one.role == "membrane")
    outer, low = layout.inner_radius + layout.wall, -layout.flange_thickness
    sharp = (
        cq.Workplane("XZ")
        .moveTo(0.0, low)
        .lineTo(layout.flange_radius, low)
        .lineTo(layout.flange_radius, 0.0)
        .lineTo(outer, 0.0)
        .threePointArc((outer * math.sqrt(0.5), outer * math.sqrt(0.5)), (0.0, outer))
        .close()
        .revolve(360, (0, 0, 0), (0, 1, 0))
    )
    corner = cq.selectors.BoxSelector((-outer - 0.1, -outer - 0.1, -0.1), (outer + 0.1, outer + 0.1, 0.1), True)
    rounded = sharp.edges("%CIRCLE").edges(corner).fillet(fillet)
    assert rounded.val().isValid()
    r, deep = layout.inner_radius, layout.flange_thickness
    cavity = 2 / 3 * math.pi * r**3 + math.pi * r**2 * deep
    assert membrane.volume == pytest.approx(rounded.val().Volume() - cavity, rel=1e-6)


@pytest.mark.parametrize(("design", "cavities"), [("cast-dome", 1), ("cast-dome", 3)])
def test_the_mould_forms_it(design, cavities):
    mould = assemble(filleted(design, 1.0, **{"mould.cavities": cavities})).mould
    match = cavity_match(mould.size, mould.closed, mould.tolerance)
    assert match.void == pytest.approx(match.membrane, rel=1e-3)
    assert max(match.missing, match.extra) < 1e-3 * match.membrane


@pytest.mark.parametrize("fillet", [0.5, 1.0])
def test_the_mesh_resolves_it(fillet):
    """Force and rise at half the radius: within 0.3 % of a mesh with twice the cells along the arc."""
    sensor = sensor_of(assemble(filleted("paper-dome", fillet, **{DEPTH: 4.5}))).replace(waves=0)
    usual, fine = (solid_result(sensor, PRESSURES, cells=cells, past_limit=1.0) for cells in (None, 56))
    for one, other in zip(usual.states, fine.states, strict=True):
        assert one.force[-1] == pytest.approx(other.force[-1], rel=3e-3)
        assert one.pressure_rise[-1] == pytest.approx(other.pressure_rise[-1], rel=3e-3)


def test_it_stiffens_the_root_and_vanishes_with_its_radius():
    forces = []
    for fillet in (None, 0.1, 1.0, 2.0):
        scene = load_scene("paper-dome", {DEPTH: 4.5, **({} if fillet is None else {FILLET: fillet})})
        result = solid_result(sensor_of(assemble(scene)).replace(waves=0), PRESSURES, past_limit=1.0)
        forces.append([state.force[-1] for state in result.states])
    assert (np.diff(forces, axis=0) > 0).all()
    assert forces[1] == pytest.approx(forces[0], rel=0.015)


def test_it_has_intervals_and_can_be_calibrated_and_a_search_refuses_it_by_its_key():
    evaluation = evaluate("paper-dome", {FILLET: 1.0}, model="auto")
    assert evaluation.prediction.model == "solid"
    figure = (evaluation.uncertainty[0].figures or {})["sensitivity_kPa_per_N"]
    assert figure.value == pytest.approx(evaluation.prediction.states[0].figures.sensitivity)
    assert figure.low < figure.value < figure.high
    assert outside_fit(evaluation.sensor) is None
    with pytest.raises(InputError) as error:
        check_shape(evaluation.scene)
    assert (error.value.key, error.value.value) == (FILLET, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("fillet", [0.5, 1.0, 1.85])
def test_derivatives_of_the_sharp_corner_stand_for_it(fillet):
    """By wall and radius, over pairs of solids 4 % apart: within the 0.2 that the note of the interval states."""

    def slopes(changes):
        def logs(key, value):
            scene = load_scene("paper-dome", {DEPTH: 5.5, **changes, key: value})
            result = solid_result(sensor_of(assemble(scene)).replace(waves=0), PRESSURES, past_limit=1.0)
            return np.log([state.figures.sensitivity for state in result.states])

        sizes = {"membrane.wall_thickness_mm": 1.5, "membrane.inner_radius_mm": 9.25}
        return [(logs(k, 1.02 * v) - logs(k, 0.98 * v)) / math.log(1.02 / 0.98) for k, v in sizes.items()]

    assert np.abs(np.subtract(slopes({FILLET: fillet}), slopes({}))).max() < 0.2
