"""Graded membranes against constant ones: the solid's figures of each, and the constant mix nearest to a target."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.limits import RATED_SHARE, Limits
from pneutouch.mechanics.sensor import Sensor
from pneutouch.selection.grade_search import GradeTarget, GradeTrial, cost
from pneutouch.selection.mixes import greatest
from pneutouch.selection.problem import CandidateResin, SelectionProblem

_FRACTIONS = 401
"""Constant fractions that the atlas evaluates."""
_SPARE = 0.8
"""Share of a tolerance within which the atlas looks for the widest range: the solid, solved next, differs a little."""
_WALLS = 60


@dataclass(frozen=True)
class UniformMembrane:
    """A membrane of one material, of the size of the graded one. ``fraction`` is None for a catalogue resin."""

    name: str
    fraction: float | None
    trial: GradeTrial


def trial_of(
    sensor: Sensor,
    pressures: tuple[float, ...],
    rate: Callable[[Limits], float],
    pole: float = np.nan,
    rim: float = np.nan,
) -> GradeTrial:
    """Figures of a sensor by the solid; NaN with the reason where it has none. ``rate``: limits to a rated pressure."""
    from pneutouch.mechanics.solid_states import solid_result

    unknown = (np.nan,) * len(pressures)
    try:
        result = solid_result(sensor.replace(waves=0), np.array(pressures), past_limit=1.0)
    except ComputationError as error:
        return GradeTrial(pole, rim, unknown, unknown, 1e-12, note=str(error))
    sensitivities_kPa_per_N, forces, ends = [], [], []
    for state in result.states:
        figures = state.figures
        sensitivities_kPa_per_N.append(np.nan if figures is None else figures.sensitivity_kPa_per_N)
        reach = np.nan if figures is None else figures.force_range[1]
        saturated = None if figures is None else figures.saturation_force
        forces.append(reach if saturated is None else min(reach, saturated))
        ends.append(next((event.kind for event in state.events if event.ends_range), "depth"))
    return GradeTrial(
        pole,
        rim,
        tuple(sensitivities_kPa_per_N),
        tuple(forces),
        RATED_SHARE * result.limits.lowest,
        tuple(ends),
        rated=rate(result.limits),
    )


def nearest_fraction(
    target: GradeTarget,
    problem: SelectionProblem,
    law: ResolvedMixingCurve,
    size: tuple[float, float],
    factor: Array | float = 1.0,
) -> tuple[float, Array] | None:
    """The constant fraction nearest to a target at inner radius and wall (mm), by the atlas, with its sensitivities
    (kPa/N) by pressure; None without an answer.

    ``factor`` is the solid's sensitivity over the atlas's, by pressure.
    """
    at = np.linspace(0.0, greatest(law), _FRACTIONS)
    strain = law.elongation_at(at) / 100.0
    resins = tuple(
        CandidateResin("", problem.resins[0].material, float(modulus), float(stretch))
        for modulus, stretch in zip(law.modulus_at(at), 1.0 + np.nan_to_num(strain, nan=np.inf), strict=True)
    )
    one_resin, ones, numbers = replace(problem, resins=resins), np.ones(at.size), np.arange(at.size, dtype=float)
    answers = [
        respond(one_resin.batch(numbers, size[0] * ones, size[1] * ones, pressure * ones), problem.steps)
        for pressure in target.pressures
    ]
    lines = [answer.lines for answer in answers]
    sensitivity_kPa_per_N = np.stack([line.sensitivity_kPa_per_N for line in lines], axis=1) * factor
    costs = np.array(
        [
            cost(
                target,
                GradeTrial(
                    at[k],
                    at[k],
                    tuple(sensitivity_kPa_per_N[k].tolist()),
                    tuple(float(np.fmin(line.force_high[k], line.saturation_force[k])) for line in lines),
                    RATED_SHARE * float(np.fmin(answers[0].limit_pressure[k], problem.gauge_limit)),
                ),
                _SPARE,
            )
            for k in range(at.size)
        ]
    )
    known = np.isfinite(sensitivity_kPa_per_N).all(axis=1)
    if not known.any():
        return None
    best = int(np.argmin(np.where(known, costs, np.inf)))
    return float(at[best]), sensitivity_kPa_per_N[best]


def middle_wall(target: GradeTarget, problem: SelectionProblem, radius: float, thickest: float) -> float | None:
    """The wall (mm) at which the problem's one resin has the target sensitivity, by the atlas; None without an answer.

    With a mix of middle modulus either end of a grade is then free to be softer or stiffer.
    """
    box = problem.recipe
    low, high = max(problem.least_wall, box.thinnest * radius), min(thickest, box.thickest * radius)
    if low >= high:
        return None
    walls: Array = np.geomspace(low, high, _WALLS)
    ones = np.ones(_WALLS)
    response = respond(problem.batch(0 * ones, radius * ones, walls, target.pressures[0] * ones), problem.steps)
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.abs(np.log(response.lines.sensitivity_kPa_per_N / target.sensitivity_kPa_per_N))
    return None if not np.isfinite(off).any() else round(float(walls[np.nanargmin(off)]), 2)
