"""How far the fronts of a datasheet's trade-off under another contact lie off the solid, for docs/background/contact.md.

``python -m benchmarks.front_error [DESIGN kPa KEY=VALUE ...]`` presses random places of each front with the solid and
prints a row a place; without words it does so for three contacts.
"""

from __future__ import annotations

import sys

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.charts import resized, tradeoff_problem
from pneutouch.selection.contact_front import ContactFronts, contact_front, place
from pneutouch.selection.contact_trial import tried
from pneutouch.spec.read import parse_changes
from pneutouch.units import KPA

CASES = (
    ("paper-dome", "22", "contact.friction=0.6"),
    ("paper-dome", "0", "contact.friction=inf"),
    ("paper-dome", "10", "contact.object=ball", "contact.ball_radius_mm=10"),
)
EACH, SEED = 2, 5


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
            exact_kPa_per_N, force = trial.pool.response.lines.sensitivity_kPa_per_N[0], trial.pool.force[0]
            found.append((np.log(one.sensitivity_kPa_per_N[row] / exact_kPa_per_N), np.log(one.force[row] / force)))
            off = ", ".join(f"{100 * log:+.1f} %" for log in found[-1])
            sys.stdout.write(f"{one.resin.name} at {exact_kPa_per_N:.3g} kPa/N: {off}\n")
            sys.stdout.flush()
    return drawn, np.array(found)


def main(words: list[str]) -> None:
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


if __name__ == "__main__":
    main(sys.argv[1:])
