"""How a press off the axis settles with the order of its harmonics, and what it costs over a central one.

``python -m benchmarks.harmonic_orders [ORDER ...]`` prints the tables of docs/background/off-axis.md: a ball of 6 mm radius 3 mm off
the axis of a dome of the paper's size.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np

from pneutouch.mechanics.harmonic.press import OffAxisPress, OffAxisState
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.units import KPA

ORDERS = (2, 3, 4, 6, 8, 12)
RADIUS, WALL, MODULUS, BALL, OFFSET = 9.25, 1.5, 0.27, 6.0, 3.0
PRESS = PressSettings(depth=6.94, steps=14, body=ball(BALL))


def _figures(state: OffAxisState) -> tuple[float, float, float]:
    return float(state.force), float(state.sideways), float(state.rise) / KPA


def _seconds(job: Callable[[], object]) -> float:
    begun = time.process_time()
    job()
    return time.process_time() - begun


def main(words: list[str]) -> None:
    """Print force, sideways force and pressure rise by order, their changes from M to 2M, and the time over a central
    press of the solid."""
    solid = SolidModel(dome(RADIUS, WALL), neo_hookean(MODULUS), base=RigidBase())
    free = state_at(solid, 0.0)
    placed = PlacedObject(ball(BALL).scaled(1.0 / RADIUS), OFFSET / RADIUS)
    press = OffAxisPress(solid, free, PRESS, placed, StrainProbe(solid))
    central = min(_seconds(lambda: indent(solid, free, PRESS)) for _ in range(3))
    found: dict[int, tuple[float, float, float]] = {}
    for order in [int(word) for word in words] or ORDERS:
        begun = time.process_time()
        found[order] = _figures(press.run(order).path[-1])
        ratio = (time.process_time() - begun) / central
        sys.stdout.write(f"| {order} | " + " | ".join(f"{value:.4g}" for value in found[order]) + f" | {ratio:.0f} |\n")
        sys.stdout.flush()
    for order in (order for order in found if 2 * order in found):
        low, high = np.array(found[order]), np.array(found[2 * order])
        changes = " | ".join(f"{100 * change:.2g} %" for change in np.abs(low / high - 1.0))
        sys.stdout.write(f"| {order} to {2 * order} | {changes} |\n")


if __name__ == "__main__":
    main(sys.argv[1:])
