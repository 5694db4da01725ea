"""What a dataset says is what predict says, and what cannot be predicted is said too."""

from __future__ import annotations

import itertools
import json
from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch import __version__
from pneutouch.errors import ComputationError
from pneutouch.evaluation.result import predicted
from pneutouch.results.prediction import StateRecord
from pneutouch.results.record import plain
from pneutouch.workflows.sweep import plan_of_file, sweep, work
from pneutouch.workflows.sweep.execute import ComputeResources
from pneutouch.workflows.sweep.variables import state_values
from tests.workflows.sweep.conftest import load, small

ALONE = ComputeResources(workers=1)
TWELVE_DIGITS, NINE_DIGITS, SIX_DIGITS = 1.1e-11, 1e-9, 1.1e-5
"""Figures and intervals of a batch may be rounded to the other side of a half; presses of the solid guide each other."""

FIGURES = (
    "sensitivity_kPa_per_N",
    "sensitivity_through_origin_kPa_per_N",
    "r_squared",
    "nonlinearity_percent",
    "stiffness_N_per_mm",
    "range_end_mm",
    "saturation_force_N",
    "apex_height_inner_mm",
    "apex_height_outer_mm",
    "cavity_volume_mL",
)


def same(found, expected, rel=0.0):
    return np.isnan(found) if expected is None else float(found) == pytest.approx(expected, rel=rel, abs=0.0)


def agrees(point, document, figures=0.0, intervals=0.0):
    """Every figure of one point of a dataset with a document of ``predict --json``."""
    for state in document["states"]:
        here = point.sel(driving_pressure_kPa=state["driving_pressure_kPa"])
        assert (str(here.status.values), str(here.message.values)) == ("ok", "")
        for name in FIGURES:
            assert same(here[name], state[name], figures), name
        interval = state["uncertainty"].get("figures", {}).get("sensitivity_kPa_per_N", {})
        assert same(here.sensitivity_low_kPa_per_N, interval.get("low"), intervals)
        assert same(here.sensitivity_high_kPa_per_N, interval.get("high"), intervals)
        low, high = state["force_range_N"] or (None, None)
        assert same(here.force_range_low_N, low, figures)
        assert same(here.force_range_high_N, high, figures)
        ends = [event["kind"] for event in state["events"] if event["ends_range"]]
        assert str(here.range_end_event.values) == (ends[0] if ends else "depth")
    limits, top = document["limits"], document["limit_point"]
    for name in ("limit_point_kPa", "break_strain_kPa", "gauge_range_kPa"):
        assert same(point[name], limits[name], figures)
    assert str(point.binding_limit.values) == limits["binding"]
    assert same(point.limit_point_apex_height_inner_mm, top and top["apex_height_inner_mm"])
    assert same(point.limit_point_apex_height_outer_mm, top and top["apex_height_outer_mm"])
    assert same(point.dead_volume_mL, document["dead_volume_mL"])
    error = document["error_estimate"]
    assert same(point.error_sensitivity_relative, error["sensitivity_relative"])
    assert same(point.error_limit_pressure_relative, error["limit_pressure_relative"])
    assert str(point.error_sensitivity_basis.values) == error["sensitivity_basis"]


@pytest.mark.parametrize(
    ("model", "resins", "walls"),
    [
        ("membrane", ["TangoPlus", "FLX9960"], [1.0, 1.25, 1.5]),
        ("atlas", ["TangoPlus", "FLX9960"], [1.0, 1.25, 1.5]),
        pytest.param("solid", ["FLX9950"], [1.2, 1.5], marks=pytest.mark.slow),
    ],
)
def test_every_figure_is_that_of_predict(model, resins, walls, evaluated, library, tmp_path):
    plan = small(
        [f"membrane.material={','.join(resins)}", f"membrane.wall_thickness_mm={walls[0]}:{walls[-1]}:{len(walls)}"],
        settings=["pneumatics.dead_volume_mL=0.3"],
        model=model,
    )
    sweep(plan, tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc")
    assert data.sizes == {
        "membrane_material": len(resins),
        "membrane_wall_thickness_mm": len(walls),
        "driving_pressure_kPa": 4,
    }
    for resin, wall in itertools.product(resins, walls):
        words = [f"membrane.material={resin}", f"membrane.wall_thickness_mm={wall}", "pneumatics.dead_volume_mL=0.3"]
        document = plain(predicted(evaluated("paper-dome", *words, model=model)))
        figures = {"membrane": 0.0, "atlas": TWELVE_DIGITS, "solid": NINE_DIGITS}[model]
        agrees(
            data.sel(membrane_material=resin, membrane_wall_thickness_mm=wall),
            document,
            figures,
            SIX_DIGITS if figures else 0.0,
        )


def test_designs_that_share_their_sources_have_predict_s_intervals_whatever_their_gas(evaluated, library, tmp_path):
    """Near the paper's sensor the model's error is another, so sources are shared on either side of that alone."""
    plan = small(["pneumatics.dead_volume_mL=0,0.4,1.5", "membrane.wall_thickness_mm=1.1,2.6"], model="atlas")
    sweep(plan, tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc")
    for dead, wall in itertools.product((0.0, 0.4, 1.5), (1.1, 2.6)):
        words = [f"pneumatics.dead_volume_mL={dead}", f"membrane.wall_thickness_mm={wall}"]
        document = plain(predicted(evaluated("paper-dome", *words, model="atlas")))
        point = data.sel(pneumatics_dead_volume_mL=dead, membrane_wall_thickness_mm=wall)
        agrees(point, document, TWELVE_DIGITS, SIX_DIGITS)


def test_a_state_off_the_axis_has_its_forces_at_the_end_of_the_range_and_those_of_a_shear():
    sheared = {"stiffness_N_per_mm": 2.5, "peak_sideways_force_N": -1.5, "slips_throughout_mm": None}
    curves = {"sideways_force_N": [0.0, 0.5, 0.75], "moment_N_mm": [0.0, -4.0, -8.0]}
    central = dict.fromkeys(field.name for field in fields(StateRecord)) | {"events": ()}
    central |= {"range_end_mm": 3.0, "curve": SimpleNamespace(indentation_mm=[0.0, 2.0, 4.0])}
    off_axis = SimpleNamespace(**curves, shear=SimpleNamespace(**sheared))
    values = state_values(SimpleNamespace(**central | {"off_axis": off_axis}), None)
    assert (values["sideways_force_N"], values["moment_N_mm"]) == (0.625, -6.0)
    assert (values["shear_stiffness_N_per_mm"], values["shear_peak_sideways_force_N"]) == (2.5, -1.5)
    assert values["shear_slips_throughout_mm"] is None
    found = state_values(SimpleNamespace(**central), None)
    assert all(value is None for name, value in found.items() if "sideways" in name or "moment" in name)


def test_a_list_has_its_own_pressures_and_values(evaluated, library, tmp_path):
    (tmp_path / "list.toml").write_text(
        'design = "paper-dome"\nmodel = "membrane"\n[set]\nindentation.steps = 10\n[[point]]\n"membrane.material" = "FLX9940"\n'
        '[[point]]\nmembrane.wall_thickness_mm = 1\n"pneumatics.driving_pressures_kPa" = [30, 12]\n'
    )
    sweep(plan_of_file(tmp_path / "list.toml"), tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc")
    assert data.driving_pressure_kPa.values.tolist() == [0, 5, 12, 22, 30]
    assert data.membrane_material.values.tolist() == ["FLX9940", "TangoPlus"]
    assert data.membrane_wall_thickness_mm.values.tolist() == [1.5, 1.0]
    assert data.status.values.tolist() == [["ok"] * 4 + [""], ["", "", "ok", "", "refused"]]
    asked = evaluated("paper-dome", "indentation.steps=10", "membrane.material=FLX9940", model="membrane")
    agrees(data.sel(point=0), plain(predicted(asked)))
    words = ["indentation.steps=10", "membrane.wall_thickness_mm=1", "pneumatics.driving_pressures_kPa=[12]"]
    agrees(data.sel(point=1), plain(predicted(evaluated("paper-dome", *words, model="membrane"))))
    assert np.isnan(data.sensitivity_kPa_per_N.values[data.status.values != "ok"]).all()


def test_every_variable_says_its_unit_and_the_file_its_origin(library, tmp_path):
    outcome = sweep(small(), tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc")
    for name, variable in data.variables.items():
        assert variable.attrs["long_name"], name
        assert ("units" in variable.attrs) == (variable.dtype.kind == "f"), name
        unit = variable.attrs.get("units", "")
        if "_kPa" in name or "_mm" in name:
            assert unit in name.replace("_per_", "/").replace("N_mm", "N mm"), name
    assert data.attrs["pneutouch_version"] == __version__
    assert data.attrs["input_hash"] == outcome.input_hash
    assert json.loads(data.attrs["base_design_content"])["membrane"]["inner_radius_mm"] == 9.25
    assert "Table S1" in data.attrs["error_estimate"]


@pytest.mark.slow
@pytest.mark.parametrize("model", ["membrane", "solid"])
def test_pressures_beyond_the_limit_are_refused_and_the_others_predicted(model, evaluated, library, tmp_path):
    plan = small(["pneumatics.driving_pressures_kPa=5,45,60"], model=model)
    outcome = sweep(plan, tmp_path / "x.nc", ALONE, library=library)
    point = load(tmp_path / "x.nc").isel(point=0)
    assert outcome.states == {"ok": 1, "refused": 2, "failed": 0}
    document = plain(predicted(evaluated("paper-dome", "pneumatics.driving_pressures_kPa=[5]", model=model)))
    agrees(point, document)
    limit = document["limits"]["limit_point_kPa"]
    assert point.status.values.tolist() == ["ok", "refused", "refused"]
    assert all(f"at most {limit:.2f} kPa" in text for text in point.message.values[1:])

    sweep(small(["pneumatics.driving_pressures_kPa=45,60"], model=model), tmp_path / "y.nc", ALONE, library=library)
    nothing = load(tmp_path / "y.nc").isel(point=0)
    assert nothing.status.values.tolist() == ["refused", "refused"]
    assert nothing.limit_point_kPa == pytest.approx(limit, rel=1e-11)


def test_a_corner_that_is_no_design_and_a_plate_too_small_are_refused(library, tmp_path):
    over = ["membrane.inner_radius_mm=5,9.25", "membrane.wall_thickness_mm=1,6", "indentation.plate_diameter_mm=12,30"]
    plan = small(over, settings=["pneumatics.driving_pressures_kPa=[0]"])
    sweep(plan, tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc").isel(driving_pressure_kPa=0)
    status = data.status.sel(indentation_plate_diameter_mm=30).values.tolist()
    assert status == [["ok", "refused"], ["ok", "ok"]]
    corner = str(data.message.values[0, 1, 0])
    assert corner == "designs/paper-dome.toml: membrane: wall_thickness_mm = 6 must be less than inner_radius_mm = 5"
    assert data.status.values[1, 0, 0] == "refused"
    assert "indentation.plate_diameter_mm = 12" in str(data.message.values[1, 0, 0])


def test_a_point_that_fails_costs_no_other(library, tmp_path, monkeypatch):
    original = work.evaluate_drawn

    def sometimes(drawn, *given):
        wall_mm = drawn.scene.design.membrane.wall_thickness_mm
        if wall_mm == 0.9:
            raise ComputationError("the solver lost its way at 3 mm")
        if wall_mm == 1.5:
            raise ZeroDivisionError("oops")
        return original(drawn, *given)

    monkeypatch.setattr(work, "evaluate_drawn", sometimes)
    outcome = sweep(
        small(settings=["pneumatics.driving_pressures_kPa=[0, 5]"]), tmp_path / "x.nc", ALONE, library=library
    )
    data = load(tmp_path / "x.nc")
    assert outcome.states == {"ok": 2, "refused": 0, "failed": 4}
    assert data.status.values.tolist() == [["ok", "ok"], ["failed", "failed"], ["failed", "failed"]]
    assert data.message.values[1, 0] == "the solver lost its way at 3 mm"
    assert "ZeroDivisionError: oops" in data.message.values[2, 1]


def test_whole_numbers_and_fields_without_a_default_become_coordinates(library, tmp_path):
    plan = small(
        ["indentation.steps=6:10:3", "indentation.depth_mm=2,3"], settings=["pneumatics.driving_pressures_kPa=[0]"]
    )
    sweep(plan, tmp_path / "x.nc", ALONE, library=library)
    data = load(tmp_path / "x.nc")
    assert data.indentation_steps.values.tolist() == [6, 8, 10]
    assert data.indentation_steps.dtype.kind == "i"
    assert data.range_end_mm.values[..., 0].tolist() == [[2, 3]] * 3
