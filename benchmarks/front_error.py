"""How far the fronts of a datasheet's trade-off under another contact lie off the solid, for docs/contact.md.

``python -m benchmarks.front_error [DESIGN kPa KEY=VALUE ...]`` presses random places of each front with the solid and
prints a row a place; without words it does so for three contacts.
"""

from __future__ import annotations

import sys

import numpy as np

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.charts import resized, tradeoff_problem
from pneutouch.selection.contact_front import contact_front, place
from pneutouch.selection.contact_trial import tried
from pneutouch.spec.read import parse_changes

CASES = (
    ("paper-dome", "22", "contact.friction=0.6"),
    ("paper-dome", "0", "contact.friction=inf"),
    ("paper-dome", "10", "contact.object=ball", "contact.ball_radius_mm=10"),
)
EACH, SEED, NEAR = 2, 5, 0.02


def errors(design: str, pressure_kPa: float, changes: list[str]) -> list[tuple[float, float]]:
    """Logarithms of sensitivity and force of the fronts over the solid's, at random places of each."""
    pressure = {"pneumatics.driving_pressures_kPa": [pressure_kPa], "indentation.checked_waves": 0}
    evaluation = evaluate(design, {**parse_changes(changes), **pressure})
    problem = tradeoff_problem(evaluation, 1e-3 * pressure_kPa)
    solve, draw, found = resized(evaluation.sensor, problem), np.random.default_rng(SEED), []
    drawn = contact_front(problem, solve)
    sys.stdout.write(f"{design}: stated {100 * drawn.median_error:.1f} %, {100 * drawn.greatest_error:.1f} %\n")
    for number, one in enumerate(drawn.fronts):
        for row in draw.integers(0, one.force.size, EACH if one.force.size > 1 else 0):
            trial = tried(problem, place(problem, number, one, int(row)), solve)
            if trial.why:
                sys.stdout.write(f"| {one.resin.name} | {trial.why} |\n")
                continue
            exact_kPa_per_N, force = trial.pool.response.lines.sensitivity_kPa_per_N[0], trial.pool.force[0]
            found.append((np.log(one.sensitivity_kPa_per_N[row] / exact_kPa_per_N), np.log(one.force[row] / force)))
            off = " | ".join(f"{100 * log:+.1f} %" for log in found[-1])
            sys.stdout.write(f"| {one.resin.name} | {exact_kPa_per_N:.3g} kPa/N | {off} |\n")
            sys.stdout.flush()
    return found


def main(words: list[str]) -> None:
    """Print the places, and how many are near in both."""
    worst = []
    for design, pressure_kPa, *changes in [words] if words else CASES:
        found = np.abs(errors(design, float(pressure_kPa), changes))
        worst += found.max(axis=1).tolist()
        sys.stdout.write(f"{design}, {pressure_kPa} kPa, {' '.join(changes)}: greatest {100 * found.max():.1f} %\n")
    share = f"{sum(one <= NEAR for one in worst)} of {len(worst)} within {100 * NEAR:g} %"
    sys.stdout.write(f"{share}; greatest {100 * max(worst):.1f} %, median {100 * np.median(worst):.2f} %\n")


if __name__ == "__main__":
    main(sys.argv[1:])
