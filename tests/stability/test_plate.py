"""Failures under the plate: chattering of an active set, Newton without line search, steps too large, thin walls.

Known from public codes: in MOOSE issue 10950 node-face contact "ping-pongs" between two sets; felupe issue 800 finds
the first touch of a rigid plane very unstable. Remedies kept here: the plate's height is prescribed, contact is a
stiff potential met inside the quadratic model, and every step must lower the energy.
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, minimise
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.plain import active_set, newton
from tests.stability.truth import Study

R0 = 9.25


def study(ratio=1.5 / R0, mu=0.17, pressure=0.0, depth=1.0, steps=1, mesh=None, **options):
    solid = SolidModel(mesh or dome(Hemisphere(R0, ratio * R0)), neo_hookean(mu))
    return Study.of(solid, state_at(solid, pressure), PressSettings(depth, steps, plate_diameter=None, **options))


@pytest.mark.parametrize(("ratio", "pressure"), [(0.04, 0.0), (0.02, 0.3 * 1.5 * 0.17 * 0.02)])
def test_an_active_set_cycles_and_ours_converges(ratio, pressure):
    # Four-node cells, on which node-wise contact is at its best; the first quarter of a millimetre.
    ours = study(ratio, pressure=pressure, depth=0.25, mesh=dome(Hemisphere(R0, ratio * R0), order=1))
    scene = ours.scene(0.25)
    fate = active_set(ours.solid, scene.supply, scene.plate.height, ours.free.unit.x)
    assert fate.end == "cycles" and fate.period >= 2
    assert ours.found.complete and ours.unbalance() <= 1.0
    fine = study(ratio, pressure=pressure, depth=0.25, mesh=dome(Hemisphere(R0, ratio * R0), arc=96, through=2))
    assert ours.found.states[-1].force == pytest.approx(fine.found.states[-1].force, rel=0.12)
    nine = study(ratio, pressure=pressure, depth=0.25)
    assert nine.found.states[-1].force == pytest.approx(fine.found.states[-1].force, rel=0.03)


@pytest.mark.parametrize(("pressure", "depth"), [(0.0, 0.5), (0.0, 1.0), (0.022, 1.0), (0.022, 2.0)])
def test_newton_without_line_search_diverges_on_the_papers_sensor(pressure, depth):
    ours = study(pressure=pressure, depth=depth)
    start = ours.free.unit.x
    assert newton(ours.scene(depth), start).end == "inside out"
    # Ours takes the same step in one solve, to the state that small steps reach.
    one = minimise(ours.scene(depth), start)
    assert not isinstance(one, NewtonFailure) and one.iterations < 15
    small = study(pressure=pressure, depth=depth, steps=20).found.states[-1].positions / R0
    assert np.abs(one.state.x - small).max() < 1e-8


def test_where_plain_newton_converges_it_finds_the_same_state():
    ours = study(pressure=0.022, depth=0.25)
    fate = newton(ours.scene(0.25), ours.free.unit.x)
    assert fate.end == "converged"
    assert np.abs(fate.x - ours.found.states[-1].positions / R0).max() < 1e-8
    assert fate.iterations > minimise(ours.scene(0.25), ours.free.unit.x).iterations


@pytest.mark.parametrize(("mu", "pressure"), [(0.17, 0.0), (0.17, 0.022), (0.91, 0.0)])
def test_one_step_as_large_as_the_whole_depth_equals_many(mu, pressure):
    depth = 0.5 * R0
    one, many = (study(mu=mu, pressure=pressure, depth=depth, steps=n) for n in (1, 37))
    assert newton(one.scene(depth), one.free.unit.x).end == "inside out"
    assert one.found.complete and many.found.complete
    a, b = one.found.states[-1], many.found.states[-1]
    assert (a.force, a.pressure) == pytest.approx((b.force, b.pressure), rel=1e-7)
    assert np.abs(a.positions - b.positions).max() < 1e-7 * R0
    assert max(one.unbalance(), many.unbalance()) <= 1.0


def test_plate_onto_an_uninflated_dome_with_a_thin_wall():
    depth = 0.5 * R0
    ours = study(0.02, depth=depth, steps=10)
    # A quarter of a millimetre is already too much for plain Newton.
    assert newton(ours.scene(0.25), ours.free.unit.x).end == "inside out"
    assert ours.found.complete and ours.found.events == []
    assert ours.unbalance() <= 1.0 and ours.gas_error() < 1e-9
    assert ours.softest(ours.found.states[-1]) > 0.0
    assert (np.diff(ours.found.column("force")) > 0).all()


@pytest.mark.slow
def test_the_thin_uninflated_dome_meets_a_refined_mesh():
    depth = 0.5 * R0
    ours = study(0.02, depth=depth, steps=10).found
    fine = study(0.02, depth=depth, steps=10, mesh=dome(Hemisphere(R0, 0.02 * R0), arc=120, through=2)).found
    assert fine.complete
    assert ours.states[-1].force == pytest.approx(fine.states[-1].force, rel=5e-3)
    slopes = [np.polyfit(run.column("force"), run.column("rise"), 1)[0] for run in (ours, fine)]
    assert slopes[0] == pytest.approx(slopes[1], rel=5e-3)
