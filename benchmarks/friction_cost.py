"""Processor time of random presses with friction over the same presses without, for docs/background/friction.md.

``python -m benchmarks.friction_cost [COUNT]`` prints a row a press (120), and their mean, greatest and count above 2.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import FreeState, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.rigid_base import RigidBase

COUNT, RADIUS, DEPTH, THIN = 120, 9.25, 0.6, 0.1


class FrictionCost(NamedTuple):
    """A press: wall over the inner radius, modulus (MPa), driving pressure over the limit, coefficient, and the
    processor time with friction over that without."""

    wall: float
    modulus: float
    share: float
    friction: float
    ratio: float


def costs(count: int = COUNT) -> Iterator[FrictionCost]:
    """Random presses to 0.6 R0; the least time of two each."""
    for seed in range(count):
        random = np.random.default_rng(seed)
        wall, modulus = (float(np.exp(random.uniform(*np.log(box)))) for box in ((0.05, 0.4), (0.17, 4.0)))
        share = float(random.choice([0.0, random.uniform(0.0, 0.9)]))
        friction = float(random.choice([*random.uniform(0.05, 1.5, 3), np.inf]))
        solid = SolidModel(dome(RADIUS, wall * RADIUS), neo_hookean(modulus), base=RigidBase())
        inflated = inflate(solid, past_limit=1.0)
        assert inflated.limit is not None
        free = state_at(solid, share * inflated.limit.pressure, inflated)
        without, with_friction = (min(_seconds(solid, free, one) for _ in range(2)) for one in (0.0, friction))
        yield FrictionCost(wall, modulus, share, friction, with_friction / without)


def _seconds(solid: SolidModel, free: FreeState, friction: float) -> float:
    begun = time.process_time()
    indent(solid, free, PressSettings(DEPTH * RADIUS, 14, friction=friction, gauge_range=np.inf))
    return time.process_time() - begun


def summary(rows: list[FrictionCost]) -> dict[str, float]:
    """Number of presses, mean and greatest ratio, how many take more than twice as long, and how many of those have thin
    walls."""
    ratios = np.array([row.ratio for row in rows])
    above = [row for row in rows if row.ratio > 2.0]
    return {
        "count": len(rows),
        "mean": round(float(ratios.mean()), 2),
        "greatest": round(float(ratios.max()), 1),
        "above_two": len(above),
        "above_two_thin": sum(row.wall < THIN for row in above),
    }


def main(words: list[str]) -> None:
    """Print the rows as they are measured, and the summary."""
    rows = []
    for row in costs(*(int(word) for word in words)):
        rows.append(row)
        sys.stdout.write("| " + " | ".join(f"{value:.3g}" for value in row) + " |\n")
        sys.stdout.flush()
    sys.stdout.write(f"{summary(rows)}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
