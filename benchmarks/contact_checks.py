"""Checks of contact that docs/background/contact.md and off-axis.md state: ``python -m benchmarks.contact_checks NAME``.

``fronts [DESIGN kPa KEY=VALUE ...]``: random places of the fronts of a datasheet's trade-off under another contact, pressed
by the solid. ``resins [DESIGN ...]``: the datasheet's curves of other resins under friction against the solid at nine
pressures. ``orders [ORDER ...]``: a ball of 6 mm radius 3 mm off the axis of a dome of the paper's size, by the order of
its harmonics, with the time over a central press. Each prints the rows of a table.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.store import timed
from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.charts import in_resin, resin_curves, resized, tradeoff_problem
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.harmonic.press import OffAxisPress, OffAxisState
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.selection.contact_search import tried
from pneutouch.selection.front import ContactFronts, contact_front, place
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.spec.read import parse_changes
from pneutouch.units import KPA

CASES = (
    ("paper-dome", "22", "contact.friction=0.6"),
    ("paper-dome", "0", "contact.friction=inf"),
    ("paper-dome", "10", "contact.object=ball", "contact.ball_radius_mm=10"),
)
EACH, SEED = 2, 5
DESIGNS, FRICTION, POINTS = ("paper-dome", "soft-pad", "agilus-dome"), 0.6, 9
ORDERS = (2, 3, 4, 6, 8, 12)
RADIUS, WALL, MODULUS, BALL, OFFSET = 9.25, 1.5, 0.27, 6.0, 3.0
PRESS = PressSettings(depth=6.94, steps=14, body=ball(BALL))


def errors(design: str, pressure_kPa: float, changes: list[str]) -> tuple[ContactFronts, Array]:
    """Fronts, and the logarithms of sensitivity and force over the solid's at random places of each, (n, 2)."""
    pressure = {"pneumatics.driving_pressures_kPa": [pressure_kPa], "indentation.checked_waves": 0}
    evaluation = evaluate(design, {**parse_changes(changes), **pressure})
    problem = tradeoff_problem(evaluation, pressure_kPa * KPA)
    solve, draw, found = resized(evaluation.sensor, problem), np.random.default_rng(SEED), []
    drawn = contact_front(problem, solve)
    for number, one in enumerate(drawn.fronts):
        for row in draw.integers(0, one.force.size, EACH if one.force.size > 1 else 0):
            trial = tried(problem, place(problem, number, one, int(row)), solve)
            if trial.why:
                sys.stdout.write(f"{one.resin.name}: {trial.why}\n")
                continue
            exact_kPa_per_N, force = trial.pool.response.lines.sensitivity[0], trial.pool.force[0]
            found.append((np.log(one.sensitivity[row] / exact_kPa_per_N), np.log(one.force[row] / force)))
            off = ", ".join(f"{100 * log:+.1f} %" for log in found[-1])
            sys.stdout.write(f"{one.resin.name} at {exact_kPa_per_N:.3g} kPa/N: {off}\n")
            sys.stdout.flush()
    return drawn, np.array(found)


def fronts(words: list[str]) -> None:
    """Print the places, and a row of the table for each contact."""
    rows = []
    for design, pressure_kPa, *changes in [words] if words else CASES:
        drawn, found = errors(design, float(pressure_kPa), changes)
        worst = np.abs(found).max(axis=1)
        inside = int((worst <= drawn.greatest_error).sum())
        shares = [f"{100 * one:.1f} %" for one in (drawn.greatest_error, np.median(worst), worst.max())]
        cells = [f"{' '.join(changes)}, {pressure_kPa} kPa", str(drawn.presses), str(worst.size), *shares, str(inside)]
        rows.append(f"| {' | '.join(cells)} |\n")
    sys.stdout.write("".join(rows))


def _by_solid(sensor: Sensor, pressure_kPa: float) -> float:
    """Sensitivity in kPa/N; NaN where there is none."""
    try:
        (state,) = solid_states(sensor.replace(waves=0), np.array([pressure_kPa * KPA]))
    except ComputationError:
        return np.nan
    return np.nan if state.figures is None else state.figures.sensitivity


def resins(words: list[str]) -> None:
    """Print a row a curve, and how many are within 1 %."""
    worst = []
    for design in words or DESIGNS:
        evaluation = evaluate(design, {"contact.friction": FRICTION})
        sensor, highest = evaluation.sensor, max(s.driving_pressure for s in evaluation.prediction.states)
        materials = {m.title: m for m in evaluation.resins.values()}
        curves = resin_curves(sensor, evaluation.resins, highest, "solid", None, evaluation.prediction.states)
        for title, curve in curves.items():
            known = curve.driving_pressure_kPa
            grid = np.linspace(known[0], known[-1], POINTS)
            drawn = np.interp(grid, known, curve.sensitivity)
            whole = np.array([_by_solid(in_resin(sensor, materials[title]), p) for p in grid])
            worst.append(float(np.nanmax(np.abs(np.log(drawn / whole)))))
            sys.stdout.write(f"| {design} | {title} | {100 * worst[-1]:.2f} % |\n")
            sys.stdout.flush()
    share = f"{sum(one <= 0.01 for one in worst)} of {len(worst)} within 1 %"
    sys.stdout.write(f"{share}; greatest {100 * max(worst):.1f} %, mean {100 * np.mean(worst):.1f} %\n")


def _figures(state: OffAxisState) -> tuple[float, float, float]:
    return float(state.force), float(state.sideways), float(state.rise) / KPA


def orders(words: list[str]) -> None:
    """Print force, sideways force and pressure rise by order, their changes from M to 2M, and the time over a central
    press of the solid."""
    solid = SolidModel(dome(Hemisphere(RADIUS, WALL)), neo_hookean(MODULUS), base=RigidBase())
    free = state_at(solid, 0.0)
    placed = PlacedObject(ball(BALL).scaled(1.0 / RADIUS), OFFSET / RADIUS)
    press = OffAxisPress(solid, free, PRESS, placed, StrainProbe(solid))
    central = min(timed(lambda: indent(solid, free, PRESS))[1] for _ in range(3))
    found: dict[int, tuple[float, float, float]] = {}
    for order in [int(word) for word in words] or ORDERS:
        pressed, seconds = timed(partial(press.run, order))
        found[order] = _figures(pressed.path[-1])
        cells = [*(f"{value:.4g}" for value in found[order]), f"{seconds / central:.0f}"]
        sys.stdout.write(f"| {order} | {' | '.join(cells)} |\n")
        sys.stdout.flush()
    for order in (order for order in found if 2 * order in found):
        low, high = np.array(found[order]), np.array(found[2 * order])
        changes = " | ".join(f"{100 * change:.2g} %" for change in np.abs(low / high - 1.0))
        sys.stdout.write(f"| {order} to {2 * order} | {changes} |\n")


CHECKS: dict[str, Callable[[list[str]], None]] = {"fronts": fronts, "resins": resins, "orders": orders}

if __name__ == "__main__":
    CHECKS[sys.argv[1]](sys.argv[2:])
