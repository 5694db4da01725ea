"""A mix of two resins as something to choose: fractions tried as if each were a resin, the best met exactly."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array, Index, bisected
from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.selection.candidates import CandidatePool, evaluated, margins
from pneutouch.selection.problem import CandidateResin, SelectionProblem

LEVELS = 15
"""Number of fractions tried, even in the logarithm of the modulus: 16 % apart for TangoPlus and VeroClear."""
_KEPT = 6
"""Number of candidates whose fraction is refined."""
_POLISH = 12
_DIGITS = 4
"""Digits of a fraction: a hundredth of a percent, finer than a droplet pattern resolves."""

MixedResin = Callable[[float], CandidateResin]
"""Function that gives the mix with a volume fraction as a resin."""


def greatest(law: ResolvedMixingCurve) -> float:
    """Greatest fraction at which a mix is offered: every curve of its pair reaches it, and no wall is too stiff."""
    return min(law.wall_top, law.curve.common_top)


def levels(law: ResolvedMixingCurve, count: int = LEVELS) -> Array:
    """Fractions (count,) even in the logarithm of the modulus, from the soft resin to `greatest`.

    Beyond the last point of the stiffest curve a mix may be rigid, if that curve is true: it is not offered.
    """
    fine = np.linspace(0.0, greatest(law), 2001)
    logs = np.log(law.modulus_at(fine))
    return np.interp(np.linspace(logs[0], logs[-1], count), logs, fine)


def met_by_fraction(
    problem: SelectionProblem, pool: CandidatePool, law: ResolvedMixingCurve, mixed: MixedResin
) -> tuple[SelectionProblem, CandidatePool]:
    """The best few candidates, with fractions at which they meet the sensitivity at their sizes and pressures.

    Returns a problem whose resins are these mixes, one each, and the candidates evaluated. A fraction is bisected where
    two neighbouring ones bracket the sensitivity; else it stays as it is.
    """
    pool = pool.take(_best(problem, pool))
    at = np.array([_fraction(problem.resins[int(number)]) for number in pool.resin])
    if problem.sensitivity is not None:
        at = _bisected(problem, pool, law, at)
    places = np.stack([np.round(at, _DIGITS), pool.radius, pool.wall, pool.pressure])
    once = np.sort(np.unique(places, axis=1, return_index=True)[1])
    pool, at = pool.take(once), places[0, once]
    resins = tuple(mixed(float(fraction)) for fraction in at)
    mix_problem = replace(problem, resins=resins)
    return mix_problem, evaluated(
        mix_problem, np.arange(len(resins), dtype=float), pool.radius, pool.wall, pool.pressure
    )


def _fraction(resin: CandidateResin) -> float:
    assert resin.grade is not None
    return resin.grade.fractions[0]


def _best(problem: SelectionProblem, pool: CandidatePool) -> Index:
    """Rows of the candidates with the greatest margin, at most one for each fraction."""
    margin_list = [margin for name, margin in margins(problem, pool).items() if name != "sensitivity"]
    order = np.argsort(-np.minimum(np.min(margin_list, axis=0), 1.0), kind="stable")
    return order[np.sort(np.unique(pool.resin[order], return_index=True)[1])[:_KEPT]]


def _bisected(problem: SelectionProblem, pool: CandidatePool, law: ResolvedMixingCurve, at: Array) -> Array:
    """Fractions (n,), between those next to ``at``, at which the sensitivity is the target; else those of ``at``."""
    assert problem.sensitivity is not None
    known = levels(law)
    index = np.clip(np.searchsorted(known, at - 1e-9), 0, known.size - 1)
    low, high = known[np.maximum(index - 1, 0)], known[np.minimum(index + 1, known.size - 1)]

    target_kPa_per_N = problem.sensitivity

    def off(fraction: Array) -> Array:
        resins = tuple(
            replace(problem.resins[int(number)], shear_modulus=float(modulus))
            for number, modulus in zip(pool.resin, law.modulus_at(fraction), strict=True)
        )
        numbers = np.arange(len(resins), dtype=float)
        pool_there = evaluated(replace(problem, resins=resins), numbers, pool.radius, pool.wall, pool.pressure)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(np.log(pool_there.response.lines.sensitivity / target_kPa_per_N))

    a, b = off(low), off(high)
    root = bisected(lambda fraction: -np.sign(a) * off(fraction), low, high, _POLISH)
    return np.where(a * b <= 0.0, root, at)
