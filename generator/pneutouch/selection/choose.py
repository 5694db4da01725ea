"""From candidates to an answer: the few best of each resin, or the requirements that prevent one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Index, distinct
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import ENDS, respond
from pneutouch.mechanics.corrected.designs import ContactFigures
from pneutouch.mechanics.uncertainty.contact_model import place_uncertainties
from pneutouch.mechanics.uncertainty.propagate import COVERAGE
from pneutouch.selection.candidates import (
    REQUIREMENTS,
    CandidatePool,
    evaluated,
    joined,
    margins,
    nearer,
    rated,
    search,
)
from pneutouch.selection.problem import CandidateResin, SelectionProblem

EACH = 3
"""Number of candidates of one resin that are examined closely."""
_APART = 1.1
"""Candidates of one resin must differ by this factor in wall ratio or driving pressure to count as two."""
_DIGITS = 2
"""Sizes are given to a hundredth of a millimetre, below what any of the printers resolves."""

_REFINABLE = 0.1
"""Relative distance of a sensitivity that refining meets: a mix's fractions lie less than twice as far apart."""

_UNKNOWN = -1.0e9

_FAR = 0.02
"""Least margin that binds nothing: above what rounding a size moves."""

_UNCOVERED = 10.0
"""Value taken for the uncertainty by the place of contact of a candidate that the table does not cover."""

MARGIN_WEIGHT = 0.1
"""Weight of the least margin in the cost."""

Uncertainty = Callable[[Sequence[tuple[CandidateResin, SensorBatch]]], list[Array]]
"""Function that gives the relative expanded uncertainties (n,) of the sensitivity for the sensors of each resin."""

Refine = Callable[[SelectionProblem, CandidatePool], tuple[SelectionProblem, CandidatePool]]
"""Function that adjusts the resins of candidates at round sizes; it returns them in a problem of these resins."""


@dataclass(frozen=True)
class Candidate:
    """One candidate with all that it is judged by.

    margins: margins by name. expanded: relative expanded uncertainty of the sensitivity. span: sensitivities at zero
    and at the rated pressure. rated: rated pressure, MPa. cost: key of the ranking, less is better. place: relative
    standard uncertainty of the sensitivity by an unknown place of contact, None if it is not counted or not known.
    contact: figures by the solid, for a contact outside the atlas; else None.
    """

    resin: CandidateResin
    pool: CandidatePool
    margins: dict[str, float]
    expanded: float
    span: tuple[float, float]
    rated: float
    cost: float
    contact: ContactFigures | None = None
    place: float | None = None

    @property
    def ends_with(self) -> str:
        """Event that ends the range of force, or the depth."""
        return ENDS[int(self.pool.response.ends[0])] if self.contact is None else self.contact.ends_with

    @property
    def binding(self) -> str:
        """The limit or requirement with the least margin. The sensitivity, which the search aims at, counts only where
        it is missed far from every limit: no size that was searched is nearer."""
        other = min((name for name in self.margins if name != "sensitivity"), key=lambda name: self.margins[name])
        return "sensitivity" if self.margins.get("sensitivity", 0.0) < 0.0 and self.margins[other] > _FAR else other

    @property
    def binding_margin(self) -> str:
        """The margin of what binds, %; of a missed sensitivity that no size comes nearer."""
        return "no size is nearer" if self.binding == "sensitivity" else f"{100 * self.margins[self.binding]:+.0f} %"


@dataclass(frozen=True)
class DroppedRequirement:
    """A requirement without which there is a design, and the design that then comes nearest to it."""

    requirement: str
    best: Candidate


@dataclass(frozen=True)
class SelectionResult:
    """Result of a selection. designs: the best of each resin first, in order of cost, then the runners-up in order of
    cost. candidates: number of candidates searched. Without designs: the candidate nearest to the target, None if
    unknown, and the single requirements of which any can be dropped for a design."""

    designs: list[Candidate]
    nearest: Candidate | None
    dropped: list[DroppedRequirement]
    candidates: int


def choose(
    problem: SelectionProblem,
    weights: tuple[float, float],
    uncertainty: Uncertainty,
    refine: Refine | None = None,
    *,
    thorough: bool = True,
) -> SelectionResult:
    """Search, keep what meets every limit, and rank it; weights on robustness and on tunability.

    Without ``thorough`` only the scan is searched, in a fifth of the time of a search that finds nothing.
    """
    pool = searched(problem)
    if pool is None:
        return SelectionResult([], None, [], 0)
    good = _good(problem, pool, weights, uncertainty, refine)
    if not good and thorough:
        # Nothing on the scan, or nothing of it at round sizes.
        pool = joined([nearer(problem, pool), pool])
        good = _good(problem, pool, weights, uncertainty, refine)
    if good:
        return SelectionResult(ranked(good), None, [], pool.resin.size)
    return _impossible(problem, pool, weights, uncertainty) if thorough else SelectionResult([], None, [], 0)


def _good(
    problem: SelectionProblem,
    pool: CandidatePool,
    weights: tuple[float, float],
    uncertainty: Uncertainty,
    refine: Refine | None,
) -> list[Candidate]:
    """The candidates on the shortlist that meet every limit at round sizes."""
    wide = margins(problem if refine is None else refinable(problem), pool)
    fits = np.all([margin >= 0.0 for margin in wide.values()], axis=0)
    rows = shortlist(pool, wide, fits, preferred=_least_moved(problem, pool, weights, fits))
    if not rows.size:
        return []
    close = rounded(problem, pool.take(rows))
    refined_problem, close = (problem, close) if refine is None else refine(problem, close)
    judged = _judged(refined_problem, close, weights, uncertainty)
    return [choice for choice in judged if min(choice.margins.values()) >= 0.0]


def searched(problem: SelectionProblem) -> CandidatePool | None:
    """The candidates of a search; None without resins or where no size can be searched at all."""
    if not problem.resins:
        return None
    pool = search(problem)
    if pool is not None:
        return pool
    # No size keeps the size limits: the search without them finds what is nearest, and what to drop.
    return search(replace(problem, max_diameter=None, max_footprint=None))


def refinable(problem: SelectionProblem) -> SelectionProblem:
    """The problem with a tolerance so wide that refining a mix meets the sensitivity within it."""
    return replace(problem, tolerance=max(problem.tolerance, _REFINABLE))


def least_margin(margin_of: dict[str, Array]) -> Array:
    """Least margin of each candidate except the sensitivity's, (n,), at most 1."""
    rest = [margin for name, margin in margin_of.items() if name != "sensitivity"]
    return np.asarray(np.minimum(np.min(rest, axis=0), 1.0))


def shortlist(
    pool: CandidatePool, margin_of: dict[str, Array], fits: Flags, each: int = EACH, preferred: Array | None = None
) -> Index:
    """Rows of a few unlike candidates of each resin among ``fits``, by greatest margin plus ``preferred`` (n,)."""
    least = least_margin(margin_of) + 0.5 * margin_of.get("sensitivity", np.zeros_like(pool.radius))
    least = least if preferred is None else least + preferred
    chosen: list[int] = []
    for resin in distinct(pool.resin[fits]):
        rows = np.flatnonzero(fits & (pool.resin == resin))
        kept: list[int] = []
        for row in rows[np.argsort(-least[rows], kind="stable")]:
            if all(differ(pool, row, other) for other in kept):
                kept.append(int(row))
            if len(kept) == each:
                break
        chosen += kept
    return np.array(chosen, dtype=np.intp)


def _least_moved(
    problem: SelectionProblem, pool: CandidatePool, weights: tuple[float, float], fits: Flags
) -> Array | None:
    """Addition (n,) to the margins of candidates, never positive, for an unknown place of contact, as the ranking
    weighs it; None if the target does not count it. Candidates that the table does not cover come last."""
    if not problem.anywhere:
        return None
    known = np.full(fits.shape, np.nan)
    known[fits] = places(problem, pool.take(fits))
    return np.asarray(-weights[0] * COVERAGE * np.nan_to_num(known, nan=_UNCOVERED) / MARGIN_WEIGHT)


def places(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """Relative standard uncertainty (n,) of the sensitivity by an unknown place of contact; NaN if not known."""
    batch = problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
    return place_uncertainties(batch, pool.response)


def differ(pool: CandidatePool, a: int, b: int) -> bool:
    """True if two candidates of one resin differ enough to count as two."""
    ratio = (pool.wall[a] / pool.radius[a]) / (pool.wall[b] / pool.radius[b])
    high, low = max(pool.pressure[a], pool.pressure[b]), min(pool.pressure[a], pool.pressure[b])
    return bool(max(ratio, 1 / ratio) >= _APART or high > _APART * low + 1e-3)


def rounded(problem: SelectionProblem, pool: CandidatePool) -> CandidatePool:
    """The candidates at round sizes, still inside the atlas and the size limit; given sizes stay as given."""
    unit, box = 10.0**-_DIGITS, problem.recipe
    radius = pool.radius if problem.inner_radius is not None else np.floor(pool.radius / unit + 1e-6) * unit
    wall = pool.wall
    if problem.wall_thickness is not None and problem.inner_radius is None:
        radius = np.maximum(radius, np.ceil(wall / (box.thickest * unit) - 1e-6) * unit)
    if problem.wall_thickness is None:
        low = np.maximum(box.thinnest * radius, problem.least_wall)
        wall = np.clip(np.round(wall / unit), np.ceil(low / unit - 1e-9), np.floor(box.thickest * radius / unit)) * unit
    radius, wall = np.round(radius, _DIGITS + 4), np.round(wall, _DIGITS + 4)
    pressure = pool.pressure if problem.driving_pressure is not None else np.round(pool.pressure, 4)
    return evaluated(problem, pool.resin, radius, wall, pressure)


def _judged(
    problem: SelectionProblem, pool: CandidatePool, weights: tuple[float, float], uncertainty: Uncertainty
) -> list[Candidate]:
    margin_of = margins(problem, pool)
    least = least_margin(margin_of)
    highest, span = _span(problem, pool)
    expanded = np.full(pool.radius.size, np.nan)
    batch = problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
    place = places(problem, pool) if problem.anywhere else np.full(pool.radius.size, np.nan)
    numbers = distinct(pool.resin)
    groups = [(problem.resins[int(number)], batch.take(pool.resin == number)) for number in numbers]
    for number, known in zip(numbers, uncertainty(groups), strict=True):
        expanded[pool.resin == number] = known
    cost = costs(weights, expanded, span, least)
    return [
        Candidate(
            problem.resins[int(pool.resin[i])],
            pool.take(np.array([i])),
            {name: float(m[i]) for name, m in margin_of.items()},
            float(expanded[i]),
            (float(span[0][i]), float(span[1][i])),
            float(highest[i]),
            float(cost[i]),
            place=float(place[i]) if np.isfinite(place[i]) else None,
        )
        for i in range(pool.radius.size)
    ]


def costs(weights: tuple[float, float], expanded: Array, span: tuple[Array, Array], least: Array) -> Array:
    """Key of the ranking (n,), less is better, by uncertainties, sensitivities at zero and rated pressure, margins."""
    with np.errstate(invalid="ignore", divide="ignore"):
        moves = np.abs(np.log(span[1] / span[0]))
    return np.asarray(
        weights[0] * np.nan_to_num(expanded, nan=1.0) - weights[1] * np.nan_to_num(moves) - MARGIN_WEIGHT * least
    )


def _span(problem: SelectionProblem, pool: CandidatePool) -> tuple[Array, tuple[Array, Array]]:
    """Rated driving pressures, and the sensitivities at zero and at rated pressure, (n,) each."""
    highest = rated(problem, pool.resin, pool.radius, pool.wall)
    pressure = np.concatenate([np.zeros_like(highest), highest])
    resin, radius, wall = (np.tile(column, 2) for column in (pool.resin, pool.radius, pool.wall))
    batch = problem.batch(resin, radius, wall, pressure)
    none, most = respond(batch, problem.steps, problem.atlas).lines.sensitivity.reshape(2, -1)
    return highest, (none, most)


def ranked(choices: list[Candidate]) -> list[Candidate]:
    """The best of each resin in order of cost, then the others in order of cost."""
    ordered = sorted(choices, key=lambda choice: (choice.cost, choice.resin.name))
    first: dict[str, Candidate] = {}
    for choice in ordered:
        first.setdefault(choice.resin.name, choice)
    best = list(first.values())
    return best + [choice for choice in ordered if choice not in best]


_NEAREST = 30
"""Number of candidates that are rounded to find the nearest: rounding can move one out of the atlas."""


def _least(margin_of: dict[str, Array]) -> Array:
    """Least margin of each candidate, (n,); unknown margins count as `_UNKNOWN`."""
    every = np.array(list(margin_of.values()))
    return np.asarray(np.where(np.isneginf(every), _UNKNOWN, every).min(axis=0))


def _impossible(
    problem: SelectionProblem, pool: CandidatePool, weights: tuple[float, float], uncertainty: Uncertainty
) -> SelectionResult:
    """Result with the candidate that breaks the least at round sizes, and the requirements to drop for a design; with
    it as the design if it breaks none."""
    margin_of = margins(problem, pool)

    def close(row: int) -> Candidate:
        return _judged(problem, rounded(problem, pool.take(np.array([row]))), weights, uncertainty)[0]

    rows = np.argsort(-_least(margin_of), kind="stable")[:_NEAREST]
    at_round_sizes = _least(margins(problem, rounded(problem, pool.take(rows))))
    nearest = close(int(rows[at_round_sizes.argmax()])) if at_round_sizes.max() > _UNKNOWN else None
    if nearest is not None and min(nearest.margins.values()) >= 0.0:
        return SelectionResult([nearest], None, [], pool.resin.size)
    dropped = []
    for requirement in REQUIREMENTS:
        if requirement not in margin_of:
            continue
        rest = np.all([margin >= 0.0 for name, margin in margin_of.items() if name != requirement], axis=0)
        if rest.any():
            row = int(np.flatnonzero(rest)[np.argmax(margin_of[requirement][rest])])
            dropped.append(DroppedRequirement(requirement, close(row)))
    return SelectionResult([], nearest, dropped, pool.resin.size)


_MOST = ("outer diameter", "footprint", "break strain", "gauge range")
"""Margins to a value that must not be exceeded; the others are to one that must be reached."""


def missed_percent(problem: SelectionProblem, candidate: Candidate) -> dict[str, float | None]:
    """Broken requirements and limits, and how far each value is off, percent of the required one, None if not known."""
    broken = {name: margin for name, margin in candidate.margins.items() if margin < 0}
    return {
        name: _off(problem, candidate, name, margin) if np.isfinite(margin) else None for name, margin in broken.items()
    }


def _off(problem: SelectionProblem, candidate: Candidate, name: str, margin: float) -> float:
    figures = candidate.pool.figures
    if name == "sensitivity":
        assert problem.sensitivity is not None
        return 100.0 * abs(figures.sensitivity / problem.sensitivity - 1.0)
    if name == "stiffness":
        least, most = problem.stiffness
        stiffness = figures.stiffness_at(problem.stiffness_depth)
        bound = least if least is not None and stiffness < least else most
        assert bound is not None
        return 100.0 * abs(stiffness / bound - 1.0)
    # A margin to a greatest value is relative to the candidate's own.
    return 100.0 * (1.0 / (1.0 + margin) - 1.0 if name in _MOST else -margin)
