"""Whether the shipped atlas still matches the solid: the solid's answers at a few states, as a fingerprint."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict

import numpy as np

from pneutouch.mechanics.atlas.recipe import RECIPE, AtlasRecipe
from pneutouch.mechanics.atlas.surveyed import stretch_by_zone
from release.tables.atlas.sampler import AtlasSampler

_WALLS = (0.07, 0.16, 0.3)
_ROWS = (0, 12)
_DEPTH, _STEP = 0.4, 0.025
"""Of the presses at held volume: the solid takes such a step whole, so that the answers follow from the equations and
not from where a step was cut."""
_AMBIENT = 0.45
"""Gas of the press that goes to the greatest depth, in mu: there the wall lies on its base."""
_DIGITS = 6
_HOLDING = ("stiffest", "degree", "volume_cells", "volume_stretch", "depth_cells")


def survey_fingerprint(recipe: AtlasRecipe) -> str:
    """Distinguishes recipes that solve other states; how the answers are stored does not count."""
    content = {key: value for key, value in asdict(recipe).items() if key not in _HOLDING}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]


def solid_fingerprint() -> str:
    """The solid's answers for three walls, two volumes and one depth, and at the end of a press, to six digits.

    It follows from the solid's behaviour and not from its text: rewriting the solid without changing its answers
    leaves the atlas fresh.
    """
    answers = []
    for wall in _WALLS:
        sampler = AtlasSampler(wall, RECIPE)
        answers += [sampler.limit.volume, sampler.limit.pressure]
        for row in _ROWS:
            start = here = sampler.touching(sampler.free[row])
            for depth in np.arange(_STEP, _DEPTH + 1e-9, _STEP):
                equilibrium = sampler.step(here, start.state.volume, start.height - depth)
                assert equilibrium is not None
                here = equilibrium
            answers += [here.state.filling.pressure, here.force, here.energy]
            answers += stretch_by_zone(sampler.probe, here.state.x).tolist()
        last = sampler.pressed(0.0, _AMBIENT).path[-1]
        answers += [last.state.filling.pressure, last.force, last.energy]
    return hashlib.sha256(" ".join(f"{x:.{_DIGITS}g}" for x in answers).encode()).hexdigest()[:16]
