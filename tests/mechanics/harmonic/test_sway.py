"""The sway of the paper's sensor: where a press with a small imperfection gives way sideways."""

import numpy as np
import pytest

from pneutouch.mechanics.harmonic.press import OffAxisPress
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

R0, OUTER, OFFSET = 9.25, 10.75, 0.01
DEPTH, STEPS = 6.94, 140


@pytest.mark.slow
def test_a_plate_that_touches_0_01_mm_off_the_axis_shows_the_sway_of_the_check_of_modes() -> None:
    solid = SolidModel(dome(Hemisphere(R0, OUTER - R0)), neo_hookean(0.17))
    free = state_at(solid, 0.0)
    checked = indent(solid, free, PressSettings(DEPTH, 14, waves=8))
    (sway,) = (event.indentation for event in checked.events if event.kind == "sway")
    # An endless plate has no place: it touches off the axis where it leans.
    tilt = np.arcsin(OFFSET / OUTER)
    plate = PlacedObject(Plate(0.0, np.inf, 1.0), 0.0, tilt)
    last = int(STEPS * sway / DEPTH)
    press = OffAxisPress(solid, free, PressSettings(DEPTH * last / STEPS, last), plate, StrainProbe(solid))
    path = press.run(2)
    assert path.complete
    depth = path.column("indentation")[1:]
    pole = solid.mesh.axis[np.argmax(solid.rest[solid.mesh.axis, 1])]
    moved = np.array([state.positions[pole, 2] for state in path.states[1:]])
    stiffness = -path.column("sideways")[1:] / moved
    # It falls in steps as points come into contact, and to zero at the sway: the steepest fall past half way leads there.
    late = np.flatnonzero(depth[:-1] > 0.5 * DEPTH)
    fall = (np.diff(stiffness) / np.diff(depth))[late]
    k = late[fall.argmin()] + 1
    assert depth[k] - stiffness[k] / fall.min() == pytest.approx(sway, rel=0.02)
    assert stiffness[k] < 0.5 * stiffness[: k // 2].max()
