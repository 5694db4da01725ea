"""Where a search finds no design, a dense grid of sizes finds none either."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from pneutouch.selection.candidates import CandidatePool, evaluated, margins
from pneutouch.selection.choose import choose
from tests.selection.targets import answer

SIZES, SEED = 200, 7
RESINS = ["TangoPlus", "FLX9940", "FLX9950", "FLX9970"]


@cache
def problem_of(diameter_mm: float):
    wanted = {"sensitivity_kPa_per_N": 1.0, "driving_pressure_kPa": 0.0, "max_diameter_mm": diameter_mm}
    return answer(wanted, given={"materials": RESINS}).problem


@cache
def grid(diameter_mm: float) -> CandidatePool:
    """Every size in hundredths of a millimetre, or 200 by 200 of them, in every resin, without driving pressure."""
    problem = problem_of(diameter_mm)
    walls = np.unique(np.round(np.linspace(problem.least_wall, 0.2 * diameter_mm, SIZES), 2))
    radii = np.unique(np.round(np.linspace(0.25 * diameter_mm, 0.5 * diameter_mm, SIZES), 2))
    wall, radius = (side.ravel() for side in np.meshgrid(walls, radii))
    inside = radius + wall <= 0.5 * diameter_mm + 1e-9
    wall, radius = np.tile(wall[inside], len(RESINS)), np.tile(radius[inside], len(RESINS))
    resin = np.repeat(np.arange(len(RESINS), dtype=float), inside.sum())
    return evaluated(problem, resin, radius, wall, np.zeros(resin.size))


def without_uncertainty(groups):
    return [np.full(len(batch), 0.1) for _, batch in groups]


def changed(problem, generator, pool):
    """The problem with a sensitivity and a stiffness or a force near the edge of what there is."""
    from dataclasses import replace

    lines = pool.response.lines
    known = np.flatnonzero(np.isfinite(lines.sensitivity))
    row, by = generator.choice(known), np.exp(generator.normal(0.0, 0.05, 2))
    most = np.nanmax(lines.sensitivity)
    near_edge = most * generator.uniform(0.95, 1.1) if generator.random() < 0.5 else lines.sensitivity[row]
    wanted = {"sensitivity": float(near_edge * by[0]), "tolerance": 0.05}
    if generator.random() < 0.5:
        wanted["force_range"] = float(pool.force[row] * by[1])
    else:
        wanted["stiffness"] = (float(lines.stiffness[row] * by[1]), None)
    return replace(problem, **wanted)


@pytest.mark.slow
@pytest.mark.parametrize("diameter_mm", [9.0, 10.0, 12.0, 16.0, 25.0])
def test_no_design_of_a_dense_grid_is_missed(diameter_mm):
    problem, pool = problem_of(diameter_mm), grid(diameter_mm)
    generator, missed, none = np.random.default_rng(SEED), [], 0
    for _ in range(100):
        wanted = changed(problem, generator, pool)
        if choose(wanted, (1.0, 0.0), without_uncertainty).designs:
            continue
        none += 1
        worst = np.min(list(margins(wanted, pool).values()), axis=0)
        if worst.max() >= 0.0:
            best = int(worst.argmax())
            missed.append((wanted.sensitivity, pool.radius[best], pool.wall[best], float(worst[best])))
    assert none > 10
    assert not missed, missed
