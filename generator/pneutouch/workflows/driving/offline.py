"""Changes of a design whose driving pressure alone does not reach a required figure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.errors import PneutouchError
from pneutouch.mechanics import predict
from pneutouch.units import ML
from pneutouch.workflows.driving.reach import BUDGET_KEYS, ReachCurves, figure_of

_FIELDS = {
    "wall_thickness": ("membrane.wall_thickness_mm", 1.0),
    "inner_radius": ("membrane.inner_radius_mm", 1.0),
    "shear_modulus": ("shear modulus of the resin, MPa", 1.0),
    "dead_volume": ("pneumatics.dead_volume_mL", ML),
}
"""Inputs of the model that a design can change: the user's name for each, and its unit in that of the model."""

_FARTHEST = 2.0
"""Greatest factor on an input for which its derivative is followed: our choice."""


@dataclass(frozen=True)
class OfflineChange:
    """A change of one input: its name, value before and after in the unit of the name, and the figure that results."""

    what: str
    before: float
    after: float
    predicted: float


def offline_changes(curves: ReachCurves, figure: str, value: float) -> list[OfflineChange]:
    """Changes of one input each by which the figure comes nearer to the value, least change first.

    The input is moved by the elasticity of the figure at the nearest state; ``predicted`` is what the model then has.
    """
    values = curves.values(figure)
    if np.isnan(values).all():
        return []
    nearest = curves.states[int(np.nanargmin(np.abs(np.log(values / value))))]
    best = figure_of(nearest, figure)
    _, entry = min(curves.budgets, key=lambda known: abs(known[0] - nearest.driving_pressure))
    elasticities = entry.get("elasticities", {}).get(BUDGET_KEYS.get(figure, figure), {})
    changes = []
    for name, (what, unit) in _FIELDS.items():
        slope, before = elasticities.get(name, 0.0), _input(curves, name)
        if abs(slope) * np.log(_FARTHEST) < abs(np.log(value / best)) or before <= 0.0:
            continue
        after = before * (value / best) ** (1.0 / slope)
        predicted = _with(curves, name, after, nearest.driving_pressure, figure)
        if predicted is not None and abs(np.log(predicted / value)) < abs(np.log(best / value)):
            changes.append(OfflineChange(what, before / unit, after / unit, predicted))
    return sorted(changes, key=lambda change: abs(np.log(change.after / change.before)))


def _input(curves: ReachCurves, name: str) -> float:
    sensor = curves.evaluation.sensor
    parts = (sensor.dome, sensor.wall, sensor.gas)
    return float(next(getattr(part, name) for part in parts if hasattr(part, name)))


def _with(curves: ReachCurves, name: str, value: float, pressure: float, figure: str) -> float | None:
    """The figure with one input changed, at a driving pressure in MPa; None if the model has none."""
    sensor = curves.evaluation.sensor.replace(**{name: value})
    try:
        states = predict("changed", sensor, [pressure], model=curves.model).states
    except PneutouchError:
        return None
    changed = figure_of(states[0], figure)
    return None if np.isnan(changed) else changed
