"""Walls too soft for the box of the atlas: its tables hold the states that the solid has in a stiff gas."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.atlas.coverage import outside_atlas
from pneutouch.mechanics.atlas.figures import FIGURES, log_figures, moved, wider_box
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.corrected.figures import pressed_logs
from pneutouch.mechanics.uncertainty.propagate import STEP
from pneutouch.results.record import plain as data
from pneutouch.units import KPA
from tests.mechanics.test_contact import PAPER

SENSITIVITY, STIFFNESS, FORCE = (
    FIGURES.index(name) for name in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "force_at_range_end_N")
)


LIMIT = FIGURES.index("limit_pressure_kPa")


def soft(mu):
    return PAPER.replace(shear_modulus=mu)


@pytest.mark.parametrize("mu", [0.05667, pytest.param(0.02462, marks=pytest.mark.slow), 0.0176])
def test_the_tables_meet_the_solid_in_a_gas_of_several_moduli(mu):
    pressures = 0.0, 0.1 * mu
    by_table = log_figures(batch_of(soft(mu), pressures))
    by_solid = pressed_logs(soft(mu), pressures)
    assert np.abs((by_table - by_solid)[[SENSITIVITY, STIFFNESS, FORCE]]).max() < 2e-3


@pytest.mark.parametrize(
    ("ratio", "share", "mu"), [(0.36, 0.0, 1.0), (0.4, 0.5, 0.17), (0.45, 0.2, 0.06), (0.5, 0.8, 0.3)]
)
def test_the_tables_meet_the_solid_in_walls_beyond_the_box(ratio, share, mu):
    """Without pressure the contact passes the solid's nodes one by one: up to 1.5 % (random presses)."""
    thick = soft(mu).replace(wall_thickness=ratio * PAPER.dome.inner_radius, gauge_limit=1e3, break_stretch=None)
    limit = float(np.exp(log_figures(batch_of(thick, [0.0]))[LIMIT, 0])) * KPA
    by_table, by_solid = log_figures(batch_of(thick, (share * limit,))), pressed_logs(thick, (share * limit,))
    assert np.abs((by_table - by_solid)[SENSITIVITY]).max() < (2e-2 if share == 0.0 else 5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["shear_modulus", "wall_thickness"])
@pytest.mark.parametrize("mu", [0.05667, 0.02462, 0.0176])
def test_the_derivatives_are_those_of_the_solid(mu, name):
    sensor, pressures = soft(mu), (0.0, 0.1 * mu)
    value = {"shear_modulus": mu, "wall_thickness": sensor.dome.wall_thickness}[name]
    batch = batch_of(sensor, pressures)
    # Over a short step the nodes that come into contact one by one move the solid's slopes by up to 0.03.
    wide = 4 * STEP
    more, less = (pressed_logs(sensor.replace(**{name: value * float(np.exp(x))}), pressures) for x in (wide, -wide))
    up, down = (log_figures(moved(batch, name, np.full(2, x))) for x in (STEP, -STEP))
    solid, table = (more - less) / (2 * wide), (up - down) / (2 * STEP)
    for row in (SENSITIVITY, STIFFNESS, FORCE):
        assert table[row] == pytest.approx(solid[row], rel=0.05, abs=0.04), (FIGURES[row], solid[row], table[row])


def test_a_wall_softer_than_that_has_none_and_the_reason_is_stated():
    why = "the wall is too soft: the ambient pressure is 11.1 times its modulus, more than 6"
    assert outside_atlas(soft(0.009126), wider_box()) == why
    assert outside_atlas(soft(0.0176), wider_box()) is None


@pytest.mark.slow
def test_a_soft_cast_wall_has_an_interval_and_states_where_it_is_from(library):
    made = evaluate(
        "cast-dome", {"membrane.material": "DragonSkin10", "pneumatics.driving_pressures_kPa": [0, 5]}, library=library
    )
    for state, entry in zip(made.prediction.states, map(data, made.uncertainty), strict=True):
        figure = entry["figures"]["sensitivity_kPa_per_N"]
        assert figure["value"] == pytest.approx(state.figures.sensitivity, rel=1e-5)
        assert figure["low"] < figure["value"] < figure["high"]
        assert any("1.79 times the modulus" in note for note in entry["notes"])
