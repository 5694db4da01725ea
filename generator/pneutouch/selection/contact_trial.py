"""A candidate that the solid answered under a contact that the atlas does not cover."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import AtlasResponse
from pneutouch.mechanics.prediction import SensorState
from pneutouch.selection.choose import Candidate, costs, least_margin
from pneutouch.selection.contact_factors import ContactFactors, places
from pneutouch.selection.contact_figures import ContactFigures, ending, solid_response
from pneutouch.selection.pool import CandidatePool, evaluated, margins
from pneutouch.selection.problem import CandidateResin, SelectionProblem
from pneutouch.selection.rated import rated

_SETTLED = 0.25
"""Share of the tolerance within which a sensitivity counts as settled."""

UNSOLVED = -1.0e9
"""The least margin of a candidate that the solid gives no figures of."""


class SolvedStates(NamedTuple):
    """States of the solid at driving pressures, or why there are none."""

    states: tuple[SensorState, ...]
    problem: str = ""


SolveCandidate = Callable[[CandidateResin, CandidatePool, list[float]], SolvedStates]
"""The design of a candidate (one row) as the solid answers it with its contact, at driving pressures in MPa, rising."""

ContactUncertainty = Callable[[CandidateResin, CandidatePool, SensorState], float]
"""Relative expanded uncertainty of the sensitivity of a candidate (one row) under its contact, from its solved state;
NaN if unknown."""


@dataclass(frozen=True, eq=False)
class ContactTrial:
    """A candidate with the solid's figures.

    problem: of its resin alone, without factors. pool: one row, with the solid's response; the atlas's where ``why``
    is why there is none. atlas: the atlas's response. margins: by the solid; empty without its figures. state: the
    solid's, where it has figures.
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
        """The least of all margins."""
        return min(self.margins.values(), default=UNSOLVED)

    @property
    def place(self) -> Array:
        """Its row of `places`, (1, 4)."""
        return places(self._batch(), self.atlas)

    @property
    def settled(self) -> bool:
        """True if it keeps everything, and the sensitivity within a quarter of the tolerance."""
        return self.worst >= 0.0 and self.margins.get("sensitivity", 1.0) >= 1.0 - _SETTLED

    @property
    def off_target_alone(self) -> bool:
        """True if it keeps everything but the sensitivity."""
        rest = [margin for name, margin in self.margins.items() if name != "sensitivity"]
        return min(rest, default=UNSOLVED) >= 0.0 and self.worst < 0.0

    def added_to(self, factors: ContactFactors) -> ContactFactors:
        """The factors with those of this candidate."""
        return factors if self.why else factors.with_sample(self.place, self.atlas, self.pool.response)

    def candidate(
        self, solve: SolveCandidate, weights: tuple[float, float], uncertainty: ContactUncertainty, rounds: int
    ) -> Candidate:
        """The trial as a candidate, with the uncertainty and the span under its contact, by the solid."""
        highest = float(rated(self.problem, self.pool.resin, self.pool.radius, self.pool.wall)[0])
        span = self._span(solve, highest)
        known = np.nan if self.state is None else uncertainty(self.resin, self.pool, self.state)
        least = least_margin({name: np.array([margin]) for name, margin in self.margins.items()})
        cost = costs(weights, np.array([known]), (np.array([span[0]]), np.array([span[1]])), least)
        plate_kPa_per_N = float(self.atlas.lines.sensitivity_kPa_per_N[0])
        how = ContactFigures("" if self.state is None else ending(self.state), plate_kPa_per_N, rounds)
        return Candidate(self.resin, self.pool, self.margins, known, span, highest, float(cost[0]), how)

    def _batch(self) -> SensorBatch:
        return self.problem.batch(self.pool.resin, self.pool.radius, self.pool.wall, self.pool.pressure)

    def _span(self, solve: SolveCandidate, highest: float) -> tuple[float, float]:
        """Sensitivities at no pressure and at the rated one; NaN if the solid has none."""
        pressures = [0.0, highest]
        driven = float(self.pool.pressure[0])
        solved = {driven: float(self.pool.response.lines.sensitivity_kPa_per_N[0])}
        missing = [p for p in pressures if p not in solved]
        if missing:
            answer = solve(self.resin, self.pool, missing)
            states = answer.states or [None] * len(missing)
            for p, state in zip(missing, states, strict=True):
                figures = None if state is None else state.figures
                solved[p] = np.nan if figures is None else figures.sensitivity_kPa_per_N
        return solved[0.0], solved[highest]


def tried(problem: SelectionProblem, pool: CandidatePool, solve: SolveCandidate) -> ContactTrial:
    """A candidate (one row) solved."""
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
