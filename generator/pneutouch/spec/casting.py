"""Mixing, pouring and curing of a resin that is cast, as its vendor's sheet gives them."""

from __future__ import annotations

import math

from pydantic import Field, model_validator

from pneutouch.spec.fields import Table
from pneutouch.spec.quantity import Quantity

SHRINKAGE_PERCENT = (0.0, 10.0)
"""Bounds of `Casting.shrinkage_percent`, linear: addition-cured silicones shrink by about 0.1 %, condensation-cured
ones by up to some percent; more is a number in another unit."""

CAST_SEAT = "clamped-flange-M2"
"""Seat of a cast membrane where nothing else is stated: no glue but silicone's own bonds silicone."""

_MOST = {"pot_life_min": 1e4, "cure_h": 1e4, "mixed_viscosity_Pa_s": 1e5}


class Casting(Table):
    """[casting] of a material: its parts by mass, the time to work in, and what spoils its cure."""

    parts_by_mass: list[float] = Field(min_length=1, max_length=3, description="Parts A, B ... by mass.")
    pot_life_min: Quantity = Field(description="From mixing until it no longer flows, at room temperature, min.")
    cure_h: Quantity = Field(description="Until it can be taken out of the mould, at room temperature, h.")
    shrinkage_percent: Quantity = Field(description="Linear, mould to part, after a cure at room temperature.")
    mixed_viscosity_Pa_s: Quantity | None = Field(default=None, description="Of all parts mixed, before the cure.")
    release: str = Field(min_length=3, description="Release agent between it and a printed mould.")
    inhibited_by: list[str] = Field(description="Matter that the liquid does not cure against.")
    source: str = Field(min_length=8, description="Of the ratio, the release agent and the inhibition.")

    @model_validator(mode="after")
    def _can_be_mixed(self) -> Casting:
        for index, part in enumerate(self.parts_by_mass):
            if not part > 0:
                raise ValueError(f"parts_by_mass[{index}] = {part:g}: must be more than 0")
        for key, most in _MOST.items():
            quantity: Quantity | None = getattr(self, key)
            for number in () if quantity is None else (quantity.value, quantity.low, quantity.high):
                if number is not None and not 0 < number <= most:
                    raise ValueError(f"{key}: {number:g} must be more than 0 and at most {most:g}")
        low, high = SHRINKAGE_PERCENT
        for number in (self.shrinkage_percent.value, self.shrinkage_percent.low, self.shrinkage_percent.high):
            if number is not None and not low <= number <= high:
                raise ValueError(f"shrinkage_percent: {number:g} must be from {low:g} to {high:g} %")
        return self

    def masses_g(self, total_g: float) -> list[float]:
        """The mass of each part, g, of ``total_g`` of the mixed liquid."""
        whole = math.fsum(self.parts_by_mass)
        return [total_g * part / whole for part in self.parts_by_mass]
