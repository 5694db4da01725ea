"""Cast silicones too soft for the atlas's own box are searched all the same: the solid has the last word."""

from __future__ import annotations

import pytest

from pneutouch.cli.select_text import processes_lines
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.workflows.select.checks import source_of
from pneutouch.workflows.select.processes import select_processes

DOME = {"inner_radius_mm": 9.0}


def cast(library, resin, sensitivity=1.9):
    content = {
        "target": {"sensitivity_kPa_per_N": sensitivity, "driving_pressure_kPa": 0.0},
        "given": {**DOME, "materials": [resin]},
        "setting": {"processes": ["casting"]},
    }
    return select_processes(validate(Target, content, "target"), "target", library)


@pytest.mark.slow
def test_a_small_soft_dome_with_a_wall_beyond_the_atlas_is_found(library):
    content = {
        "target": {"sensitivity_kPa_per_N": 5.0, "max_diameter_mm": 9.5},
        "given": {"materials": ["Ecoflex0050"]},
        "setting": {"processes": ["casting"]},
    }
    ((_, run),) = select_processes(validate(Target, content, "target"), "target", library).best
    design = run.answer.designs[0]
    wall, radius = float(design.pool.wall[0]), float(design.pool.radius[0])
    assert wall > 0.35 * radius and 2 * (radius + wall) <= 9.5
    found = evaluate(source_of(run.base, run.assignments(design)), {"indentation.checked_waves": 0}, library=library)
    driven = min(
        found.prediction.states, key=lambda state: abs(state.driving_pressure - float(design.pool.pressure[0]))
    )
    assert driven.figures.sensitivity == pytest.approx(5.0, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("resin", ["Ecoflex0030", "Ecoflex0050"])
def test_a_soft_silicone_is_found_and_the_solid_agrees(resin, library):
    ((_, run),) = cast(library, resin).best
    found = source_of(run.base, run.assignments(run.answer.designs[0]))
    (state,) = evaluate(found, model="solid", library=library).prediction.states
    assert state.figures.sensitivity == pytest.approx(1.9, rel=0.05)


def test_a_silicone_beyond_the_opened_box_is_named_with_the_reason(library):
    lines = processes_lines(cast(library, "Ecoflex0010"))
    assert [line for line in lines if "Ecoflex0010" in line and "soft" in line]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wishes", "resin"),
    [
        ({"sensitivity_kPa_per_N": 1.0}, "DragonSkin20"),
        ({"force_range_N": 30.0}, "MoldStar16"),
        ({"stiffness_least_N_per_mm": 3.0}, "DragonSkin30"),
        ({"stiffness_least_N_per_mm": 3.0}, "Ecoflex0030"),
    ],
)
def test_the_plate_grows_with_a_large_dome_so_that_none_is_lost_to_its_edge(wishes, resin, library):
    content = {"target": wishes, "given": {"materials": [resin]}, "setting": {"processes": ["casting"]}}
    ((_, run),) = select_processes(validate(Target, content, "target"), "target", library).best
    found = source_of(run.base, run.assignments(run.answer.designs[0]))
    (state, *_) = evaluate(found, model="solid", library=library).prediction.states
    assert state.range_end == pytest.approx(0.75 * found.content["membrane"]["inner_radius_mm"], rel=0.01)
