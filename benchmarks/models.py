"""The models above the plain methods on the scenes: the atlas, and the choice of `auto`."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from benchmarks.answer import Answer, solid_answer
from benchmarks.scenes import Scene
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.press import AtlasPress
from pneutouch.mechanics.atlas.respond import BREAK, BUCKLING, EDGE, ENDS, OUTSIDE, respond
from pneutouch.mechanics.atlas.table import AtlasSlices, shipped
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.models import DEFAULT_TOLERANCE, models_for

ATLAS, AUTO = "atlas", f"auto at {DEFAULT_TOLERANCE:.0%}"
MODEL_METHODS = (ATLAS, AUTO)
AT_ONCE = 1000
_LEFT_TO_THE_SOLID = (ENDS[BUCKLING], ENDS[BREAK])


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
