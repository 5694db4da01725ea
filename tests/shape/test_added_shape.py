"""A shape is one file and one line: a hemisphere under another name goes everywhere, and gives the same sensor."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.contact_object import check_shape
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.sheet import object_section
from pneutouch.export.simulator.model import moving_share
from pneutouch.mechanics.models.solid import solid_probe
from pneutouch.parts import assemble
from pneutouch.printability.measure.mould import cavity_match
from pneutouch.schemas import schema_of
from pneutouch.shape import SHAPES
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.shape.round import Cap
from pneutouch.spec.calibration import CalibratedDesign, SensorCalibration
from pneutouch.spec.design import DesignFile
from pneutouch.spec.membrane_table import Membrane
from pneutouch.spec.read import validate
from pneutouch.workflows.build import build
from tests.shape.shapes import HalfBall, HalfHighCap, LongThimble

ADDED = (HalfBall, HalfHighCap, LongThimble)
SHAPE = "membrane.shape"


@pytest.fixture(autouse=True)
def _added(monkeypatch):
    for kind in ADDED:
        monkeypatch.setitem(SHAPES, kind.key, kind)


def renamed(design, name, shape):
    """A shipped design under a name of its own, in a shape."""
    source = DesignSource.of(design, Library.default())
    tables = {**source.content, "membrane": {**source.content.get("membrane", {}), "shape": shape}}
    return DesignSource(name, tables, name)


def figures_of(prediction):
    """Every figure of the states and the limit point."""
    rows = [
        (s.apex_inner, s.apex_outer, s.cavity_volume, s.range_end, s.figures.sensitivity, *s.force, *s.pressure_rise)
        for s in prediction.states
    ]
    return np.concatenate([*rows, [prediction.limit_point.driving_pressure, prediction.limit_point.apex_outer]])


@pytest.mark.parametrize("clamp", ["base", pytest.param("flange", marks=pytest.mark.slow)])
def test_the_solid_predicts_a_hemisphere_of_another_name_alike(clamp, evaluated):
    usual = evaluated("paper-dome") if clamp == "base" else evaluate("paper-dome", clamp=clamp)
    other = evaluate("paper-dome", {SHAPE: "half-ball"}, clamp=clamp)
    assert [type(one.sensor.dome.shape) for one in (usual, other)] == [Hemisphere, HalfBall]
    assert figures_of(other.prediction) == pytest.approx(figures_of(usual.prediction), rel=1e-9)
    assert [(one.rule, one.severity) for one in other.findings] == [(one.rule, one.severity) for one in usual.findings]


@pytest.mark.slow
def test_a_build_makes_the_same_bodies_and_a_datasheet(tmp_path):
    folders = [
        build(evaluate(renamed("paper-dome", "dome", key)), tmp_path / key) for key in ("hemisphere", "half-ball")
    ]
    usual, other = ({path.relative_to(folder) for path in folder.rglob("*.*")} for folder in folders)
    assert usual == other
    same = [path for path in usual if path.suffix in (".stl", ".step", ".glb")]
    assert len(same) > 3
    for path in same:
        assert (folders[0] / path).read_bytes() == (folders[1] / path).read_bytes(), path
    assert (folders[1] / "datasheet.pdf").stat().st_size > 10_000


def test_the_mould_forms_it():
    moulds = [
        assemble(load_scene("cast-dome", {SHAPE: key})).mould for key in ("hemisphere", "half-ball", "half-high-cap")
    ]
    volumes = [[body.volume for body in mould.bodies] for mould in moulds]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-12)
    for mould in moulds:
        match = cavity_match(mould.size, mould.closed, mould.tolerance)
        assert match.void == pytest.approx(match.membrane, rel=1e-3)
        assert max(match.missing, match.extra) < 1e-3 * match.membrane


def test_auto_passes_over_the_closed_form_and_the_table_with_a_reason():
    prediction = evaluate("paper-dome", {SHAPE: "half-ball"}, model="auto", tolerance=0.05).prediction
    assert prediction.model == "solid"
    assert prediction.error_estimate.model_choice.count("half-ball") == 1
    assert evaluate("paper-dome", model="auto", tolerance=0.05).prediction.model == "atlas"


@pytest.mark.parametrize("model", ["membrane", "atlas"])
def test_models_of_the_hemisphere_refuse_it(model):
    with pytest.raises(InputError) as caught:
        evaluate("paper-dome", {SHAPE: "half-ball"}, model=model)
    assert (caught.value.key, caught.value.value) == ("model", model)
    assert caught.value.remedy


def test_an_unknown_shape_names_file_key_value_and_what_would_be_right():
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", {SHAPE: "cube"})
    error = caught.value
    assert error.file.endswith("paper-dome.toml")
    assert (error.key, error.value) == (SHAPE, "cube")
    assert all(f'"{key}"' in error.problem for key in SHAPES)


def test_names_come_from_the_one_table():
    shape = schema_of("design")["properties"]["membrane"]
    text = str(shape) if "$ref" not in shape else str(schema_of("design")["$defs"][shape["$ref"].rpartition("/")[2]])
    assert all(f"'{key}'" in text for key in SHAPES)


def test_the_usual_shape_is_left_out_of_dumps():
    assert "shape" not in Membrane().model_dump()
    assert "shape" not in validate(DesignFile, {"membrane": {"shape": "hemisphere"}}, "x").membrane.model_dump(
        mode="json"
    )
    assert Membrane(shape="half-ball").model_dump()["shape"] == "half-ball"


@pytest.mark.parametrize("kind", [HalfHighCap, pytest.param(LongThimble, marks=pytest.mark.slow)])
def test_other_shapes_are_drawn_solved_and_pressed(kind):
    """Gas, apexes and print mesh are those of the shape; a cell across the joint of two pieces costs 4e-6 of the gas."""
    evaluation = evaluate("paper-dome", {SHAPE: kind.key, "pneumatics.driving_pressures_kPa": [0.0]})
    shape, assembly, (state,) = kind(9.25, 1.5), evaluation.assembly, evaluation.prediction.states
    assert (state.apex_inner, state.apex_outer) == pytest.approx((shape.height, shape.outer_height))
    assert state.cavity_volume == pytest.approx(shape.cavity_volume, rel=1e-5)
    assert assembly.layout.shape.cavity_volume == shape.cavity_volume
    assert assembly.bodies[0].volume == pytest.approx(assembly.solids[0].volume, rel=1e-3)
    assert assembly.bodies[0].bounds[1, 2] == pytest.approx(shape.outer_height, abs=0.02)
    assert evaluation.sensor.protocol.depth == pytest.approx(0.75 * shape.height)
    assert state.figures.sensitivity > 0.0
    assert assembly.solids[0].deviation(assembly.bodies[0]) < assembly.scene.mesh_tolerance


def test_an_object_stands_on_a_cap_where_it_touches_it():
    changes = {SHAPE: "half-high-cap", "contact.object": "ball", "contact.ball_radius_mm": 4.0}
    sensor = sensor_of(assemble(load_scene("paper-dome", changes)))
    section = object_section(sensor)
    assert np.nanmin(section[:, 1]) == pytest.approx(sensor.dome.shape.outer_height, abs=1e-3)


def test_the_moving_mass_goes_with_the_square_of_the_height():
    """Of a thin cap of a sphere z is evenly spread (Archimedes), as over a hemisphere: a third at half the height."""
    for kind in (Hemisphere, HalfBall, HalfHighCap):
        shape = kind(10.0, 1e-4)
        share = moving_share(shape, 1000.0)
        (_, arc), volume = shape.arcs, sum(piece.swept() for piece in shape.outer) - shape.cavity_volume
        assert share.mass == pytest.approx(1000.0 * 1e-9 * volume / 3.0, rel=1e-4)
        assert 1e3 * share.centre[2] == pytest.approx(0.5 * shape.height, rel=1e-4)
        assert arc > shape.height


def test_no_search_is_made_in_a_shape_that_the_atlas_does_not_cover():
    scene = load_scene("paper-dome", {SHAPE: "half-ball"})
    with pytest.raises(InputError) as caught:
        check_shape(scene)
    assert (caught.value.key, caught.value.value, caught.value.file) == (SHAPE, "half-ball", scene.where)
    check_shape(load_scene("paper-dome"))


def test_a_calibration_of_one_shape_is_not_taken_for_another():
    made = CalibratedDesign(
        name="x", material="TangoPlus", inner_radius_mm=9.25, wall_thickness_mm=1.5, dead_volume_mL=0.0
    )
    calibration = SensorCalibration.model_construct(design=made)
    assert calibration.misfit("TangoPlus", Hemisphere(9.25, 1.5)) is None
    assert "half-ball" in str(calibration.misfit("TangoPlus", HalfBall(9.25, 1.5)))


def test_a_calibration_is_not_taken_for_another_size_of_its_shape():
    sizes = {"rise_mm": 4.6}
    made = CalibratedDesign(
        name="x",
        material="TangoPlus",
        inner_radius_mm=9.25,
        wall_thickness_mm=1.5,
        dead_volume_mL=0.0,
        shape="cap",
        sizes=sizes,
    )
    calibration = SensorCalibration.model_construct(design=made)
    assert calibration.misfit("TangoPlus", Cap(9.25, 1.5, 4.6)) is None
    assert calibration.misfit("TangoPlus", Cap(9.25, 1.5, 4.7)) is not None


@pytest.mark.parametrize("kind", [HalfHighCap, LongThimble])
def test_a_graded_wall_of_another_shape_has_its_moduli_from_pole_to_rim(kind):
    """The grade of the design along the arc of the shape, at the points at which the solid takes it."""
    source = renamed("graded-dome", "graded-cap", kind.key)
    sensor = sensor_of(assemble(load_scene(source)))
    found, stated = solid_probe(sensor).solid.relative, np.array(sensor.wall.grade[1])
    assert found.min() == pytest.approx(stated.min(), rel=0.05) and found.max() == pytest.approx(stated.max(), rel=0.1)
