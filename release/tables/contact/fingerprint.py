"""Whether the shipped table still matches the model: its answers in a few presses."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.table import PlaceTableRecipe
from release.tables.contact.press import DomeState, pressed

_STATE = DomeState(0.15, 0.25, 0.12)
_SCENES = ((0.0, 0.0, False), (1.0, 0.0, False), (1.0, 0.22, False), (1.0, 0.22, True))
"""Curvature, lean, and whether it is an edge."""
_CELLS = 12
_LEVELS = (0.15, 0.3)


def model_answers(recipe: PlaceTableRecipe) -> Array:
    """Force and pressure rise of a plate, a central ball, one off the axis and an edge there at two travels, (16,).

    They follow from the model's behaviour and not from its text; a test compares them with the shipped ones.
    """
    curves = [pressed(recipe, _STATE, bend, lean, lying=lying, cells=_CELLS) for bend, lean, lying in _SCENES]
    return np.array([np.interp(_LEVELS, c.travel, values) for c in curves for values in (c.force, c.rise)]).ravel()
