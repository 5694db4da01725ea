"""What a method says of a scene, in one form for all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.scenes import Scene
from pneutouch.arrays import Array
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.membrane import membrane_states
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid_states import curve_between, reported_events
from pneutouch.units import KPA

_FINE_STEPS = 140
"""Steps of the membrane's curve where it is read between the 14 that are timed."""


@dataclass(frozen=True)
class Answer:
    """What a method says of a scene: mm, MPa, N. ``curve`` gives force and rise at indentations up to ``end``."""

    apex: float
    end: float
    ends: str
    curve: Callable[[Array], tuple[Array, Array]]

    def sensitivity(self, grid: Array) -> float:
        """Slope of rise over force on a grid of indentations, kPa/N."""
        force, rise = self.curve(grid)
        found = figures(grid, force, rise / KPA)
        return np.nan if found is None else found.sensitivity_kPa_per_N


def solid_answer(scene: Scene, arc: int | None, through: int | None, depth: float | None = None) -> Answer:
    """Study 1 to the driving pressure and study 2 in 14 steps, mesh and all; ``depth`` (mm) may stop it short."""
    s = scene.sensor
    mesh = dome(s.dome.inner_radius, s.dome.wall_thickness, arc=arc, through=through)
    solid = SolidModel(mesh, s.wall.hyperelastic, base=s.dome.base)
    free = state_at(solid, scene.pressure)
    press = PressSettings(
        depth or s.protocol.depth,
        s.protocol.steps,
        2 * s.protocol.plate_radius,
        s.gas.ambient_pressure,
        s.gas.dead_volume,
        s.gas.gauge_limit,
    )
    found = indent(solid, free, press)
    happened = reported_events(found.events)
    end = min(range_end(happened, press.depth), found.path[-1].indentation)
    ends = next((event.kind for event in happened if event.ends_range), "depth")
    return Answer(free.inner_apex, end, ends, lambda grid: curve_between(found.path, grid))


def membrane_answer(scene: Scene, closure: str) -> Answer:
    """The same work by the membrane."""
    pressures = np.array([scene.pressure])
    (state,) = membrane_states(scene.sensor, pressures, closure)
    ends = next((event.kind for event in state.events if event.ends_range), "depth")

    def curve(grid: Array) -> tuple[Array, Array]:
        (fine,) = membrane_states(scene.sensor.replace(steps=_FINE_STEPS), pressures, closure)
        return np.interp(grid, fine.indentation, fine.force), np.interp(grid, fine.indentation, fine.pressure_rise)

    return Answer(state.apex_inner, state.range_end, ends, curve)


def solid_limit(scene: Scene, arc: int | None, through: int | None) -> float:
    """Limit pressure, MPa; nan where there is none."""
    s = scene.sensor
    run = inflate(
        SolidModel(dome(s.dome.inner_radius, s.dome.wall_thickness, arc=arc, through=through), s.wall.hyperelastic),
        past_limit=1.0,
    )
    return np.nan if run.limit is None else run.limit.pressure
