"""Failure: tolerances with a unit. What is tight for a sensor of 10 mm is loose at 0.1 mm and unreachable at 1 m.

Nothing in the equations has a size: radius and modulus only scale them, so the dimensionless answer must not move.
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
from pneutouch.mechanics.solid.newton import SolidScene
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.plain import below, newton
from tests.stability.truth import Study

PRESSURE, AMBIENT = 0.010 / 0.17, 0.101325 / 0.17
SIZES = [(0.1, 1e-3), (0.1, 1e3), (9.25, 1e-3), (9.25, 1e3), (1000.0, 1e-3), (1000.0, 1e3)]


def sensor(radius, mu):
    return SolidModel(dome(Hemisphere(radius, radius * 1.5 / 9.25)), neo_hookean(mu))


def figures(radius, mu):
    """Limit, inflated height and pressed curve, all dimensionless."""
    solid = sensor(radius, mu)
    run = inflate(solid, past_limit=1.0)
    free = state_at(solid, PRESSURE * mu, run)
    press = PressSettings(
        0.5 * radius,
        5,
        plate_diameter=30 / 9.25 * radius,
        ambient=AMBIENT * mu,
        dead_volume=0.5 * radius**3,
        gauge_range=np.inf,
    )
    study = Study.of(solid, free, press)
    assert study.found.complete and study.unbalance() <= 1.0
    curve = study.found
    return np.concatenate(
        [
            [run.limit.pressure / mu, free.inner_apex / radius],
            curve.column("force")[1:] / mu / radius**2,
            curve.column("rise")[1:] / mu,
            curve.column("contact_radius")[1:] / radius,
        ]
    )


def test_an_absolute_tolerance_accepts_the_start_or_is_never_met():
    """1e-6 N serves the paper's sensor; the small one is returned uninflated, the large one never ends."""
    ends = {}
    for radius, mu in ((0.1, 1e-3), (9.25, 0.17), (1000.0, 1e3)):
        solid = sensor(radius, mu)
        fate = newton(SolidScene(solid, Regulator(PRESSURE), None), solid.rest, below(1e-6, solid))
        ends[radius] = fate.end, fate.x[solid.mesh.inner_apex, 1]
    truth = state_at(sensor(1.0, 1.0), PRESSURE).inner_apex
    assert ends[9.25] == ("converged", pytest.approx(truth, rel=1e-6)) and truth > 1.05
    assert ends[0.1] == ("converged", 1.0)
    assert ends[1000.0][0] == "unfinished"


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "mu"), SIZES)
def test_radii_from_a_tenth_of_a_millimetre_to_a_metre_and_moduli_from_a_kilopascal_to_a_gigapascal(radius, mu):
    assert figures(radius, mu) == pytest.approx(figures(9.25, 0.17), rel=1e-9)
