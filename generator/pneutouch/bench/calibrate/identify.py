"""What the data cannot tell apart, the beliefs left aside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.bench.calibrate.intervals import information
from pneutouch.bench.calibrate.parameters import LOGARITHMIC

CORRELATED = 0.95
"""Correlation from which on two parameters count as not told apart: our choice; alone each is 3 times less sure than with
the other known."""

UNSEEN = 0.7
"""Share of the belief's standard deviation left, from which on the data say nothing of a parameter: our choice; they then
weigh no more than the belief."""

_LEAST = 1e-12
_NEEDED = 0.5
"""Share of the belief's standard deviation that the data alone leave, from which on more than two parameters count as not told
apart: our choice."""
_MEMBER = 0.3
_SAID = 0.25
"""Least weight of a parameter in a group that cannot be told apart, and of one in a named combination."""


@dataclass(frozen=True, slots=True)
class CorrelatedParameters:
    """Parameters that the data know together better than apart.

    Attributes:
        members: Their numbers.
        correlation: Greatest correlation among them, in the data alone, with its sign.
        alone: Standard deviation of each by the scatter of the data alone, were the model true; of modulus and wall relative, of the dead volume mm3, of the
            offset mm.
        given: The same were the others known.
        combination: Exponents of modulus and wall in the product that is known, where they are the members; else None.
    """

    members: tuple[int, ...]
    correlation: float
    alone: Array
    given: Array
    combination: float | None


@dataclass(frozen=True, slots=True)
class Identifiability:
    """Numbers of parameters that the data say nothing of (beside those of an ambiguity), and the ambiguities."""

    unseen: tuple[int, ...]
    ambiguities: tuple[CorrelatedParameters, ...]

    @property
    def clear(self) -> bool:
        """Whether the data tell everything apart."""
        return not self.unseen and not self.ambiguities


def identify(fit: CalibrationFit) -> Identifiability:
    """What the data of a fit leave open, from the small eigenvalues of their information in unit scale."""
    fitted = np.array(fit.parameters.fitted)
    seen = np.abs(fit.solution.jacobian).max(axis=0) > 0
    places = np.flatnonzero(seen)
    numbers, known = fitted[places], fit.covariance.information[np.ix_(places, places)]
    # What leans on what is a matter of the model's curves; how sure it leaves each, of all that is uncertain.
    curves = information(fit.solution.jacobian[:, places])
    found = _groups(curves, known, numbers, fit.parameters.belief[numbers]) if places.size > 1 else []
    grouped = {k for group in found for k in group.members}
    unseen = [
        int(k) for place, k in enumerate(fitted)
        if k not in grouped and not fit.solution.bound[place] and _left(fit, place, bool(seen[place])) > UNSEEN
    ]  # fmt: skip
    return Identifiability(tuple(unseen), tuple(found))


def _left(fit: CalibrationFit, place: int, seen: bool) -> float:
    """Standard deviation with belief and data over that of the belief."""
    if not seen:
        return 1.0
    belief = fit.parameters.belief[list(fit.parameters.fitted)]
    whole = fit.covariance.information * np.outer(belief, belief) + np.eye(belief.size)
    return float(np.sqrt(np.linalg.inv(whole)[place, place]))


def _groups(curves: Array, known: Array, numbers: Array, belief: Array) -> list[CorrelatedParameters]:
    """Sets of parameters along the directions that the curves, by their information (n, n), hold least of.

    ``known``, (n, n), is the information with what many values share taken into account.
    """
    scale = np.sqrt(np.diag(curves))
    values, vectors = np.linalg.eigh(curves / np.outer(scale, scale))
    covariance = (vectors / np.maximum(values, _LEAST)) @ vectors.T / np.outer(scale, scale)
    spread = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(spread, spread) - np.eye(numbers.size)
    sets = [np.flatnonzero(np.abs(v) > _MEMBER) for v in vectors[:, values < 1.0 - CORRELATED].T]
    # Three or four together always lean on one another; it matters where a belief is still needed.
    alone = _spreads(known)
    sets = [places for places in sets if (alone / belief)[places].max() > _NEEDED]
    sets += [np.array(pair) for pair in np.argwhere(np.triu(np.abs(correlation) > CORRELATED))]
    found: list[CorrelatedParameters] = []
    for places in sorted(sets, key=len, reverse=True):
        members = {int(numbers[p]) for p in places}
        if len(members) < 2 or any(members <= set(group.members) for group in found):
            continue
        inner = correlation[np.ix_(places, places)]
        strongest = float(inner.ravel()[np.abs(inner).argmax()])
        found.append(CorrelatedParameters(
            tuple(int(numbers[p]) for p in places), strongest, spread[places], 1.0 / scale[places],
            _product(covariance[np.ix_(places, places)], numbers[places]),
        ))  # fmt: skip
    return found


def _spreads(known: Array) -> Array:
    """Standard deviations (n,) by information (n, n)."""
    scale = np.sqrt(np.diag(known))
    values, vectors = np.linalg.eigh(known / np.outer(scale, scale))
    return np.asarray(np.sqrt(((vectors**2) / np.maximum(values, _LEAST)).sum(axis=1)) / scale)


def _product(covariance: Array, numbers: Array) -> float | None:
    """Exponent a of the product modulus x wall^a that is known best, for the pair of both."""
    if numbers.size != 2 or not LOGARITHMIC[numbers].all():
        return None
    # Along the ridge d ln mu = -a d ln t0; the ridge is the direction of the greatest variance.
    ridge = np.linalg.eigh(covariance)[1][:, -1]
    return float(-ridge[0] / ridge[1]) if abs(ridge[1]) > _SAID else None
