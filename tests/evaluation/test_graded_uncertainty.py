"""An even wall of the mean modulus speaks for a graded one: its derivatives, against the solid's own differences."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue.mixture import mixed_material
from pneutouch.evaluation.uncertainty import GAP, STEEP_GAP, notes_on
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.atlas.coverage import outside_atlas
from pneutouch.mechanics.atlas.figures import FIGURES, INPUTS, SENSITIVITY
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.propagate import derivatives
from pneutouch.results.record import plain as data
from pneutouch.spec.grade import Grade
from pneutouch.units import KPA

STEP = 0.02


def logs(sensor: Sensor, pressure: float) -> float:
    (state,) = solid_result(sensor, np.array([pressure])).states
    return float(np.log(state.figures.sensitivity))


SOFTER = "mixture-tool"
"""The curve by which 0, 10 and 40 % are 1, 2.2 and 13 times as stiff as the soft resin, too."""


def graded(sensor: Sensor, fractions: list[float], library, curve: str | None = None) -> Sensor:
    """The sensor with its wall graded another way."""
    content = {"from": "TangoPlus", "to": "VeroClear", "fraction": fractions, "curve": curve}
    grade = Grade.model_validate(content)
    other = material_sensor(mixed_material(grade, library, file="here"))
    return sensor.replace(shear_modulus=other.wall.shear_modulus, grade=other.wall.grade)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "fractions", "curve", "pressure", "gap"),
    [
        pytest.param("shear_modulus", [0.0, 0.19], None, 0.0, GAP, marks=pytest.mark.slow),
        ("shear_modulus", [0.19, 0.0], None, 12 * KPA, GAP),
        ("wall_thickness", [0.19, 0.0], None, 12 * KPA, GAP),
        pytest.param("wall_thickness", [0.0, 0.08, 0.265], None, 0.0, STEEP_GAP, marks=pytest.mark.slow),
        pytest.param("shear_modulus", [0.0, 0.08, 0.265], None, 0.0, STEEP_GAP, marks=pytest.mark.slow),
        pytest.param("wall_thickness", [0.0, 0.1, 0.4], SOFTER, 0.0, STEEP_GAP, marks=pytest.mark.slow),
        pytest.param("shear_modulus", [0.0, 0.1, 0.4], SOFTER, 0.0, GAP, marks=pytest.mark.slow),
    ],
)
def test_the_even_walls_derivatives_are_near_the_graded_solids(
    evaluated, library, name, fractions, curve, pressure, gap
):
    sensor = graded(evaluated("graded-dome").sensor, fractions, library, curve)
    value = getattr(sensor.wall if name == "shear_modulus" else sensor.dome, name)
    more, less = (sensor.replace(**{name: value * np.exp(step)}) for step in (STEP, -STEP))
    solid = (logs(more, pressure) - logs(less, pressure)) / (2 * STEP)
    flat = np.zeros((len(INPUTS), len(FIGURES), 1))
    batch = batch_of(sensor.even, [pressure])
    found = derivatives(batch, flat, np.full((len(INPUTS), 1), 3.0)).elasticities
    assert found[INPUTS.index(name), SENSITIVITY, 0] == pytest.approx(solid, abs=gap)


@pytest.mark.slow
def test_a_factor_on_the_whole_modulus_is_a_factor_on_the_limit_pressure(evaluated):
    """Neo-Hookean: exactly, whatever the course along the arc; so the even wall's derivative of 1 is the graded one's."""
    sensor = evaluated("graded-dome").sensor
    one, other = (
        solid_result(sensor.replace(shear_modulus=factor * sensor.wall.shear_modulus), np.array([])).limit_point
        for factor in (1.0, 1.3)
    )
    assert other.driving_pressure == pytest.approx(1.3 * one.driving_pressure, rel=1e-6)


def test_an_even_wall_stays_as_it_is_and_needs_no_note(evaluated):
    sensor = evaluated("paper-dome").sensor
    assert sensor.even is sensor
    assert notes_on(sensor) == ()
    other = evaluated("graded-dome").sensor
    assert outside_atlas(other) is not None
    assert outside_atlas(other.even) is None
    assert f"within {GAP:g} of" in notes_on(other)[0]


def test_a_graded_prediction_has_the_solids_figures_and_says_whose_uncertainty_they_carry(evaluated):
    evaluation = evaluated("graded-dome")
    for state, document in zip(evaluation.prediction.states, map(data, evaluation.uncertainty), strict=True):
        figure = document["figures"]["sensitivity_kPa_per_N"]
        assert figure["value"] == pytest.approx(state.figures.sensitivity, rel=1e-5)
        assert figure["low"] < figure["value"] < figure["high"]
        assert "mixing fraction" in figure["shares"]
        assert any("the wall is graded" in note for note in document["notes"])
