"""Graded membranes against constant ones: the solid's figures of each, and the constant mix nearest to a target."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.prediction import Limits
from pneutouch.mechanics.rating import RATED_SHARE
from pneutouch.mechanics.sensor import Sensor
from pneutouch.selection.mixes import greatest
from pneutouch.selection.problem import CandidateResin, SelectionProblem

ENOUGH = 0.5
"""A trial that uses no more than this share of every tolerance ends a search for the same sensitivity."""
_LEAST_GAIN = 1e-3
"""Gain promised by the surface through the trials, of a tolerance or of the force, below which a search ends."""
_SPARE_TRIALS = 0.9
"""Share of a tolerance that the surface may use up for the widest range: it is not exact."""
_LATTICE = 51
_APART = 2e-3
"""Trials lie at least so far from one another, as a share of the greatest fraction."""
_FEWEST = 4
_SURFACES = ("linear", "thin_plate_spline")
"""Radial bases in the order tried: the first does not ring where figures jump, since another event ends the range;
the second follows a smooth course better."""
_DIGITS = 4
"""Digits of a fraction: a hundredth of a percent, finer than a droplet pattern resolves."""
_LIMITS = ("limit pressure", "force range")
_MISSED = 1.0e3
"""Violation of a trial without figures."""


@dataclass(frozen=True)
class GradeTarget:
    """Aims of a grade: sensitivity (kPa/N) at each pressure (MPa) within a share, equal at all within ``same_within``.

    force: what the range must reach (N); None if it need not. widest: True for the widest force range."""

    sensitivity: float
    tolerance: float
    pressures: tuple[float, ...]
    same_within: float | None
    force: float | None
    widest: bool


@dataclass(frozen=True)
class GradeTrial:
    """One membrane and the solid's figures: fractions at pole and rim; by pressure, sensitivity and force range's end
    (NaN without figures), the highest pressure of the search (MPa, a share of the least limit as designed), what ends
    the ranges, why there are no figures, and the rated pressure (MPa)."""

    pole: float
    rim: float
    sensitivity: tuple[float, ...]
    force: tuple[float, ...]
    highest: float
    ends: tuple[str, ...] = ()
    note: str = ""
    rated: float = np.nan

    @property
    def difference(self) -> float:
        """Sensitivity at the last pressure over that at the first, less one."""
        return self.sensitivity[-1] / self.sensitivity[0] - 1.0

    @property
    def reach(self) -> float:
        """Force that the range reaches at every pressure, N."""
        return float(min(self.force))


@dataclass(frozen=True)
class GradeSearch:
    """The best trial; ``met``: True if it meets the target; all trials in order, each solved once by the solid."""

    best: GradeTrial
    met: bool
    trials: tuple[GradeTrial, ...]


TryGrade = Callable[[float, float], GradeTrial]
TrialReport = Callable[[GradeTrial, int, int], None]


def shares(target: GradeTarget, trial: GradeTrial) -> dict[str, float]:
    """Share of each tolerance or limit that a trial uses, by name: at most 1 if it is kept."""
    values = np.array(trial.sensitivity)
    if not np.isfinite(values).all() or values.min() <= 0.0:
        return {"no figures": _MISSED}
    used_share = {"sensitivity": float(np.abs(values / target.sensitivity - 1.0).max()) / target.tolerance}
    if target.same_within is not None:
        used_share["same sensitivity"] = abs(trial.difference) / target.same_within
    used_share["limit pressure"] = max(target.pressures) / trial.highest
    if target.force is not None:
        used_share["force range"] = target.force / max(trial.reach, 1e-9)
    return used_share


def cost(target: GradeTarget, trial: GradeTrial, spare: float = 1.0) -> float:
    """Cost that the search minimizes: the worst share of the aims; for the widest range, less with force once all hold.

    ``spare`` is the share of every tolerance that may be used up for the widest range.
    """
    used = shares(target, trial)
    if target.widest:
        worst = max(used.values()) / spare
        return 100.0 + 10.0 * (worst - 1.0) if worst > 1.0 else -float(np.log(max(trial.reach, 1e-9)))
    # The limit pressure and a force range are limits, not aims: nothing is gained far inside them.
    return max(value for name, value in used.items() if name not in _LIMITS or value > 1.0)


def grade_search(target: GradeTarget, levels: Array, solve: TryGrade, progress: TrialReport, most: int) -> GradeSearch:
    """Fractions at pole and rim between the ends of ``levels``, rising fractions (n,), that meet a target.

    A scan of all pairs of levels, soft ones first; then the best place on a surface through all trials is tried, and
    again with that trial in it. It stops where a trial uses at most half of every tolerance, or where the surface
    promises no gain. ``most`` bounds the trials of both together.
    """
    trials: list[GradeTrial] = []

    def tried(pole: float, rim: float) -> None:
        trials.append(solve(pole, rim))
        progress(trials[-1], len(trials), most)

    for pole in np.round(levels, _DIGITS):
        for rim in np.round(levels, _DIGITS):
            if len(trials) < most and not _done(target, trials):
                tried(float(pole), float(rim))
    while len(trials) < most and not _done(target, trials):
        looks = (_promising(target, float(levels[-1]), trials, surface) for surface in _SURFACES)
        place = next((look for look in looks if look is not None), None)
        if place is None:
            break
        tried(*place)
    best = min(trials, key=lambda trial: cost(target, trial))
    return GradeSearch(best, max(shares(target, best).values()) <= 1.0, tuple(trials))


def _done(target: GradeTarget, trials: list[GradeTrial]) -> bool:
    return not target.widest and any(
        max(shares(target, trial).values()) <= 1.0 and cost(target, trial) <= ENOUGH for trial in trials
    )


def _promising(target: GradeTarget, top: float, trials: list[GradeTrial], surface: str) -> tuple[float, float] | None:
    """Fractions of least cost, not tried yet, on the surface through the trials; None if it promises no gain."""
    if len([trial for trial in trials if np.isfinite(trial.sensitivity).all()]) < _FEWEST:
        return None
    centre, width, best = np.array([0.5 * top, 0.5 * top]), 0.5 * top, np.inf
    for _ in range(2):
        axes = [np.linspace(max(c - width, 0.0), min(c + width, top), _LATTICE) for c in centre]
        places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2).round(_DIGITS)
        costs = _expected(target, top, trials, places, surface)
        k = int(np.argmin(costs))
        centre, best, width = places[k], float(costs[k]), 2 * width / (_LATTICE - 1)
    gain = min(cost(target, trial) for trial in trials) - best
    return (float(centre[0]), float(centre[1])) if gain > _LEAST_GAIN else None


def _expected(target: GradeTarget, top: float, trials: list[GradeTrial], places: Array, surface: str) -> Array:
    """Cost at places (n, 2) by a surface through the logarithms of sensitivities, forces and limit pressures, (n,).

    Infinite next to a trial and where the nearest one has no figures.
    """
    from scipy.interpolate import RBFInterpolator

    known = [trial for trial in trials if np.isfinite(trial.sensitivity).all()]
    at = np.array([(t.pole, t.rim) for t in known]) / top
    table = np.log([[*t.sensitivity, *np.maximum(t.force, 1e-9), t.highest] for t in known])
    values = np.exp(RBFInterpolator(at, table, kernel=surface, degree=1)(places / top))
    n = len(target.pressures)
    costs = np.array(
        [
            cost(target, GradeTrial(0.0, 0.0, tuple(v[:n]), tuple(v[n : 2 * n]), v[-1]), _SPARE_TRIALS)
            for v in values.tolist()
        ]
    )
    every = np.array([(t.pole, t.rim) for t in trials])
    away = np.hypot(*np.moveaxis(places[:, None, :] - every[None, :, :], -1, 0)) / top
    unknown = np.array([not np.isfinite(t.sensitivity).all() for t in trials])
    return np.where((away.min(axis=1) < _APART) | unknown[away.argmin(axis=1)], np.inf, costs)


_FRACTIONS = 401
"""Number of constant fractions that the atlas evaluates."""
_SPARE = 0.8
"""Share of a tolerance within which the atlas looks for the widest range: the solid, solved next, differs a little."""
_WALLS = 60


@dataclass(frozen=True)
class UniformMembrane:
    """A membrane of one material with the sizes of the graded one; ``fraction`` None: a resin of the catalogue."""

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
    """Trial of a sensor by the solid; NaN and a reason without figures. ``rate``: rated pressure of its limits."""
    from pneutouch.mechanics.models.solid import solid_result

    unknown = (np.nan,) * len(pressures)
    try:
        result = solid_result(sensor.replace(waves=0), np.array(pressures), past_limit=1.0)
    except ComputationError as error:
        return GradeTrial(pole, rim, unknown, unknown, 1e-12, note=str(error))
    sensitivities_kPa_per_N, forces, ends = [], [], []
    for state in result.states:
        figures = state.figures
        sensitivities_kPa_per_N.append(np.nan if figures is None else figures.sensitivity)
        forces.append(np.nan if figures is None else figures.reach)
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
        respond(one_resin.batch(numbers, size[0] * ones, size[1] * ones, pressure * ones), problem.steps, problem.atlas)
        for pressure in target.pressures
    ]
    lines = [answer.lines for answer in answers]
    sensitivity = np.stack([line.sensitivity for line in lines], axis=1) * factor
    costs = np.array(
        [
            cost(
                target,
                GradeTrial(
                    at[k],
                    at[k],
                    tuple(sensitivity[k].tolist()),
                    tuple(float(line.reach[k]) for line in lines),
                    RATED_SHARE * float(np.fmin(answers[0].limit_pressure[k], problem.gauge_limit)),
                ),
                _SPARE,
            )
            for k in range(at.size)
        ]
    )
    known = np.isfinite(sensitivity).all(axis=1)
    if not known.any():
        return None
    best = int(np.argmin(np.where(known, costs, np.inf)))
    return float(at[best]), sensitivity[best]


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
    response = respond(
        problem.batch(0 * ones, radius * ones, walls, target.pressures[0] * ones), problem.steps, problem.atlas
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.abs(np.log(response.lines.sensitivity / target.sensitivity))
    return None if not np.isfinite(off).any() else round(float(walls[np.nanargmin(off)]), 2)
