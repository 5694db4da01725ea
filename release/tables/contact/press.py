"""Presses of one dome, nondimensional, and the force that an object takes for a reading."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.anywhere.table import PlaceTableRecipe
from pneutouch.mechanics.harmonic.press import OffAxisPress
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject, ProfiledObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.solid import KINDS
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indenter import RigidObject, ball, edge
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, first_touch, inflate, state_at
from pneutouch.mechanics.solid.mesh import CELLS_PER_RADIUS, arc_cells, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Indenter
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

_AMBIENT = 0.05
"""Least ambient pressure in mu; a softer gas is one with more volume behind the cavity."""
_WIDE = 30.0
"""Diameter of the plate in R0: its edge stays away from the dome."""


class DomeState(NamedTuple):
    """A dome before contact: wall ratio, share of the limit pressure, and gas stiffness in mu/R0^3."""

    wall: float
    share: float
    gas: float


class ReadingCurve(NamedTuple):
    """A press: travel, pressure rise and force, (n,) each, nondimensional; ``end`` is the travel at the event that ends
    its range, or the depth. Beyond it the curve is that of the model."""

    travel: Array
    rise: Array
    force: Array
    end: float


@lru_cache(maxsize=8)
def _inflated(wall: float, cells: int, poisson_ratio: float) -> tuple[StrainProbe, Inflation]:
    solid = SolidModel(dome(Hemisphere(1.0, wall), arc=cells), neo_hookean(1.0, poisson_ratio), base=RigidBase())
    run = inflate(solid, past_limit=1.02)
    if run.limit is None:
        raise ComputationError(f"t0/R0 = {wall:g}: no limit point: {run.why_no_limit}")
    return StrainProbe(solid), run


def central_cells(wall: float, curvature: float) -> int:
    """Cells along the arc of the solid by default, for an object of a curvature, R0 over its radius."""
    return max(
        int(arc_cells(0.5 * np.pi, np.array(wall))),
        int(np.ceil(CELLS_PER_RADIUS * 0.5 * np.pi * (1.0 + wall) * curvature)),
    )


def pressed(
    recipe: PlaceTableRecipe,
    state: DomeState,
    curvature: float,
    lean: float,
    *,
    lying: bool = False,
    order: int | None = None,
    cells: int | None = None,
) -> ReadingCurve:
    """A press by an object of a curvature at a lean, see `recipe`: a plate or a ball, or the edge of a bar where it is
    ``lying``. A central plate or ball is axisymmetric."""
    central = lean == 0.0
    cells = cells or (recipe.cells if lying or not central else central_cells(state.wall, curvature))
    probe, run = _inflated(state.wall, cells, recipe.poisson_ratio)
    assert run.limit is not None
    free = state_at(probe.solid, state.share * run.limit.pressure, run)
    body = None if curvature == 0.0 else (edge if lying else ball)(1.0 / curvature)
    settings = _settings(recipe, state, free, body)
    placed = _placed(first_touch(probe.solid, free, body, _WIDE).body, state, curvature, lean, lying)
    usual = recipe.edge_order if lying else 0 if central else recipe.order
    press = OffAxisPress(probe.solid, free, settings, placed, probe, symmetric=lying and central)
    path = press.run(usual if order is None else order)
    ends = [event.indentation for event in path.events if KINDS[event.kind][1]]
    travel, rise, force = (np.array([getattr(s, name) for s in path.path]) for name in ("indentation", "rise", "force"))
    order_of = np.argsort(travel, kind="stable")
    travel, rise, force = travel[order_of], rise[order_of], force[order_of]
    return ReadingCurve(travel, rise, force, min([*ends, float(travel[-1])]))


def _settings(recipe: PlaceTableRecipe, state: DomeState, free: FreeState, body: RigidObject | None) -> PressSettings:
    """The protocol of a press, with the gas that has the stiffness of a state."""
    ambient = max(state.gas * free.volume - free.pressure, _AMBIENT)
    return PressSettings(
        depth=recipe.depth,
        steps=recipe.steps,
        plate_diameter=_WIDE,
        body=body,
        ambient=ambient,
        dead_volume=max((ambient + free.pressure) / state.gas - free.volume, 0.0),
        gauge_range=np.inf,
    )


def _placed(touching: Indenter, state: DomeState, curvature: float, lean: float, lying: bool) -> ProfiledObject:
    """An object at first contact on the axis, moved to its lean."""
    if curvature == 0.0:
        return PlacedObject(touching, 0.0, float(np.arcsin(lean)))
    offset = lean * (1.0 + state.wall + 1.0 / curvature)
    return LyingObject(touching, offset) if lying else PlacedObject(touching, offset)


def at_equal_reading(recipe: PlaceTableRecipe, plate: ReadingCurve, under: ReadingCurve) -> tuple[Array, float]:
    """Logarithm of the force under an object over the plate's at the readings of the recipe's levels, and the highest
    level that the object reaches.

    Beyond that level, and the end of the curves, the logarithm goes on with its last slope.
    """
    levels = np.array(recipe.levels)
    most = 1 + int(np.argmax(under.rise))
    end_rise = float(np.interp(under.end, under.travel[:most], under.rise[:most]))
    top = 1 + int(np.argmax(plate.rise))
    reach = min(plate.end, float(np.interp(end_rise, plate.rise[:top], plate.travel[:top])))
    known = min(
        float(plate.travel[top - 1]), float(np.interp(under.rise[most - 1], plate.rise[:top], plate.travel[:top]))
    )
    at = np.minimum(levels, known)
    rise = np.interp(at, plate.travel, plate.rise)
    logs = np.log(np.interp(rise, under.rise[:most], under.force[:most]) / np.interp(at, plate.travel, plate.force))
    within = int((levels <= known).sum())
    if 2 <= within < levels.size:
        slope = (logs[within - 1] - logs[within - 2]) / (levels[within - 1] - levels[within - 2])
        logs[within:] = logs[within - 1] + slope * (levels[within:] - levels[within - 1])
    return logs, reach
