"""Stiffness as the paper means it, dF/dz at a depth: read off curves of few points, against the solid's exact slope."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

import pneutouch as pt
from pneutouch.mechanics import predict
from pneutouch.mechanics.models.solid import press_settings, solid_probe
from pneutouch.mechanics.response import SHALLOW, figures
from pneutouch.mechanics.solid.indent import indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.selection.candidates import REQUIREMENTS
from pneutouch.spec.target import TargetFigures
from pneutouch.units import KPA
from tests.mechanics.solid.test_graded import sensor

PAPER = sensor(0.0, 0.0)


@pytest.mark.parametrize(("modulus", "pressure_kPa"), [(0.17, 0.0), (0.17, 22.0), (1.64, 0.0), (5.33, 22.0)])
def test_the_slope_is_that_of_a_fine_mesh_whatever_the_steps(modulus, pressure_kPa):
    """The reference: a mesh of 160 cells and 200 steps, a cubic fitted to its forces around the depth."""
    one = PAPER.replace(shear_modulus=modulus, waves=0)
    probe = solid_probe(one, 160)
    pressed = indent(probe.solid, state_at(probe.solid, pressure_kPa * KPA), press_settings(one.replace(steps=200)))
    at, force = pressed.column("indentation"), pressed.column("force")
    near = [abs(at - depth) < 0.4 for depth in SHALLOW]
    exact = [np.polyfit(at[k] - depth, force[k], 3)[2] for k, depth in zip(near, SHALLOW, strict=True)]
    for steps, error in ((8, 0.04), (14, 0.03), (50, 0.03)):
        (state,) = predict("", one.replace(steps=steps), [pressure_kPa * KPA]).states
        assert [state.figures.stiffness_at(depth) for depth in SHALLOW] == pytest.approx(exact, rel=error)


def test_the_driving_pressure_stiffens_a_soft_dome_where_the_mean_says_the_reverse():
    """The paper's main claim, which the mean over the range hides: 4.8 falls to 4.0 N/mm, while dF/dz at 1 mm rises."""
    low, high = (s.figures for s in predict("", PAPER, [0.0, 22 * KPA]).states)
    assert high.stiffness < low.stiffness
    assert high.stiffness_1mm / low.stiffness_1mm == pytest.approx(2.45, rel=0.02)
    assert high.stiffness_3mm / low.stiffness_3mm > 1.4


def test_a_curve_that_ends_before_or_has_few_points_has_none():
    depth = np.linspace(0.0, 2.0, 15)
    found = figures(depth, depth**2, depth)
    assert found.stiffness_1mm == pytest.approx(2.0, rel=1e-9) and np.isnan(found.stiffness_3mm)
    few = figures(depth[::3], depth[::3] ** 2, depth[::3])
    assert np.isnan(few.stiffness_1mm)
    assert found.scaled(2.0, 1.0).stiffness_1mm == pytest.approx(4.0, rel=1e-9)


def test_the_atlas_reads_the_same_slopes():
    pressures = [0.0, 12 * KPA]
    for ours, solid in zip(*(predict("", PAPER, pressures, model=m).states for m in ("atlas", "solid")), strict=True):
        for depth in SHALLOW:
            assert ours.figures.stiffness_at(depth) == pytest.approx(solid.figures.stiffness_at(depth), rel=0.02)


def test_a_design_is_selected_by_its_stiffness_at_a_depth():
    assert "stiffness" in REQUIREMENTS
    found = pt.select(sensitivity_kPa_per_N=1.9, stiffness_least_N_per_mm=0.9, stiffness_depth_mm=1)
    best = found.to_dict()["designs"][0]
    assert best["stiffness_at_1mm_N_per_mm"] >= 0.9
    changes = {"inner_radius_mm": best["inner_radius_mm"], "wall_thickness_mm": best["wall_thickness_mm"]}
    design = pt.load("paper-dome").replace(material=best["material"], **changes, dead_volume_mL=best["dead_volume_mL"])
    (state,) = design.predict([best["driving_pressure_kPa"]]).states
    assert state.stiffness_at_1mm_N_per_mm == pytest.approx(best["stiffness_at_1mm_N_per_mm"], rel=0.03)


@pytest.mark.parametrize(
    ("depth", "bounds", "named"), [(3, {}, 3), (2, {"stiffness_least_N_per_mm": 0.9}, 1)], ids=["no bound", "no depth"]
)
def test_a_depth_without_bound_and_another_depth_are_told_apart(depth, bounds, named):
    with pytest.raises(ValidationError) as refused:
        TargetFigures.model_validate({"sensitivity_kPa_per_N": 1.9, "stiffness_depth_mm": depth, **bounds})
    (error,) = refused.value.errors()
    assert len(error["ctx"]["error"].fields) == named
