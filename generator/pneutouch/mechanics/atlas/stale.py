"""Whether the shipped atlas still speaks for the solid: the solid's answers at a few states, as a fingerprint."""

from __future__ import annotations

import hashlib

import numpy as np

from pneutouch.mechanics.atlas.recipe import RECIPE
from pneutouch.mechanics.atlas.surveyor import Surveyor

_WALLS = (0.07, 0.16, 0.3)
_ROWS = (0, 12)
_DEPTH = 0.4
_DIGITS = 6


def solid_fingerprint() -> str:
    """What the solid says of three walls, two volumes and one depth, to six digits.

    It follows from the solid's behaviour and not from its text: rewriting the solid without changing its answers
    leaves the atlas fresh.
    """
    said = []
    for wall in _WALLS:
        surveyor = Surveyor(wall, RECIPE)
        said += [surveyor.limit.volume, surveyor.limit.pressure]
        for row in _ROWS:
            start = here = surveyor.touching(surveyor.free[row])
            for depth in np.arange(0.05, _DEPTH + 1e-9, 0.05):
                found = surveyor.step(here, start.state.volume, start.height - depth)
                assert found is not None
                here = found
            said += [here.state.filling.pressure, here.force, here.energy]
            said += surveyor.probe.stretch_by_zone(here.state.x).tolist()
    return hashlib.sha256(" ".join(f"{x:.{_DIGITS}g}" for x in said).encode()).hexdigest()[:16]
