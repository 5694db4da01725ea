"""Random presses off the axis: objects and their places, friction, shear, walls, resins, dead volumes, driving pressures.

``python -m tests.stability.off_axis_scenes [FIRST LAST]`` prints the table of how these scenes end, and which end before
their depth.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.mechanics.events import DETAIL, OBJECT_EDGE
from pneutouch.mechanics.harmonic import model as harmonic
from pneutouch.mechanics.harmonic.friction_path import ENDED_BEFORE, STEPS
from pneutouch.mechanics.harmonic.press import OffAxisPath
from pneutouch.mechanics.models.harmonic import off_axis_press
from pneutouch.mechanics.sensor import RigidBase, Sensor
from pneutouch.mechanics.solid.indenter import RigidObject, ball, cylinder, edge
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import CELLS_PER_RADIUS, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from tests.stability.random_scenes import ENDS, MOST_NEWTON_STEPS, RADIUS, newton_steps, sensors

SCENES = 300
#: Depth over the inner radius, steps, order of the harmonics, cells along the arc and through the wall.
DEPTH, PRESS_STEPS, ORDER, CELLS, THROUGH = 0.75, 6, 2, 12, 1
_THINNEST, _THICKEST = 0.05, 0.4
#: Least radius of an object over the inner radius, which the cells bear; the greatest.
_LEAST, _GREATEST = CELLS_PER_RADIUS * 0.5 * np.pi * (1.0 + _THICKEST) / CELLS, 5.0
#: Share of the largest offset that the geometry of the unloaded dome admits.
_SHARE = 0.8
_STEEPEST = np.sin(np.radians(60.0))


@dataclass(frozen=True)
class OffAxisScene:
    """A sensor with its test, and its driving pressure over that of the limit."""

    sensor: Sensor
    share: float

    def run(self, order: int = ORDER, finer: int = 1) -> SceneEnd:
        """The press with harmonics to an order, on a mesh refined by a factor."""
        sensor = self.sensor
        mesh = dome(sensor.dome.shape, arc=finer * CELLS, through=finer * THROUGH)
        solid = SolidModel(mesh, sensor.wall.hyperelastic, base=sensor.dome.base)
        inflated = inflate(solid, past_limit=1.0)
        assert inflated.limit is not None
        run: OffAxisPath | PneutouchError
        with newton_steps(harmonic) as steps:
            try:
                free = state_at(solid, self.share * inflated.limit.pressure, inflated)
                run = off_axis_press(sensor, StrainProbe(solid), free).run(order)
            except PneutouchError as error:
                run = error
        return SceneEnd(sensor, run, steps())


@dataclass(frozen=True)
class SceneEnd:
    """A scene with its states, or the error it ended with, and the Newton steps that it took, those of failed solves
    among them."""

    sensor: Sensor
    run: OffAxisPath | PneutouchError
    newton_steps: int

    @property
    def kind(self) -> str:
        """How it ended: ``depth``, ``shear`` where it moved sideways by all of its travel too, the kind of the event or
        the first word on the shear that ended it, or the name of the error."""
        run = self.run
        if isinstance(run, PneutouchError):
            return type(run).__name__
        if not run.complete:
            return [event.kind for event in run.events if event.kind in ENDS][-1]
        if run.shear is None:
            return "depth"
        return "shear" if run.shear.ended is None else f"shear: {run.shear.ended.split(' at ')[0].rstrip(',')}"

    @property
    def travelled(self) -> float:
        """Depth reached over the inner radius; 0 after an error."""
        return 0.0 if isinstance(self.run, PneutouchError) else self.run.path[-1].indentation / RADIUS

    def check(self) -> None:
        """Assert what holds at every end."""
        assert self.newton_steps <= MOST_NEWTON_STEPS, self.newton_steps
        run, test, gas = self.run, self.sensor.protocol, self.sensor.gas
        if isinstance(run, PneutouchError):
            assert isinstance(run, InputError | ComputationError) and str(run), run
            return
        kinds = {event.kind for event in run.events}
        assert kinds <= {*DETAIL, *ENDS, OBJECT_EDGE} and (run.complete or kinds & ENDS), kinds
        assert all(event.detail and np.isfinite(event.indentation) for event in run.events), run.events
        travel, force, sideways, pressure = (
            np.array([getattr(s, name) for s in run.path]) for name in ("indentation", "force", "sideways", "pressure")
        )
        assert np.isfinite(np.concatenate([travel, force, sideways, pressure])).all() and (force >= 0.0).all()
        assert (np.diff(travel) > 0.0).all() and travel[-1] <= test.depth * (1.0 + 1.0e-9)
        held = (pressure + gas.ambient_pressure) * (np.array([s.volume for s in run.path]) + gas.dead_volume)
        assert np.allclose(held, held[0], rtol=1.0e-9, atol=0.0)
        self._check_cone(force, sideways, np.array([s.object_distance for s in run.path]))
        self._check_shear(run)

    def _check_cone(self, force: Array, sideways: Array, distance: Array) -> None:
        """The force on the flat of a plate is normal to it, or inside its cone of friction."""
        test = self.sensor.protocol
        if test.body is not None or np.isinf(test.friction):
            return
        flat = distance < 0.9 * test.plate_radius
        angle = np.arctan2(-sideways, force)[flat] - test.tilt
        assert (np.abs(angle[force[flat] > 0.0]) <= np.arctan(test.friction) + 1.0e-6).all(), angle

    def _check_shear(self, run: OffAxisPath) -> None:
        """A shear follows where it is wanted, moves evenly, and is on a slope of friction."""
        test = self.sensor.protocol
        assert (run.shear is None) == (test.shear == 0.0)
        if run.shear is None:
            return
        path = run.shear
        assert (path.ended == ENDED_BEFORE) == (not run.complete)
        assert path.ended is not None or len(path.states) == STEPS + 1
        assert (np.diff(np.abs(path.column("travel"))) > 0.0).all()
        for name in ("force", "sideways", "moment", "rise", "sliding"):
            assert np.isfinite(path.column(name)).all(), name
        if path.states:
            assert path.stiffness is not None and path.stiffness > 0.0, path.stiffness


def random_scene(seed: int) -> OffAxisScene:
    """Any of the resins, walls of 0.05 to 0.4 R0, a driving pressure to 0.9 of the limit; dead volume 0 to 10,000
    cavities; friction 0, to 1.5 or grip; every other of the scenes with friction is sheared, by up to 0.4 R0."""
    random = np.random.default_rng([17, seed])
    usual = sensors()[str(random.choice(sorted(sensors())))]
    wall = float(random.uniform(_THINNEST, _THICKEST)) * RADIUS
    friction = float(random.choice([0.0, random.uniform(0.0, 1.5), random.uniform(0.0, 1.5), np.inf]))
    cavity, part = 2.0 / 3.0 * np.pi * RADIUS**3, float(np.exp(random.uniform(np.log(0.01), np.log(10.0))))
    sheared = float(random.uniform(-0.4, 0.4)) * RADIUS if random.random() < 0.5 else 0.0
    sensor = usual.replace(
        inner_radius=RADIUS,
        wall_thickness=wall,
        base=RigidBase(),
        dead_volume=cavity * float(random.choice([0.0, part, 1.0e4])),
        gauge_limit=np.inf,
        depth=DEPTH * RADIUS,
        steps=PRESS_STEPS,
        friction=friction,
        shear=sheared if friction else 0.0,
        **_placed(random, RADIUS + wall),
    )
    return OffAxisScene(sensor, float(random.uniform(0.0, 0.9)))


def _placed(random: np.random.Generator, reach: float) -> dict[str, Any]:
    """An object and its place; ``reach`` is the outer radius of the dome. A quarter of the bars lie across its middle."""
    kind, size = random.integers(4), float(np.exp(random.uniform(np.log(_LEAST), np.log(_GREATEST)))) * RADIUS
    make = (None, ball, edge, cylinder)[kind]
    if make is None:
        tilt, plate = float(np.radians(random.uniform(0.0, 30.0))), float(random.uniform(1.2, 2.5)) * reach
        largest = max(0.0, 0.9 * plate * np.cos(tilt) - reach * np.sin(tilt))
        return {"body": None, "plate_radius": plate, "tilt": tilt, "offset": float(random.uniform(0.0, 0.5)) * largest}
    body: RigidObject = make(size)
    share = 0.0 if body.lying and random.random() < 0.25 else float(random.uniform(0.0, _SHARE))
    offset = share * _STEEPEST * (reach + size)
    return {"body": replace(body, label=f"{body.label} of {size:.2f} mm"), "offset": offset}


def ended(seed: int) -> SceneEnd:
    """A scene with its end, checked."""
    end = random_scene(seed).run()
    end.check()
    return end


def words(seed: int, end: SceneEnd) -> str:
    """A line on a scene and its end."""
    test, dome_ = end.sensor.protocol, end.sensor.dome
    body = f"plate leaning by {np.degrees(test.tilt):.1f}°" if test.body is None else test.body.label
    place = f"{test.offset:.2f} mm off the axis, friction {test.friction:.2g}, shear {test.shear:.2g} mm"
    wall = f"wall {dome_.wall_thickness / dome_.inner_radius:.2f} R0"
    return f"{seed} {end.kind}, {end.travelled:.2f} R0: {body}, {place}, {wall}"


def main(numbers: list[str]) -> None:
    """Print the table of ends, and the scenes that end before their depth."""
    ends = {seed: ended(seed) for seed in (range(*(int(n) for n in numbers)) if numbers else range(SCENES))}
    counts = Counter(end.kind for end in ends.values())
    rows = [f"| {kind} | {count} |" for kind, count in counts.most_common()]
    before = [words(seed, end) for seed, end in ends.items() if end.kind not in ("depth", "shear")]
    sys.stdout.write("\n".join([f"| end | of {counts.total()} |", "| --- | ---: |", *rows, "", *before, ""]))


if __name__ == "__main__":
    main(sys.argv[1:])
