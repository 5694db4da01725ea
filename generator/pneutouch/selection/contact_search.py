"""The search under a contact that the atlas does not cover: the atlas corrected by the solid.

Space mapping: each round searches the atlas times the factors that the solid gave so far, and solves what it finds.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import AtlasResponse
from pneutouch.mechanics.corrected.designs import ContactFactors, ContactFigures, ending, places, solid_response
from pneutouch.mechanics.prediction import SensorState
from pneutouch.selection.candidates import REQUIREMENTS, CandidatePool, evaluated, joined, margins, rated
from pneutouch.selection.choose import (
    EACH,
    Candidate,
    DroppedRequirement,
    Refine,
    SelectionResult,
    costs,
    differ,
    least_margin,
    ranked,
    refinable,
    rounded,
    searched,
    shortlist,
)
from pneutouch.selection.problem import CandidateResin, SelectionProblem

_SETTLED = 0.25
"""Share of the tolerance within which the sensitivity of a settled candidate lies."""

UNSOLVED = -1.0e9
"""Least margin of a candidate for which the solid gives no figures."""


class SolvedStates(NamedTuple):
    """States of the solid at driving pressures; or none, and the ``problem`` why."""

    states: tuple[SensorState, ...]
    problem: str = ""


SolveCandidate = Callable[[CandidateResin, CandidatePool, list[float]], SolvedStates]
"""Function that solves a candidate (pool of one row) by the solid under its contact, at rising pressures in MPa."""

ContactUncertainty = Callable[[CandidateResin, CandidatePool, SensorState], float]
"""Function that gives the relative expanded uncertainty of the sensitivity of a candidate (one row) under its contact,
from its solved state; NaN if unknown."""


@dataclass(frozen=True, eq=False)
class ContactTrial:
    """A candidate with the solid's figures.

    problem: the problem of its resin only, without factors. pool: one row, with the solid's response, or the atlas's if
    there is none for the reason ``why``. atlas: the atlas's response. margins: margins by the solid; empty without
    figures. state: state of the solid; None without figures.
    """

    resin: CandidateResin
    problem: SelectionProblem
    pool: CandidatePool
    atlas: AtlasResponse
    margins: dict[str, float]
    state: SensorState | None = None
    why: str = ""

    @property
    def worst(self) -> float:
        """The least of all margins; `UNSOLVED` without figures."""
        return min(self.margins.values(), default=UNSOLVED)

    @property
    def place(self) -> Array:
        """Place of the candidate as `places` gives it, (1, 4)."""
        return places(self._batch(), self.atlas)

    @property
    def settled(self) -> bool:
        """True if the candidate keeps every limit, and the sensitivity within a quarter of the tolerance."""
        return self.worst >= 0.0 and self.margins.get("sensitivity", 1.0) >= 1.0 - _SETTLED

    @property
    def off_target_alone(self) -> bool:
        """True if the candidate keeps every limit but the sensitivity."""
        rest = [margin for name, margin in self.margins.items() if name != "sensitivity"]
        return min(rest, default=UNSOLVED) >= 0.0 and self.worst < 0.0

    def added_to(self, factors: ContactFactors) -> ContactFactors:
        """``factors`` with those of this candidate added."""
        return factors if self.why else factors.with_sample(self.place, self.atlas, self.pool.response)

    def candidate(
        self, solve: SolveCandidate, weights: tuple[float, float], uncertainty: ContactUncertainty, rounds: int
    ) -> Candidate:
        """The trial as a candidate; uncertainty and span of sensitivities by the solid, under its contact."""
        highest = float(rated(self.problem, self.pool.resin, self.pool.radius, self.pool.wall)[0])
        span = self._span(solve, highest)
        known = np.nan if self.state is None else uncertainty(self.resin, self.pool, self.state)
        least = least_margin({name: np.array([margin]) for name, margin in self.margins.items()})
        cost = costs(weights, np.array([known]), (np.array([span[0]]), np.array([span[1]])), least)
        plate_kPa_per_N = float(self.atlas.lines.sensitivity[0])
        how = ContactFigures("" if self.state is None else ending(self.state), plate_kPa_per_N, rounds)
        return Candidate(self.resin, self.pool, self.margins, known, span, highest, float(cost[0]), how)

    def _batch(self) -> SensorBatch:
        return self.problem.batch(self.pool.resin, self.pool.radius, self.pool.wall, self.pool.pressure)

    def _span(self, solve: SolveCandidate, highest: float) -> tuple[float, float]:
        """Sensitivities at zero and at the rated pressure ``highest`` (MPa); NaN if the solid has none."""
        pressures = [0.0, highest]
        solved = {float(self.pool.pressure[0]): self.pool.figures.sensitivity}
        missing = [p for p in pressures if p not in solved]
        if missing:
            states = solve(self.resin, self.pool, missing).states or [None] * len(missing)
            for p, state in zip(missing, states, strict=True):
                figures = None if state is None else state.figures
                solved[p] = np.nan if figures is None else figures.sensitivity
        return solved[0.0], solved[highest]


def tried(problem: SelectionProblem, pool: CandidatePool, solve: SolveCandidate) -> ContactTrial:
    """Trial of a candidate (one row), solved by the solid."""
    resin = problem.resins[int(pool.resin[0])]
    alone = replace(problem, resins=(resin,), factors=None)
    plain = evaluated(alone, np.zeros(1), pool.radius, pool.wall, pool.pressure)
    answer = solve(resin, plain, [float(pool.pressure[0])])
    if not answer.states:
        return ContactTrial(resin, alone, plain, plain.response, {}, why=answer.problem)
    state = answer.states[0]
    response = solid_response(state, plain.response)
    if response is None:
        why = f"the range ends at first contact: {ending(state)}"
        return ContactTrial(resin, alone, plain, plain.response, {}, why=why)
    solved = plain._replace(response=response)
    margin_of = {name: float(margin[0]) for name, margin in margins(alone, solved).items()}
    return ContactTrial(resin, alone, solved, plain.response, margin_of, state)


ROUNDS = 8
"""Greatest number of searches in a run."""
_ANYWHERE = 2
"""Number of searches that take the best anywhere; the later ones stay near the solved candidates."""
_FEW = 2
"""Number of resins up to which each is followed at several candidates; of more, each only at its best."""
_PROBED, _WITHOUT_FIT = 3, 4
"""Number of resins whose nearest candidate is solved although none fits by the corrected atlas, and for how many
rounds.
"""


@dataclass
class _Group:
    """Candidates that are followed together: those of one resin, or of all mixes.

    last: unsettled candidates of the last round. rounds: searches until the last of them was solved.
    """

    last: list[ContactTrial] = field(default_factory=list)
    trials: list[ContactTrial] = field(default_factory=list)
    rounds: int = 0
    done: bool = False


@dataclass(frozen=True)
class ContactSelection:
    """An answer whose figures are the solid's. unsettled: reason why the search did not come to an end, by resin.

    rounds: searches made. solves: candidates that the solid was run for.
    """

    result: SelectionResult
    unsettled: dict[str, str]
    rounds: int
    solves: int


def choose_by_solid(
    problem: SelectionProblem,
    weights: tuple[float, float],
    uncertainty: ContactUncertainty,
    solve: SolveCandidate,
    refine: Refine | None = None,
) -> ContactSelection:
    """Choose as `choose` does, under a contact that only the solid answers.

    A candidate is settled where it keeps every limit and the sensitivity within a quarter of the tolerance, all by the
    solid. One that keeps the tolerance when nothing nearer is found is an answer too.
    """
    run = _Run(problem, solve, refine)
    while run.searching():
        run.round()
    solved = run.solved
    designs = [
        trial.candidate(solve, weights, uncertainty, group.rounds)
        for group in run.groups.values()
        for trial in _best(group.trials, run.each)
    ]
    result = SelectionResult(ranked(designs), None, [], run.candidates)
    if not designs and solved:
        result = _impossible(run, weights, uncertainty)
    return ContactSelection(result, run.unsettled(), run.rounds, len(run.solved))


class _Run:
    """The state of one search: factors, groups and solved candidates, from round to round."""

    def __init__(self, problem: SelectionProblem, solve: SolveCandidate, refine: Refine | None) -> None:
        self.problem, self.solve, self.refine = problem, solve, refine
        names = [resin.name for resin in problem.resins] if refine is None else ["mix"] if problem.resins else []
        self.groups = {name: _Group() for name in names}
        self.each = EACH if len(names) <= _FEW else 1
        self.factors, self.rounds, self.candidates = ContactFactors.none(), 0, 0
        self._known: dict[tuple[object, ...], ContactTrial] = {}

    @property
    def solved(self) -> list[ContactTrial]:
        """All candidates that the solid was run for."""
        return list(self._known.values())

    def searching(self) -> bool:
        return self.rounds < ROUNDS and not all(group.done for group in self.groups.values())

    def corrected(self) -> SelectionProblem:
        """The problem of the resins that are not done, with the factors found so far."""
        open_ = tuple(r for r in self.problem.resins if not self.groups[self._group(r.name)].done)
        return replace(self.problem, resins=open_, factors=self.factors if len(self.factors.places) else None)

    def round(self) -> None:
        """Search, and solve the candidates found; a group is finished when it has settled or finds nothing new."""
        self.rounds += 1
        problem = self.corrected()
        pool = searched(problem)
        if pool is None:
            for group in self.groups.values():
                group.done = True
            return
        self.candidates = max(self.candidates, pool.resin.size)
        margin_of = margins(problem if self.refine is None else refinable(problem), pool)
        names = np.array([self._group(resin.name) for resin in problem.resins])[pool.resin.astype(np.intp)]
        worst = np.min(list(margin_of.values()), axis=0)
        least = {name: float(worst[names == name].max()) for name in dict.fromkeys(names.tolist())}
        for name in self._followed(least):
            self._follow(self.groups[name], problem, pool, margin_of, names == name)

    def _followed(self, least: dict[str, float]) -> list[str]:
        """Groups to solve in this round, best margin first: groups that fit, or the nearest to it if none does.

        The first round waits for the factors of others, which may make more of them fit.
        """
        fit = [name for name, margin in least.items() if margin >= 0.0]
        known = sorted((name for name in least if least[name] > -np.inf), key=lambda name: -least[name])
        chosen = fit or (known[:_PROBED] if self.rounds <= _WITHOUT_FIT else [])
        if self.rounds > 1 or not chosen:
            for name, group in self.groups.items():
                group.done = group.done or name not in (fit or chosen)
        return chosen

    def _follow(
        self, group: _Group, problem: SelectionProblem, pool: CandidatePool, margin_of: dict[str, Array], rows_of: Flags
    ) -> None:
        close = rounded(problem, pool.take(self._rows(group, problem, pool, margin_of, rows_of)))
        refined, close = (problem, close) if self.refine is None else self.refine(problem, close)
        count = min(len(close.radius), self.each)
        solved = [self.trial(refined, close.take(np.array([i]))) for i in range(count)]
        new = [trial for trial in solved if trial not in group.trials]
        group.rounds, group.trials = self.rounds, group.trials + new
        # What has settled, and what comes back unchanged, is not followed further.
        group.last = [trial for trial in new if not trial.settled]
        group.done = not group.last

    def _rows(
        self, group: _Group, problem: SelectionProblem, pool: CandidatePool, margin_of: dict[str, Array], rows_of: Flags
    ) -> Index:
        """Candidates that fit: the best anywhere, later those nearest to the last; else those that break the least."""
        fits = rows_of & np.all([margin >= 0.0 for margin in margin_of.values()], axis=0)
        if not fits.any():
            return np.array([np.where(rows_of, np.min(list(margin_of.values()), axis=0), -np.inf).argmax()])
        if self.rounds <= _ANYWHERE or not group.last:
            return shortlist(pool, margin_of, fits, self.each)
        rows = np.flatnonzero(fits)
        batch = problem.batch(pool.resin[rows], pool.radius[rows], pool.wall[rows], pool.pressure[rows])
        where = places(batch, pool.response.take(rows))
        nearest = [int(np.linalg.norm(where - trial.place, axis=1).argmin()) for trial in group.last]
        return rows[np.unique(nearest)]

    def trial(self, problem: SelectionProblem, pool: CandidatePool) -> ContactTrial:
        """Trial of a candidate, solved once only; its figures correct the next search."""
        resin = problem.resins[int(pool.resin[0])]
        key = (resin.name, resin.shear_modulus, float(pool.radius[0]), float(pool.wall[0]), float(pool.pressure[0]))
        if key not in self._known:
            self._known[key] = tried(problem, pool, self.solve)
            self.factors = self._known[key].added_to(self.factors)
        return self._known[key]

    def unsettled(self) -> dict[str, str]:
        """Reason why a resin has no design, by resin: the last candidate not solved, or the rounds not settled."""
        return {name: why for name, group in self.groups.items() if (why := self._why(group)) is not None}

    def _why(self, group: _Group) -> str | None:
        if not group.trials or any(trial.worst >= 0.0 for trial in group.trials):
            return None
        last = group.trials[-1]
        if last.why:
            return last.why
        if group.rounds < ROUNDS or not last.off_target_alone:
            return None
        return (
            f"the search did not settle in {group.rounds} rounds: at the last the solid's sensitivity is "
            f"{last.pool.figures.sensitivity:.3g} kPa/N instead of {self.problem.sensitivity:g}"
        )

    def _group(self, resin: str) -> str:
        return resin if self.refine is None else "mix"


def _best(trials: list[ContactTrial], each: int) -> list[ContactTrial]:
    """The answers of one group, ``each`` at most and not nearly the same, the greatest margin first."""
    good = [trial for trial in trials if trial.worst >= 0.0]
    if not good:
        return []
    pool = joined([trial.pool for trial in good])
    order = sorted(range(len(good)), key=lambda k: -_quality(good[k]))
    kept: list[int] = []
    for k in order:
        if len(kept) < each and all(differ(pool, k, other) for other in kept):
            kept.append(k)
    return [good[k] for k in kept]


def _quality(trial: ContactTrial) -> float:
    rest = [margin for name, margin in trial.margins.items() if name != "sensitivity"]
    return min(1.0, *rest) + 0.5 * trial.margins.get("sensitivity", 0.0)


def _impossible(run: _Run, weights: tuple[float, float], uncertainty: ContactUncertainty) -> SelectionResult:
    """The solved candidate that breaks the least, and each requirement without which a solved one is a design."""

    def choice(trial: ContactTrial) -> Candidate:
        return trial.candidate(run.solve, weights, uncertainty, run.rounds)

    _solve_without_each(run)
    solved = run.solved
    nearest = max(solved, key=lambda trial: trial.worst)
    dropped = []
    for requirement in REQUIREMENTS:
        rest = [
            trial
            for trial in solved
            if requirement in trial.margins and min(m for name, m in trial.margins.items() if name != requirement) >= 0
        ]
        if rest:
            best = max(rest, key=lambda trial: trial.margins[requirement])
            dropped.append(DroppedRequirement(requirement, choice(best)))
    return SelectionResult([], choice(nearest) if nearest.worst > UNSOLVED else None, dropped, run.candidates)


def _solve_without_each(run: _Run) -> None:
    """Solve the candidate that the corrected atlas finds best without each requirement."""
    problem = replace(run.problem, factors=run.factors if len(run.factors.places) else None)
    pool = searched(problem)
    if pool is None:
        return
    margin_of = margins(problem, pool)
    for requirement in REQUIREMENTS:
        rest = np.all([margin >= 0.0 for name, margin in margin_of.items() if name != requirement], axis=0)
        if requirement in margin_of and rest.any():
            row = np.flatnonzero(rest)[np.argmax(margin_of[requirement][rest])]
            run.trial(problem, rounded(problem, pool.take(np.array([row]))))
