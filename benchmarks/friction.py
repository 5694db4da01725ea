"""Friction between wall and plate: sensitivity, the loop it makes, convergence and time (a few minutes).

``python -m benchmarks.friction`` writes docs/background/friction.json; ``python -m benchmarks.friction presses`` prints
the random presses of which it times friction, and what they come to.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from tests.mechanics.solid.friction_loops import friction_loop

from benchmarks.store import LIBRARY, store, timed
from pneutouch.catalogue import Library
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.inflate import FreeState, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA

RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985")
WALL, PRESSURES = 1.5, (0.0, 22 * KPA)

FRICTIONS = (0.0, 0.3, 0.6, 1.0, np.inf)
LOOP_FRICTIONS = (0.1, 0.3, 0.6, 1.0, np.inf)
STEPS = (14, 28, 56, 112)
RADIUS, DEPTH = 9.25, 0.75 * 9.25
LOOP_DEPTH = 0.5 * RADIUS
BEFORE_EVENTS = 0.6 * RADIUS
"""Depth before which no press of the tables of steps and of time jumps."""

RANDOM, THIN = 120, 0.1
"""Random presses, and the share of R0 below which a wall counts as thin."""

Scene = tuple[SolidModel, FreeState]


class FrictionCost(NamedTuple):
    """A press: wall over the inner radius, modulus (MPa), driving pressure over the limit, coefficient, and the
    processor time with friction over that without."""

    wall: float
    modulus: float
    share: float
    friction: float
    ratio: float


def costs(count: int = RANDOM) -> Iterator[FrictionCost]:
    """Random presses to 0.6 R0; the least time of two each."""
    for seed in range(count):
        random = np.random.default_rng(seed)
        wall, modulus = (float(np.exp(random.uniform(*np.log(box)))) for box in ((0.05, 0.4), (0.17, 4.0)))
        share = float(random.choice([0.0, random.uniform(0.0, 0.9)]))
        friction = float(random.choice([*random.uniform(0.05, 1.5, 3), np.inf]))
        solid = SolidModel(dome(Hemisphere(RADIUS, wall * RADIUS)), neo_hookean(modulus), base=RigidBase())
        inflated = inflate(solid, past_limit=1.0)
        assert inflated.limit is not None
        free = state_at(solid, share * inflated.limit.pressure, inflated)
        jobs = (partial(press, (solid, free), one, BEFORE_EVENTS) for one in (0.0, friction))
        without, with_friction = (min(timed(job)[1] for _ in range(2)) for job in jobs)
        yield FrictionCost(wall, modulus, share, friction, with_friction / without)


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


def scene(modulus: float, pressure: float) -> Scene:
    """The paper's dome in a modulus (MPa) at a driving pressure (MPa)."""
    solid = SolidModel(dome(Hemisphere(RADIUS, WALL)), neo_hookean(modulus), base=RigidBase())
    return solid, state_at(solid, pressure)


def press(one: Scene, friction: float, depth: float = DEPTH, steps: int = 14) -> IndentationPath:
    """A press without the end of the gauge's range."""
    return indent(*one, PressSettings(depth, steps, friction=friction, gauge_range=np.inf))


def _sensitivities(moduli: dict[str, float]) -> list[dict[str, Any]]:
    """Sensitivity in kPa/N by resin and driving pressure, over `FRICTIONS`; None where there is no figure."""
    rows = []
    for name, modulus in moduli.items():
        for pressure in PRESSURES:
            one = scene(modulus, pressure)
            found = [press(one, friction).figures() for friction in FRICTIONS]
            values = [None if figure is None else round(figure.sensitivity, 3) for figure in found]
            rows.append({"resin": name, "driving_pressure_kPa": pressure / KPA, "sensitivity_kPa_per_N": values})
    return rows


def _loops(moduli: dict[str, float], measured: dict[str, float]) -> list[dict[str, Any]]:
    """Width, area and lost work of the loop in percent by resin, over `LOOP_FRICTIONS`."""
    rows = []
    for name, modulus in moduli.items():
        one, shares = scene(modulus, 0.0), []
        for friction in LOOP_FRICTIONS:
            loop = friction_loop(*one, PressSettings(LOOP_DEPTH, 14, friction=friction))
            shares.append([round(abs(100 * share), 1) for share in (*loop.hysteresis(), loop.lost_share)])
        rows.append({"resin": name, "loop_percent": shares, "measured_percent": measured[name]})
    return rows


def _steps() -> list[dict[str, Any]]:
    """Sensitivity in kPa/N over `STEPS`, and with 14 steps and springs ten times as stiff."""
    rows = []
    for modulus, pressure, friction in ((0.17, 0.0, 1.0), (0.91, 0.0, 0.6), (0.91, 0.0, np.inf), (4.0, 22 * KPA, 1.0)):
        one = scene(modulus, pressure)
        values = [_slope(press(one, friction, BEFORE_EVENTS, steps), steps // 14) for steps in STEPS]
        with mock.patch("pneutouch.mechanics.solid.friction_path.TANGENTIAL", 1.0):
            values.append(_slope(press(one, friction, BEFORE_EVENTS), 1))
        how = "grip" if np.isinf(friction) else f"{friction:g}"
        name = f"{modulus:g} MPa, {pressure / KPA:g} kPa, {how}"
        rows.append({"press": name, "sensitivity_kPa_per_N": values})
    return rows


def _slope(run: IndentationPath, every: int) -> float:
    """Sensitivity over the 15 depths that all numbers of steps share, kPa/N."""
    d, f, p = (run.column(name)[::every] for name in ("indentation", "force", "rise"))
    found = figures(d, f, p / KPA)
    assert found is not None
    return round(found.sensitivity, 4)


def _times() -> dict[str, Any]:
    """Processor times with friction over those without: of five presses over `FRICTIONS` but 0, and of random presses."""
    rows, ratios = [], []
    for modulus, pressure in ((0.17, 0.0), (0.17, 22 * KPA), (0.91, 0.0), (0.91, 22 * KPA), (4.0, 22 * KPA)):
        one = scene(modulus, pressure)
        jobs = (partial(press, one, friction, BEFORE_EVENTS) for friction in FRICTIONS)
        without, *others = (min(timed(job)[1] for _ in range(2)) for job in jobs)
        ratios += [other / without for other in others]
        shown = [round(other / without, 1) for other in others]
        rows.append({"press": f"{modulus:g} MPa, {pressure / KPA:g} kPa", "ratios": shown})
    return {
        "presses": rows,
        "mean": round(float(np.mean(ratios)), 2),
        "greatest": round(max(ratios), 1),
        "random": summary(list(costs())),
    }


def measure(library: Library) -> dict[str, Any]:
    """All numbers of the page, as it shows them."""
    materials = {name: library.load("materials", name) for name in RESINS}
    moduli = {name: material_sensor(material).wall.shear_modulus for name, material in materials.items()}
    measured = {name: material.measured.hysteresis_percent.nominal for name, material in materials.items()}
    found = {"sensitivity": _sensitivities(moduli), "loops": _loops(moduli, measured)}
    return {**found, "steps": _steps(), "times": _times(), **greatest(found)}


def greatest(found: dict[str, Any]) -> dict[str, Any]:
    """Relative change of the sensitivity on a plate that grips, by driving pressure and resin, and the widest loop."""
    grip: dict[str, dict[str, float]] = {}
    for row in found["sensitivity"]:
        values = row["sensitivity_kPa_per_N"]
        grip.setdefault(f"{row['driving_pressure_kPa']:g}", {})[row["resin"]] = values[-1] / values[0] - 1
    widest = max(shares[0] for row in found["loops"] for shares in row["loop_percent"])
    return {"grip": grip, "widest_loop_percent": widest}


def main(*words: str) -> None:
    if words:
        rows = []
        for row in costs():
            rows.append(row)
            print(" ".join(f"{value:.3g}" for value in row), flush=True)
        print(summary(rows))
    else:
        store("friction", measure(LIBRARY))


if __name__ == "__main__":
    main(*sys.argv[1:])
