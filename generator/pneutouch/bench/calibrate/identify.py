"""Parameters that the data alone, without priors, cannot determine."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.bench.calibrate.intervals import information
from pneutouch.bench.calibrate.parameters import LOGARITHMIC

CORRELATED = 0.95
"""Correlation above which two parameters count as strongly correlated: our choice; the standard deviation of each is
then 3 times that with the other known."""

UNSEEN = 0.7
"""Share of the prior standard deviation that remains, above which a parameter counts as not determined by the data: our
choice; they then weigh no more than the prior."""

_LEAST = 1e-12
_NEEDED = 0.5
"""Share of the prior standard deviation that the data alone leave, above which more than two parameters count as
strongly correlated: our choice."""
_MEMBER = 0.3
_NAMED = 0.25
"""Least weight of a parameter in a correlated group, and of one in a named combination."""


@dataclass(frozen=True, slots=True)
class CorrelatedParameters:
    """Strongly correlated parameters.

    Attributes:
        members: Their numbers.
        correlation: Greatest correlation among them, in the data alone, with its sign.
        alone: Standard deviation of each by the scatter of the data alone, were the model true; of modulus and wall
            relative, of the dead volume mm3, of the offset mm.
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
    """Numbers of parameters that the data do not determine (without those of an ambiguity), and the ambiguities."""

    unseen: tuple[int, ...]
    ambiguities: tuple[CorrelatedParameters, ...]

    @property
    def clear(self) -> bool:
        """True if the data determine every parameter."""
        return not self.unseen and not self.ambiguities


def identify(fit: CalibrationFit) -> Identifiability:
    """Parameters that the data of a fit leave open, from the small eigenvalues of their information in unit scale."""
    fitted = np.array(fit.parameters.fitted)
    seen = np.abs(fit.solution.jacobian).max(axis=0) > 0
    places = np.flatnonzero(seen)
    numbers, known = fitted[places], fit.covariance.information[np.ix_(places, places)]
    # Correlations follow from the model's curves alone; standard deviations from all that is uncertain.
    curves = information(fit.solution.jacobian[:, places])
    groups = _groups(curves, known, numbers, fit.parameters.prior_spread[numbers]) if places.size > 1 else []
    grouped = {k for group in groups for k in group.members}
    unseen = [
        int(k)
        for place, k in enumerate(fitted)
        if k not in grouped and not fit.solution.bound[place] and _left(fit, place, bool(seen[place])) > UNSEEN
    ]
    return Identifiability(tuple(unseen), tuple(groups))


def _left(fit: CalibrationFit, place: int, seen: bool) -> float:
    """Standard deviation with prior and data over that of the prior."""
    if not seen:
        return 1.0
    prior_spread = fit.parameters.prior_spread[list(fit.parameters.fitted)]
    whole = fit.covariance.information * np.outer(prior_spread, prior_spread) + np.eye(prior_spread.size)
    return float(np.sqrt(np.linalg.inv(whole)[place, place]))


def _groups(curves: Array, known: Array, numbers: Array, prior_spread: Array) -> list[CorrelatedParameters]:
    """Sets of parameters along the directions that the curves, by their information (n, n), hold least of.

    ``known``, (n, n), is the information with what many values share taken into account.
    """
    scale = np.sqrt(np.diag(curves))
    values, vectors = np.linalg.eigh(curves / np.outer(scale, scale))
    covariance = (vectors / np.maximum(values, _LEAST)) @ vectors.T / np.outer(scale, scale)
    spread = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(spread, spread) - np.eye(numbers.size)
    sets = [np.flatnonzero(np.abs(v) > _MEMBER) for v in vectors[:, values < 1.0 - CORRELATED].T]
    # Three or four parameters are always correlated; it matters where a prior is still needed.
    alone = _spreads(known)
    sets = [places for places in sets if (alone / prior_spread)[places].max() > _NEEDED]
    sets += [np.array(pair) for pair in np.argwhere(np.triu(np.abs(correlation) > CORRELATED))]
    groups: list[CorrelatedParameters] = []
    for places in sorted(sets, key=len, reverse=True):
        members = {int(numbers[p]) for p in places}
        if len(members) < 2 or any(members <= set(group.members) for group in groups):
            continue
        inner = correlation[np.ix_(places, places)]
        strongest = float(inner.ravel()[np.abs(inner).argmax()])
        numbered = tuple(int(numbers[p]) for p in places)
        product = _product(covariance[np.ix_(places, places)], numbers[places])
        groups.append(CorrelatedParameters(numbered, strongest, spread[places], 1.0 / scale[places], product))
    return groups


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
    return float(-ridge[0] / ridge[1]) if abs(ridge[1]) > _NAMED else None
