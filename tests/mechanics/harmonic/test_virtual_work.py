"""Forces and moments off the axis against differences of the energy of equilibria, with the gas shut in."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.harmonic.press import OffAxisPress, OffAxisState
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings, shut_in
from pneutouch.mechanics.solid.indenter import RigidObject, ball, cylinder
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, minimise
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

RADIUS = 9.25
ORDER = 2


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


class _Pressed:
    """The end of a press, and the energies of equilibria with the object a little elsewhere at the same gas."""

    def __init__(self, body: RigidObject | None, offset: float, tilt: float, depth: float) -> None:
        solid, free = _dome()
        press = PressSettings(depth=depth, steps=3, body=body)
        shape = first_touch(solid, free, body, 30.0).body
        self.placed: LyingObject | PlacedObject
        if body is not None and body.lying:
            self.placed = LyingObject(shape, offset / RADIUS)
        else:
            self.placed = PlacedObject(shape, offset / RADIUS, tilt)
        self.press = OffAxisPress(solid, free, press, self.placed, StrainProbe(solid))
        self.end: OffAxisState = self.press.run(ORDER).states[-1]
        self.height = self.press.surface.height - self.end.indentation / RADIUS
        self.model, self.gas = HarmonicModel(solid, ORDER), shut_in(solid, free, press)

    def energy(self, offset: float = 0.0, tilt: float = 0.0, up: float = 0.0) -> float:
        """Energy of wall, gas and contact (N mm) with the object moved by these (mm, rad, mm)."""
        placed = replace(self.placed, offset=self.placed.offset + offset / RADIUS)
        if isinstance(placed, PlacedObject):
            placed = replace(placed, tilt=placed.tilt + tilt)
        scene = SolidScene(self.model, self.gas, placed.at(self.height + up / RADIUS))
        solved = minimise(scene, self.end.positions / RADIUS)
        assert not isinstance(solved, NewtonFailure)
        return solved.state.energy * self.model.mu * RADIUS**3

    def rate(self, by: str, step: float = 1e-3) -> float:
        """Derivative of the energy by one of the motions."""
        return (self.energy(**{by: step}) - self.energy(**{by: -step})) / (2.0 * step)


@pytest.mark.parametrize(
    ("body", "offset", "tilt"),
    [(ball(6.0), 3.0, 0.0), (None, 1.0, np.radians(6.0)), (cylinder(6.0), 2.0, 0.0)],
    ids=["ball", "plate", "cylinder"],
)
def test_force_and_sideways_force_are_the_slopes_of_the_energy(
    body: RigidObject | None, offset: float, tilt: float
) -> None:
    pressed = _Pressed(body, offset, tilt, 2.0)
    assert -pressed.rate("up") == pytest.approx(pressed.end.force, rel=1e-4)
    assert -pressed.rate("offset") == pytest.approx(pressed.end.sideways, rel=1e-4)


def test_the_moment_is_the_slope_of_the_energy_by_the_tilt() -> None:
    pressed = _Pressed(None, 1.0, np.radians(6.0), 2.0)
    end, middle = pressed.end, pressed.placed.offset * RADIUS
    # The plate turns about its middle and rises towards x: backwards about the y axis.
    about_middle = end.moment - (pressed.height * RADIUS * end.sideways - middle * end.force)
    assert pressed.rate("tilt", 1e-4) == pytest.approx(about_middle, rel=1e-4)
