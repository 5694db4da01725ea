"""Uncertainty of the difference of two predicted figures: sources that both sensors share cancel in part."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
from pneutouch.mechanics.uncertainty.sources.model import MODEL, MODEL_CORRELATION

_OF_RESIN = ("published modulus", "mixing fraction", "ageing of the modulus", "ageing")
"""Sources that are one unknown number for all sensors in one resin, of one age."""


@dataclass(frozen=True, slots=True)
class SourceEffect:
    """Effect of one standard uncertainty of a source on the logarithm of a figure, with its sign."""

    name: str
    origin: str
    size: float


def effects_of(uncertainty: UncertaintyRecord, figure: str) -> tuple[SourceEffect, ...]:
    """Effects of every source on a figure, from a state's uncertainty document; their squares sum to its variance."""
    entry = uncertainty["figures"][figure]
    total, slopes = entry["standard_uncertainty_relative"], uncertainty["elasticities"][figure]
    origins: dict[str, str] = {}
    inputs: dict[str, set[str]] = {}
    for source in uncertainty["sources"]:
        if figure in source["figures"]:
            origins[source["name"]] = source["origin"]
            inputs.setdefault(source["name"], set()).add(source["acts_on"])
    effects = []
    for name, share in entry["shares"].items():
        # What acts on several inputs at once has no sign that holds for it alone.
        acts_on = inputs.get(name, set())
        slope = slopes.get(next(iter(acts_on)), 1.0) if len(acts_on) == 1 else 1.0
        effects.append(SourceEffect(name, origins.get(name, ""), math.copysign(total * math.sqrt(share), slope)))
    return tuple(effects)


def variance_of_ratio(first: Sequence[SourceEffect], second: Sequence[SourceEffect], *, same_resin: bool) -> float:
    """Variance of the logarithm of the ratio of two figures (JCGM 100, 5.2.2).

    Of sensors in the same resin, the sources on the resin are taken as fully correlated, the model's error by
    `MODEL_CORRELATION` where both have it from the same measurements. All else is taken as independent.
    """
    total = sum(effect.size**2 for effect in (*first, *second))
    if not same_resin:
        return total
    second_by_name = {effect.name: effect for effect in second}
    for one in first:
        other = second_by_name.get(one.name)
        if other is not None:
            total -= 2 * _coefficient(one, other) * one.size * other.size
    return max(total, 0.0)


def _coefficient(one: SourceEffect, other: SourceEffect) -> float:
    if one.name in _OF_RESIN:
        return 1.0
    # The calibrated parameters are several unknowns, whose effects two states weigh differently: as one unknown they
    # would cancel where they do not. Taken as independent they do not cancel at all, which errs on the wide side.
    return MODEL_CORRELATION if one.name == MODEL and one.origin == other.origin else 0.0
