"""Relaxation of a resin's modulus as a Prony series, with its source."""

from __future__ import annotations

import math
from itertools import pairwise

from pydantic import Field, model_validator

from pneutouch.spec.fields import Table


class RelaxationTerm(Table):
    """One term of a Prony series."""

    share: float = Field(gt=0, lt=1, description="Of the instantaneous modulus.")
    time_s: float = Field(gt=0, description="Relaxation time.")


class Relaxation(Table):
    """Fall of a resin's modulus after a step of strain, over its first value: 1 - sum of share (1 - exp(-t/time_s))."""

    terms: list[RelaxationTerm] = Field(min_length=1, max_length=20, description="In ascending order of time_s.")
    temperature_C: float | None = Field(default=None, description="Temperature of the test, if known.")
    source: str = Field(min_length=8, description="Table, page, DOI or measurement; how far it was verified.")

    @model_validator(mode="after")
    def _relaxes_to_a_solid(self) -> Relaxation:
        total = math.fsum(term.share for term in self.terms)
        if not total < 1:
            raise ValueError(f"terms: shares add up to {total:.9g}; it must be less than 1, so that a modulus is left")
        times = [term.time_s for term in self.terms]
        for k, (before, after) in enumerate(pairwise(times)):
            if not after > before:
                raise ValueError(f"terms[{k + 1}].time_s = {after:g}: must be more than the one before, {before:g}")
        return self
