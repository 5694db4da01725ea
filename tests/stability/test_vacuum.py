"""Failure: the cavity sucked in. The wall buckles; load control falls off the branch and cannot say where it ended.

Classical theory (Zoelly 1915) lets a thin complete sphere buckle at p = 2 E/sqrt(3 (1 - nu^2)) (t/R)^2. A clamped thin
hemisphere is held at its base and must come out close to it. The solver is axisymmetric: it sees this load, not the
dimples that imperfections cause far below it.
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.elements import Regulator
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, UnreachableLoadError
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.plain import newton
from tests.stability.truth import Study, free_unbalance

MU, R0 = 0.17, 9.25
SOLID = SolidModel(dome(Hemisphere(R0, 1.5)), neo_hookean(MU))


def test_plain_newton_falls_off_the_sucked_branch_and_ours_follows_it():
    pressure = -0.020
    assert newton(SolidScene(SOLID, Regulator(pressure / MU), None), SOLID.rest).end == "inside out"
    ours = state_at(SOLID, pressure)
    assert ours.pressure == pytest.approx(pressure, rel=1e-12) and ours.stable
    assert free_unbalance(SOLID, ours) <= 1.0
    assert ours.volume < SOLID.cavity.volume(SOLID.rest) * R0**3


def test_every_state_on_the_way_down_balances_and_the_limit_is_said():
    run = inflate(SOLID, to_pressure=-0.06)
    assert max(free_unbalance(SOLID, s) for s in run.states) <= 1.0
    assert (np.diff(run.volume[:5]) < 0).all()
    with pytest.raises(UnreachableLoadError) as caught:
        state_at(SOLID, -0.06)
    assert caught.value.limit == pytest.approx(-0.02733, rel=2e-3)
    # Just inside that load there is a state, just outside plain Newton finds none from it.
    inside = state_at(SOLID, 0.99 * caught.value.limit)
    assert inside.stable
    fate = newton(SolidScene(SOLID, Regulator(1.02 * caught.value.limit / MU), None), inside.unit.x)
    assert fate.end in ("inside out", "unfinished")


@pytest.mark.parametrize("ratio", [0.01, 0.02])
def test_a_thin_dome_buckles_at_the_classical_load(ratio):
    nu = 0.49
    solid = SolidModel(dome(Hemisphere(1.0, ratio)), neo_hookean(1.0, nu))
    with pytest.raises(UnreachableLoadError) as caught:
        state_at(solid, -1.0)
    young, middle = 2.0 * (1.0 + nu), 1.0 + 0.5 * ratio
    classical = 2.0 * young * (ratio / middle) ** 2 / np.sqrt(3.0 * (1.0 - nu**2))
    assert -caught.value.limit == pytest.approx(classical, rel=0.04)


def test_the_sucked_dome_leaves_the_plate_and_says_so():
    ours = Study.of(SOLID, state_at(SOLID, -0.005), PressSettings(0.5 * R0, 10))
    event = next(e for e in ours.found.events if e.kind == "separation")
    assert ours.found.complete and ours.unbalance() <= 1.0 and ours.gas_error() < 1e-9
    # True: behind the event the wall's apex hangs below the plate by more than the contact lets through.
    gaps = [(s.indentation, s.inside_gap) for s in ours.found.path]
    assert all(gap < 0.015 for at, gap in gaps if at < event.indentation)
    assert max(gap for at, gap in gaps if at > event.indentation) > 0.015


def test_no_air_at_all_leaves_the_wall_alone():
    ours = Study.of(SOLID, state_at(SOLID, 0.0), PressSettings(0.5 * R0, 5, ambient=0.0))
    assert ours.found.complete and ours.unbalance() <= 1.0
    assert np.abs(ours.found.column("pressure")).max() < 1e-12
    force = ours.found.column("force")
    sealed = Study.of(SOLID, state_at(SOLID, 0.0), PressSettings(0.5 * R0, 5)).found.column("force")
    assert (np.diff(force) > 0).all() and (force[1:] < sealed[1:]).all()
    assert force[-1] < 0.4 * sealed[-1]
