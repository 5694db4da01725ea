"""The methods that are compared on scenes, each answering in one form: membrane, atlas, solid and the choice of `auto`."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.scenes import Scene
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.coverage import outside_atlas
from pneutouch.mechanics.atlas.press import AtlasPress, batch_of
from pneutouch.mechanics.atlas.respond import BREAK, BUCKLING, EDGE, ENDS, OUTSIDE, respond
from pneutouch.mechanics.atlas.table import AtlasSlices, shipped
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.models.choice import DEFAULT_TOLERANCE, models_for
from pneutouch.mechanics.models.membrane import membrane_states
from pneutouch.mechanics.models.solid import curve_between, reported_events
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.units import KPA

ATLAS, AUTO = "atlas", f"auto at {DEFAULT_TOLERANCE:.0%}"
MODEL_METHODS = (ATLAS, AUTO)
AT_ONCE = 1000
_LEFT_TO_THE_SOLID = (ENDS[BUCKLING], ENDS[BREAK])
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
        return np.nan if found is None else found.sensitivity


def solid_answer(scene: Scene, arc: int | None, through: int | None, depth: float | None = None) -> Answer:
    """Study 1 to the driving pressure and study 2 in 14 steps, mesh and all; ``depth`` (mm) may stop it short."""
    s = scene.sensor
    mesh = dome(s.dome.shape, arc=arc, through=through)
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
    run = inflate(SolidModel(dome(s.dome.shape, arc=arc, through=through), s.wall.hyperelastic), past_limit=1.0)
    return np.nan if run.limit is None else run.limit.pressure


def atlas_answer(scene: Scene) -> Answer | None:
    """The scene looked up as one sensor alone; None where the atlas does not cover it."""
    if outside_atlas(scene.sensor) is not None:
        return None
    s, batch = scene.sensor, batch_of(scene.sensor, np.array([scene.pressure]))
    found = respond(batch, s.protocol.steps)
    if int(found.ends[0]) in (OUTSIDE, EDGE) or np.isnan(found.range_end[0]):
        return None
    slices = shipped().slices(batch.wall_ratio, ("inner_apex",))
    press = AtlasPress(batch, slices, np.zeros(1, dtype=np.intp))
    unit = s.wall.shear_modulus * s.dome.inner_radius**2

    def curve(grid: Array) -> tuple[Array, Array]:
        point = press.march(grid[None, :] / s.dome.inner_radius).point
        return point.force[0] * unit, (point.pressure[0] - press.pressure[0]) * s.wall.shear_modulus

    return Answer(
        _inner_apex(slices, press) * s.dome.inner_radius, float(found.range_end[0]), ENDS[int(found.ends[0])], curve
    )


def _inner_apex(slices: AtlasSlices, press: AtlasPress) -> float:
    return float(slices.field("inner_apex", press.k, press.free, press.apex)[0])


def atlas_limit(scene: Scene) -> float:
    """Limit pressure, MPa."""
    s = scene.sensor
    ratio = np.array([s.dome.wall_thickness / s.dome.inner_radius])
    return float(shipped().slices(ratio, ()).limit_pressure[0]) * s.wall.shear_modulus


def auto_answer(scene: Scene) -> tuple[Answer, str]:
    """The answer of the cheapest model that states the default tolerance, and which it was."""
    if ATLAS in models_for(scene.sensor, DEFAULT_TOLERANCE).models:
        answer = atlas_answer(scene)
        if answer is not None and answer.ends not in _LEFT_TO_THE_SOLID and not _near_buckling(scene):
            return answer, ATLAS
    return solid_answer(scene, None, None), "solid"


def _near_buckling(scene: Scene) -> bool:
    return bool(
        respond(batch_of(scene.sensor, np.array([scene.pressure])), scene.sensor.protocol.steps).near_buckling[0]
    )


def seconds_at_once(scene: Scene, count: int = AT_ONCE) -> float:
    """Processor time of the atlas for one of many sensors in one call, all with walls of their own."""
    s = scene.sensor
    batch = batch_of(s, np.full(count, scene.pressure))
    batch = replace(batch, wall_thickness=s.dome.wall_thickness * np.linspace(0.99, 1.01, count))
    start = time.process_time()
    respond(batch, s.protocol.steps)
    return (time.process_time() - start) / count


def why_no_answer(scene: Scene) -> str:
    """What keeps the atlas from a scene."""
    return outside_atlas(scene.sensor) or "the press leaves its states"
