"""Where the atlas is furthest from the solid, the solid is as far from itself on a finer mesh."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.atlas import Case

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.solid import curve_between
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

pytestmark = pytest.mark.slow

THIN_DEEP_AND_WITHOUT_PRESSURE = [
    Case(0.08028308, 0.0, 0.07860522, 1.58331124, 0.73951777),
    Case(0.08296570, 0.0, 0.05298905, 0.0, 0.72772881),
]


def force(case: Case, arc: int | None, through: int | None) -> np.ndarray:
    solid = SolidModel(
        dome(Hemisphere(1.0, case.wall), arc=arc, through=through), neo_hookean(1.0, 0.49), base=RigidBase()
    )
    run = inflate(solid, past_limit=1.0)
    press = PressSettings(case.depth, 14, None, case.ambient, case.dead, np.inf, np.inf)
    return curve_between(indent(solid, state_at(solid, 0.0, run), press).path, np.linspace(0.0, case.depth, 15))[0]


@pytest.mark.parametrize("case", THIN_DEEP_AND_WITHOUT_PRESSURE, ids=lambda case: f"{case.wall:.3f}")
def test_the_default_mesh_itself_is_wavy_in_the_last_step(case, capsys):
    coarse, fine = force(case, None, None), force(case, 96, 4)
    off = float(np.abs(coarse - fine).max() / fine.max())
    said = f"the solid at its default against 96 x 4 cells, t0/R0 {case.wall:.3f}: force off by {off:.2%} of full scale"
    with capsys.disabled():
        print(f"\n{said}")  # noqa: T201
    assert 0.005 < off < 0.015
