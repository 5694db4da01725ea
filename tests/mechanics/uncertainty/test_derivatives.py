"""Derivatives: laws of similarity, independence of the step, edges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pneutouch.evaluation.uncertainty import spread
from pneutouch.mechanics.atlas import respond as respond_module
from pneutouch.mechanics.atlas.figures import DEAD, FIGURES, INPUTS, SENSITIVITY, log_figures, moved, neighbourhood
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.propagate import STEP, derivatives, propagate
from pneutouch.mechanics.uncertainty.source import FIGURE
from tests.mechanics.test_contact import PAPER
from tests.mechanics.uncertainty.designs import TEN, batch_for, budget_for, materials

MU, WALL, RADIUS, _, AMBIENT, DRIVING = range(len(INPUTS))


def local(batch, step=STEP):
    shape = len(INPUTS), len(batch)
    return derivatives(batch, np.zeros((shape[0], len(FIGURES), shape[1])), np.full(shape, 3.0), step).elasticities


def combined(sources, batch, elasticity):
    total = 0.0
    for source in sources:
        slope = 1.0 if source.acts_on == FIGURE else elasticity[INPUTS.index(source.acts_on)]
        scale = max(batch.dead_volume[0], 1e9 * (batch.dead_volume[0] == 0)) if source.acts_on == INPUTS[DEAD] else 1.0
        total += source.counts[SENSITIVITY, 0] * (slope * source.standard[0] / scale) ** 2
    return np.sqrt(total)


@settings(max_examples=25)
@given(st.floats(0.08, 0.3), st.floats(0.0, 0.8), st.floats(0.1, 1.0), st.floats(0.0, 3000.0))
def test_stresses_scale_together(wall, share, mu, dead):
    """A factor on every stress changes forces by it and sensitivities, heights and ranges not at all."""
    sensor = PAPER.replace(
        wall_thickness=wall * PAPER.dome.inner_radius,
        shear_modulus=mu,
        dead_volume=dead,
        depth=4.0,
        gauge_limit=1e3,
        break_stretch=None,
    )
    limit = float(respond(batch_of(sensor, [0.0])).limit_pressure[0])
    batch = batch_of(sensor, [share * limit])
    found = respond(batch)
    assume(found.ends[0] == 0)
    total = local(batch)[[MU, AMBIENT, DRIVING], :, 0].sum(axis=0)
    assert total == pytest.approx([0.0, 1.0, 1.0, 1.0, 0.0, 0.0], abs=5e-3)


def test_limit_pressure_goes_with_the_modulus_and_the_wall_ratio():
    found = local(batch_of(PAPER, [0.012]))[:, FIGURES.index("limit_pressure_kPa"), 0]
    assert found[MU] == pytest.approx(1.0, abs=1e-6)
    assert found[WALL] == pytest.approx(-found[RADIUS], abs=1e-4)
    assert 0.85 < found[WALL] < 1.0, "a membrane has 1; the clamp and the thick wall take a little"
    assert found[[DEAD, AMBIENT, DRIVING]] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.slow
def test_neither_noise_nor_curvature_matters_at_the_step(library):
    """Half and twice the step: derivatives of the sensitivity of about one, and what they make of the inputs' spreads."""
    for case in TEN:
        batch = batch_for(library, case)
        sources = budget_for(library, batch, case.resin, case.near_paper).sources
        chosen, wide, narrow = (local(batch, factor * STEP)[:, SENSITIVITY, 0] for factor in (1.0, 2.0, 0.5))
        whole = combined(sources, batch, chosen)
        for other in (wide, narrow):
            assert other == pytest.approx(chosen, abs=0.04)
            assert combined(sources, batch, other) == pytest.approx(whole, rel=0.02)


def test_a_slope_over_the_spread_has_the_sign_of_the_change_over_it():
    """Signs count where one source moves several inputs. A modulus known to a third bends the sensitivity."""
    batch = batch_of(PAPER, [0.0, 0.012])
    standard = np.zeros((len(INPUTS), len(FIGURES), len(batch)))
    standard[MU] = 0.3
    found = derivatives(batch, standard, np.full((len(INPUTS), len(batch)), 2.0))
    more, less = (log_figures(moved(batch, INPUTS[MU], np.full(2, sign * 0.3 * 2.0**0.5))) for sign in (1.0, -1.0))
    bent = found.slopes[MU] != found.local[MU]
    assert bent.sum() >= 3
    assert (np.sign(found.slopes[MU]) == np.sign(more - less))[bent].all()


def test_at_the_edge_of_the_box_the_neighbourhood_is_the_same_atlas():
    """Three quarters of R0 is the deepest press of the box: its neighbours lie in data that the survey has beyond."""
    batch = batch_of(PAPER, [0.0, 0.012, 0.022])
    inside, wider = respond(batch), respond(batch, atlas=neighbourhood())
    assert wider.lines.sensitivity == pytest.approx(inside.lines.sensitivity, rel=1e-12)
    deeper = replace(batch, depth=1.01 * batch.depth)
    assert np.isnan(respond(deeper).lines.sensitivity).all()
    assert respond(deeper, atlas=neighbourhood()).lines.sensitivity == pytest.approx(inside.lines.sensitivity, rel=0.02)


def test_a_sensor_near_its_limit_point_says_that_it_may_be_beyond(library):
    sensor = material_sensor(materials(library)["TangoPlus"])
    found = budget_for(library, batch_of(sensor, [0.012, 0.033]), "TangoPlus", True)
    assert found.doubtful.tolist() == [False, True]
    assert np.isfinite(found.standard).all()


def test_outside_the_atlas_there_is_no_uncertainty(library):
    sensor = material_sensor(materials(library)["TangoPlus"]).replace(wall_thickness=5.5)
    found = budget_for(library, batch_of(sensor, [0.0]), "TangoPlus", False)
    assert np.isnan(found.standard).all()


def test_what_the_ends_of_ranges_leave_unlocated_moves_no_interval(evaluated, monkeypatch):
    """`stiff-dome`, most of whose ranges end at the gauge: 2e-5 of travel would leave 1 % in an interval."""
    evaluation = evaluated("stiff-dome", model="atlas")
    scene, pressures = evaluation.scene, [state.driving_pressure for state in evaluation.prediction.states]
    known = list(evaluation.resins.values())
    batch, sources, _ = spread(
        evaluation.sensor, pressures, scene.membrane_material, known, scene.printer, evaluation.prediction.model
    )
    found = propagate(batch, sources).expanded
    monkeypatch.setattr(respond_module, "_WITHIN", 1e-13)
    monkeypatch.setattr(respond_module, "_ROUNDS", 60)
    exact = propagate(batch, sources).expanded
    wide = exact > 1e-3
    assert wide.sum() > 8
    np.testing.assert_allclose(found[wide], exact[wide], rtol=1e-4)
