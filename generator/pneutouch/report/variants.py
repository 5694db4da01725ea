"""The same sensor in every resin: the curves that show what the offline parameter does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pneutouch.errors import ComputationError
from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.limits import limit_point
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.meridian.segments import Array
from pneutouch.spec.material import Material
from pneutouch.units import KPA

_POINTS = {"membrane": 12, "solid": 4}
"""Driving pressures a curve is computed at: the solid costs a tenth of a second each."""

_MARGIN = 0.95
"""Curves stop at this share of a resin's own limit."""

_LIMIT_SHARE = {"membrane": 1.0, "solid": 0.8}
"""A safe share of the membrane's limit pressure: thick compressible walls reach theirs earlier."""


def in_resin(sensor: Sensor, material: Material) -> Sensor:
    """The same sensor in another resin, with that resin's law and break strain."""
    resin = material_sensor(material)
    return replace(
        sensor, shear_modulus=resin.shear_modulus, poisson_ratio=resin.poisson_ratio, law=resin.law,
        break_stretch=resin.break_stretch,
    )  # fmt: skip


def resin_curves(
    sensor: Sensor, materials: dict[str, Material], highest: float, model: str, closure: str | None
) -> dict[str, tuple[Array, Array]]:
    """Sensitivity (kPa/N) over driving pressure (kPa), from 0 to ``highest`` (MPa), by resin title.

    Each curve stops short of its own resin's limit point.
    """
    curves = {}
    for material in materials.values():
        if material.kind != "elastomer":
            continue
        variant = in_resin(sensor, material)
        top = min(highest, _MARGIN * _LIMIT_SHARE[model] * limit_point(variant).driving_pressure)
        pressures = np.linspace(0.0, top, _POINTS[model])
        try:
            states = predict("", variant, pressures.tolist(), model=model, closure=closure or "variational").states
        except ComputationError:
            continue  # a resin that this geometry cannot be solved in has no curve; it must not stop the sheet
        values = [(p / KPA, s.figures.sensitivity) for p, s in zip(pressures, states, strict=True) if s.figures]
        if values:
            x, y = zip(*values, strict=True)
            curves[material.title] = (np.array(x), np.array(y))
    return curves
