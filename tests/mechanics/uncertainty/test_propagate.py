"""Combination: variances add, shares sum to one, batches do not mix, Table S1 is covered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.propagate import COVERAGE, propagate, propagate_groups
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from tests.mechanics.test_contact import PAPER
from tests.mechanics.uncertainty.designs import TEN, batch_for, budget_for, materials


def test_the_limit_pressure_adds_up_by_hand(library):
    """It is mu f(t0/R0): its variance is the modulus' and f's elasticity squared times those of wall and radius."""
    found = budget_for(library, batch_of(PAPER, [0.0]), "TangoPlus", True)
    source = {s.name: s.standard[0] for s in found.sources}
    limit = FIGURES.index("limit_pressure_kPa")
    slope = found.derivatives.elasticities[1, limit, 0]
    moduli = sum(source[n] ** 2 for n in ("published modulus", "modulus between prints", "ageing of the modulus"))
    size = slope**2 * (source["wall thickness"] ** 2 + source["inner radius"] ** 2)
    numerical = (0.002 / np.sqrt(3)) ** 2
    assert found.standard[limit, 0] ** 2 == pytest.approx(moduli + size + numerical, rel=1e-3)
    assert found.expanded[limit, 0] == pytest.approx(COVERAGE * found.standard[limit, 0])


@settings(max_examples=15)
@given(
    st.sampled_from(["TangoPlus", "FLX9940", "FLX9960", "FLX9985", "Agilus30"]),
    st.floats(1.0, 50.0),
    st.floats(0.06, 0.35),
    st.floats(0.0, 0.02),
    st.floats(0.0, 5000.0),
    st.booleans(),
)
def test_shares_sum_to_one_wherever_there_is_an_uncertainty(library, resin, radius, wall, pressure, dead, near):
    sensor = material_sensor(materials(library)[resin]).replace(
        inner_radius=radius, wall_thickness=wall * radius, dead_volume=dead, depth=0.5 * radius, plate_radius=2 * radius
    )
    found = budget_for(library, batch_of(sensor, [pressure]), resin, near)
    some = found.variances.sum(axis=0) > 1e-10
    assert found.shares.sum(axis=0)[some] == pytest.approx(1.0)
    assert (found.shares >= 0).all()
    known = np.isfinite(found.derivatives.logs[SENSITIVITY])
    assert (found.standard[SENSITIVITY][known] > 0.05).all(), "no model of this kind is better than that"


def test_twice_the_source_is_twice_the_uncertainty(library):
    batch = batch_of(PAPER, [0.0])
    one = budget_for(library, batch, "TangoPlus", False, aged=False)
    two = propagate(batch, [replace(s, standard=2 * s.standard) for s in one.sources])
    # Of some inputs the derivative is over the spread, which is twice as wide.
    assert two.linear == pytest.approx(2 * one.linear, rel=1e-3)


def test_a_batch_is_its_sensors_one_by_one(library):
    batch = replace(
        batch_of(material_sensor(materials(library)["TangoPlus"]), [0.0, 0.01, 0.02]),
        wall_thickness=np.array([1.2, 1.5, 2.0]),
    )
    flags = np.array([True, False, True])
    together = budget_for(library, batch, "TangoPlus", flags)
    for row in range(3):
        alone = budget_for(library, batch.take(slice(row, row + 1)), "TangoPlus", bool(flags[row]))
        assert together.standard[:, row] == pytest.approx(alone.standard[:, 0], rel=1e-6, abs=1e-9)


def test_table_s1_lies_within_the_expanded_uncertainty(library):
    """As if the paper's sensors were far from themselves: moduli count in part twice, so the deviations come out below
    one standard uncertainty, but not by an order of magnitude."""
    scores = []
    for name, material in materials(library).items():
        errors = model_errors(material, materials(library).values())
        if not errors.resin_errors or name == "FLX9995":
            continue
        batch = batch_of(material_sensor(material), [0.0, 0.022])
        found = budget_for(library, batch, name, False, aged=False)
        scores += (np.log1p(errors.resin_errors) / found.standard[SENSITIVITY]).tolist()
    assert len(scores) == 12
    assert np.abs(scores).max() < COVERAGE
    assert 0.4 < np.sqrt(np.mean(np.square(scores))) < 1.0


def test_few_degrees_of_freedom_are_told(library):
    """Two cells and a Welch-Satterthwaite mean of them with what is known better."""
    material = materials(library)["FLX9995"]
    found = budget_for(library, batch_of(material_sensor(material), [0.0]), "FLX9995", True)
    assert 2.0 <= found.freedom[SENSITIVITY, 0] < 10.0


def test_groups_in_one_pass_are_the_groups_one_by_one(library):
    """Ends of ranges close in sensor by sensor: figures do not depend on what else is in the pass."""
    groups = []
    for case in TEN[:5]:
        batch = batch_for(library, case)
        batch = replace(batch, depth=0.74 * batch.inner_radius)
        groups.append((batch, list(budget_for(library, batch, case.resin, case.near_paper).sources)))
    for (batch, sources), budget in zip(groups, propagate_groups(groups), strict=True):
        alone = propagate(batch, sources)
        assert budget.derivatives.logs == pytest.approx(alone.derivatives.logs, rel=1e-11, abs=1e-11, nan_ok=True)
        assert budget.expanded == pytest.approx(alone.expanded, rel=1e-10, nan_ok=True)
