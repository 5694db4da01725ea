"""How far the datasheet's curves of other resins under friction lie off the solid, for docs/background/contact.md.

``python -m benchmarks.resin_curves [DESIGN ...]`` prints the greatest difference of each curve at nine pressures.
"""

from __future__ import annotations

import sys

import numpy as np

from pneutouch.errors import ComputationError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.variants import in_resin, resin_curves
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.solid_states import solid_states
from pneutouch.units import KPA

DESIGNS, FRICTION, POINTS = ("paper-dome", "soft-pad", "agilus-dome"), 0.6, 9


def _by_solid(sensor: Sensor, pressure_kPa: float) -> float:
    """Sensitivity in kPa/N; NaN where there is none."""
    try:
        (state,) = solid_states(sensor.replace(waves=0), np.array([pressure_kPa * KPA]))
    except ComputationError:
        return np.nan
    return np.nan if state.figures is None else state.figures.sensitivity_kPa_per_N


def main(words: list[str]) -> None:
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
            drawn = np.interp(grid, known, curve.sensitivity_kPa_per_N)
            whole = np.array([_by_solid(in_resin(sensor, materials[title]), p) for p in grid])
            worst.append(float(np.nanmax(np.abs(np.log(drawn / whole)))))
            sys.stdout.write(f"| {design} | {title} | {100 * worst[-1]:.2f} % |\n")
            sys.stdout.flush()
    share = f"{sum(one <= 0.01 for one in worst)} of {len(worst)} within 1 %"
    sys.stdout.write(f"{share}; greatest {100 * max(worst):.1f} %, mean {100 * np.mean(worst):.1f} %\n")


if __name__ == "__main__":
    main(sys.argv[1:])
