"""Random presses: objects, friction, walls, resins, dead volumes, driving pressures, with a base and without.

``python -m tests.stability.random_scenes [FIRST LAST]`` prints the table of how the presses of these domes end, and which
end before their depth.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from unittest import mock

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.errors import PneutouchError
from pneutouch.mechanics.events import BREAKS_CURVE, DETAIL, OBJECT_EDGE
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import RigidBase, Sensor
from pneutouch.mechanics.solid import friction_newton, newton
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.indenter import ProfileVertex, RigidObject, ball, cone, profile, ring
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import CELLS_PER_RADIUS, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.spec.material import Material

#: Domes, and presses of each.
DOMES, PRESSES = 500, 4
#: Inner radius in mm, depth over it, steps.
RADIUS, DEPTH, STEPS = 9.25, 0.75, 6
#: Newton steps of a press, those of failed solves among them, beyond which it counts as one without an end.
MOST_NEWTON_STEPS = 4000
#: Kinds that end a press before its depth.
ENDS = {*BREAKS_CURVE, "floor"} - {"separation"}
_CELLS, _THICKEST = 24, 0.4
#: Least radius of an object over the inner radius, which the cells bear.
_LEAST = CELLS_PER_RADIUS * 0.5 * np.pi * (1.0 + _THICKEST) / _CELLS


@dataclass(frozen=True)
class RandomDome:
    """A wall of a resin, its ratio to the inner radius, whether it has a base; and the presses of it, with their
    driving pressures over the limit."""

    resin: str
    wall: float
    base: bool
    presses: tuple[tuple[float, PressSettings], ...]

    def runs(self, finer: int = 1) -> Iterator[PressEnd]:
        """Every press in turn on a mesh refined by a factor."""
        mesh = dome(Hemisphere(RADIUS, self.wall * RADIUS), arc=finer * _CELLS, through=finer)
        solid = SolidModel(mesh, sensors()[self.resin].wall.hyperelastic, base=RigidBase() if self.base else None)
        inflated = inflate(solid, past_limit=1.0)
        assert inflated.limit is not None
        for share, press in self.presses:
            with newton_steps() as steps:
                run: IndentationPath | PneutouchError
                try:
                    run = indent(solid, state_at(solid, share * inflated.limit.pressure, inflated), press)
                except PneutouchError as error:
                    run = error
            yield PressEnd(press, run, steps())


@dataclass(frozen=True)
class PressEnd:
    """A press with its states, or the error it ended with, and the Newton steps that it took, those of failed solves
    among them."""

    press: PressSettings
    run: IndentationPath | PneutouchError
    newton_steps: int

    @property
    def kind(self) -> str:
        """How it ended: ``depth``, the kind of the event that ended it or the name of the error."""
        if isinstance(self.run, PneutouchError):
            return type(self.run).__name__
        ended = [event.kind for event in self.run.events if event.kind in ENDS]
        return "depth" if self.run.complete else ended[-1]

    def check(self) -> None:
        """Assert what holds at every end."""
        assert self.newton_steps <= MOST_NEWTON_STEPS, self.newton_steps
        run, press = self.run, self.press
        if isinstance(run, PneutouchError):
            return
        kinds = {event.kind for event in run.events}
        assert kinds <= {*DETAIL, *ENDS, OBJECT_EDGE} and (run.complete or kinds & ENDS), kinds
        assert all(event.detail and np.isfinite(event.indentation) for event in run.events), run.events
        force, travel, pressure = (run.column(name) for name in ("force", "indentation", "pressure"))
        assert np.isfinite(np.concatenate([force, travel, pressure])).all() and (force >= 0.0).all()
        assert (np.diff(travel) > 0.0).all() and travel[-1] <= press.depth * (1.0 + 1.0e-9)
        held = (pressure + press.ambient) * (run.column("volume") + press.dead_volume)
        assert np.allclose(held, held[0], rtol=1.0e-9, atol=0.0)


@contextmanager
def newton_steps(*others: ModuleType) -> Iterator[Callable[[], int]]:
    """Number of the Newton steps taken inside, without friction, with it and in other modules: each assembles one
    tangent."""
    with ExitStack() as stack:
        counters = [
            stack.enter_context(mock.patch.object(module, "tangent", wraps=vars(module)["tangent"]))
            for module in (newton, friction_newton, *others)
        ]
        yield lambda: sum(counter.call_count for counter in counters)


@cache
def sensors() -> dict[str, Sensor]:
    """The paper's sensor in each of the seven resins that the paper measured, by name."""
    found = Library.default().all("materials", Material)
    measured = sorted(k for k, m in found.items() if m.kind == "elastomer" and m.measured is not None)
    return {name: material_sensor(found[name]) for name in measured}


def random_dome(seed: int) -> RandomDome:
    """Any of the resins, walls of 0.05 to 0.4 R0, every other on a base."""
    random = np.random.default_rng(seed)
    resin, wall = str(random.choice(sorted(sensors()))), float(random.uniform(0.05, _THICKEST))
    return RandomDome(resin, wall, bool(random.random() < 0.5), tuple(_press(random) for _ in range(PRESSES)))


def _press(random: np.random.Generator) -> tuple[float, PressSettings]:
    """A driving pressure to 0.9 of the limit; friction 0, to 1.5 or grip; dead volume 0 to 10,000 cavities."""
    friction = float(random.choice([0.0, random.uniform(0.0, 1.5), random.uniform(0.0, 1.5), np.inf]))
    cavity, share = 2.0 / 3.0 * np.pi * RADIUS**3, float(np.exp(random.uniform(np.log(0.01), np.log(10.0))))
    press = PressSettings(
        DEPTH * RADIUS,
        STEPS,
        dead_volume=cavity * float(random.choice([0.0, share, 1.0e4])),
        gauge_range=np.inf,
        friction=friction,
        body=_body(random),
    )
    return float(random.uniform(0.0, 0.9)), press


def _body(random: np.random.Generator) -> RigidObject | None:
    """A plate (None) or another object."""
    kind, size = random.integers(5), float(np.exp(random.uniform(np.log(_LEAST), np.log(5.0))))
    if kind == 0:
        return ball(size * RADIUS)
    if kind == 1:
        return cone(float(random.uniform(np.pi / 6, 1.4)), size * RADIUS)
    if kind == 2:
        return ring(float(random.uniform(0.4, 0.8)) * RADIUS, _LEAST * RADIUS)
    if kind == 3:
        corners = ((0.0, 0.0, 0.0), (0.6, 0.0, _LEAST), (1.2, 0.4, _LEAST))
        return profile([ProfileVertex(*(RADIUS * one for one in corner)) for corner in corners])
    return None


def ends(seed: int) -> list[str]:
    """How the presses of a dome end, each checked."""
    found = list(random_dome(seed).runs())
    for one in found:
        one.check()
    return [one.kind for one in found]


def main(words: list[str]) -> None:
    """Print the table of ends, and the presses that end before their depth."""
    seeds = range(*(int(word) for word in words)) if words else range(DOMES)
    kinds = {f"{seed}.{one}": kind for seed in seeds for one, kind in enumerate(ends(seed))}
    counts = Counter(kinds.values())
    rows = [f"| {kind} | {count} |" for kind, count in counts.most_common()]
    before = [f"{name} {kind}" for name, kind in kinds.items() if kind != "depth"]
    sys.stdout.write("\n".join([f"| end | of {counts.total()} |", "| --- | ---: |", *rows, "", *before, ""]))


if __name__ == "__main__":
    main(sys.argv[1:])
