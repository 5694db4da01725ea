"""The same sensor in every resin: the curves that show what the offline parameter does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.limits import limits
from pneutouch.meridian.segments import Array
from pneutouch.spec.material import Material
from pneutouch.units import KPA

_POINTS = 12
_MARGIN = 0.95
"""Curves stop at this share of a resin's own limit."""


def resin_curves(
    sensor: Sensor, materials: dict[str, Material], highest: float, model: str, closure: str
) -> dict[str, tuple[Array, Array]]:
    """Sensitivity (kPa/N) over driving pressure (kPa), from 0 to ``highest`` (MPa), by resin title.

    Each curve stops short of its own resin's limit point.
    """
    curves = {}
    for material in materials.values():
        if material.kind != "elastomer" or material.shear_modulus_MPa is None:
            continue
        variant = replace(sensor, shear_modulus=material.shear_modulus_MPa.nominal)
        top = min(highest, _MARGIN * limits(variant).limit_point)
        pressures = np.linspace(0.0, top, _POINTS)
        states = predict("", variant, pressures.tolist(), model=model, closure=closure).states
        values = [(p / KPA, s.figures.sensitivity) for p, s in zip(pressures, states, strict=True) if s.figures]
        if values:
            x, y = zip(*values, strict=True)
            curves[material.title] = (np.array(x), np.array(y))
    return curves
