"""Random sensors in the catalogue's elastomers, and what became of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.spec.material import Material
from pneutouch.units import ML
from tests.stability.truth import Study

#: Plate over inner radius: 30 mm on 9.25 mm, as in the paper.
PLATE = 30.0 / 9.25


def random_sensors(
    library: Library, count: int, seed: int, walls: tuple[float, float] = (0.05, 0.4), depth: float = 0.5
) -> Iterator[tuple[str, Study]]:
    """Label and study of `count` sensors: any printed elastomer of a neo-Hookean law, which has a limit point, R0 4 to
    30 mm, wall ratio within `walls`, driving pressure to 80 % of the limit, dead volume to 5 mL, pressed to `depth` R0
    in 1 to 19 steps.
    """
    printed = library.all("materials", Material).items()
    resins = [(k, m) for k, m in printed if m.kind == "elastomer" and not m.is_cast and m.law is None]
    rng = np.random.default_rng(seed)
    for number in range(count):
        name, resin = resins[number % len(resins)]
        sensor = material_sensor(resin)
        assert sensor.wall.break_stretch is not None
        radius, ratio, share = rng.uniform(4.0, 30.0), rng.uniform(*walls), rng.uniform(0.0, 0.8)
        solid = SolidModel(dome(Hemisphere(radius, ratio * radius)), sensor.wall.hyperelastic)
        run = inflate(solid, past_limit=1.0)
        assert run.limit is not None
        free = state_at(solid, share * run.limit.pressure, run)
        press = PressSettings(
            depth * radius,
            int(rng.integers(1, 20)),
            PLATE * radius,
            sensor.gas.ambient_pressure,
            rng.uniform(0.0, 5.0) * ML,
            sensor.gas.gauge_limit,
            sensor.wall.break_stretch - 1.0,
        )
        label = f"{number}: {name}, R0 {radius:.3f} mm, t0/R0 {ratio:.3f}, {share:.0%} of the limit, {press}"
        yield label, Study.of(solid, free, press)


def tally(ends: Counter[str]) -> str:
    """Counts as one line, the most frequent first."""
    return ", ".join(f"{kind} {count}" for kind, count in ends.most_common())
