"""Failure: load control at the limit point, where the tangent is singular and no higher pressure has an equilibrium.

Known from public codes: the balloon example of SolidMechanicsCoupledTheories/FEniCSx_codes (thick sphere 10 to 11 mm,
Arruda-Boyce) is ramped to 35 kPa and its stored output ends at 33.95 kPa, just under its exact limit of 34.27 kPa;
MOOSE issue 33523 reports the same of Newton. The remedy is to drive by volume, which rises through the
limit.
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.elements import Regulator
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, UnreachableLoadError
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.plain import load_control, newton
from tests.stability.truth import free_unbalance

MU = 0.17
SOLID = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(MU))
KPA = 1e-3 / MU


def test_load_control_stops_at_the_limit_and_volume_control_passes_it():
    plain = load_control(SOLID, first=KPA, smallest=1e-4 * KPA)
    ours = inflate(SOLID, past_limit=1.6)
    limit = ours.limit
    volumes = np.array([SOLID.cavity.volume(x) for _, x in plain]) * SOLID.length**3
    # The plain path creeps up to the limit with a thousandth of its first step and sees nothing behind it.
    assert plain[-1][0] * MU == pytest.approx(limit.pressure, rel=1e-4)
    assert volumes.max() < limit.volume
    # Ours goes on to 1.6 times the volume at a falling pressure; every state balances.
    beyond = [s for s in ours.states if s.volume > 1.001 * limit.volume]
    assert ours.volume[-1] > 1.6 * limit.volume
    assert len(beyond) >= 3 and (np.diff([limit.pressure, *(s.pressure for s in beyond)]) < 0).all()
    assert ours.volume[-1] > 1.5 * volumes.max()
    assert max(free_unbalance(SOLID, s) for s in ours.states) <= 1.0


@pytest.mark.parametrize("share", [1.001, 1.01, 1.2])
def test_newton_beyond_the_limit_turns_the_wall_inside_out_and_ours_says_the_limit(share):
    limit = inflate(SOLID, past_limit=1.0).limit
    near = state_at(SOLID, 0.99 * limit.pressure)
    fate = newton(SolidScene(SOLID, Regulator(share * limit.pressure / MU), None), near.unit.x)
    assert fate.end in ("inside out", "unfinished")
    with pytest.raises(UnreachableLoadError) as caught:
        state_at(SOLID, share * limit.pressure)
    assert caught.value.limit == pytest.approx(0.039592, rel=1e-4)


def test_a_large_load_step_fails_far_below_the_limit_where_ours_arrives():
    pressure = 0.030
    assert newton(SolidScene(SOLID, Regulator(pressure / MU), None), SOLID.rest).end == "inside out"
    ours = state_at(SOLID, pressure)
    assert ours.stable and free_unbalance(SOLID, ours) <= 1.0
    # The plain method in thirty small steps agrees: the same equations, another way through them.
    small = load_control(SOLID, first=KPA, smallest=0.9 * KPA)
    apex = {round(p / KPA): x[SOLID.mesh.inner_apex, 1] * SOLID.length for p, x in small}
    assert ours.inner_apex == pytest.approx(apex[30], rel=1e-8)
