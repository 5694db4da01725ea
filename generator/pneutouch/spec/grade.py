"""A graded membrane: two base resins mixed droplet by droplet, evenly or along the arc."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from pneutouch.errors import shown
from pneutouch.spec.fields import Table

MOST_KNOTS = 12
"""Knots a grade may have: a wall of a few bending lengths shows no more."""


def _one_or_many(value: Any) -> str:
    return "<many>" if isinstance(value, list) else "<one>"


FractionOrMany = Annotated[
    Annotated[float, Tag("<one>")] | Annotated[list[float], Tag("<many>")], Discriminator(_one_or_many)
]


class Grade(Table):
    """[membrane] material as a table: ``{ from = "TangoPlus", to = "VeroClear", fraction = 0.2 }``.

    ``fraction`` is the volume fraction of ``to``: one number, or values at knots along the arc from the pole (0) to
    the rim (1), monotone cubic between them. ``at`` are the knots; left out, they are even. ``curve`` names one of the
    pair's mixing curves; left out, it is the first.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False, populate_by_name=True)

    from_: str = Field(alias="from", min_length=1, description="Soft base resin.")
    to: str = Field(min_length=1, description="Stiff base resin.")
    fraction: FractionOrMany = Field(
        description="from 0 to 1, the volume fraction of the stiff one, or a list of them."
    )
    at: list[float] | None = Field(default=None, description="Knots along the arc, 0 at the pole, 1 at the rim.")
    curve: str | None = Field(
        default=None, min_length=1, description="Mixing curve by name, if the pair's file has more than one."
    )

    @model_validator(mode="after")
    def _sound(self) -> Grade:
        for value in self.fractions:
            if not 0 <= value <= 1:
                raise ValueError(f"fraction = {value:g}: must be from 0 to 1")
        if self.from_ == self.to:
            raise ValueError(f"to = {shown(self.to)}: must be another resin than from")
        if isinstance(self.fraction, float):
            if self.at is not None:
                raise ValueError("at: knots need a fraction at each; give fraction = [..]")
            return self
        if not 2 <= len(self.fraction) <= MOST_KNOTS:
            raise ValueError(f"fraction: {len(self.fraction)} values; must be one number or 2 to {MOST_KNOTS} values")
        if len(self.knots) != len(self.fraction):
            raise ValueError(f"at: {len(self.knots)} knots for {len(self.fraction)} fractions; must be as many")
        if self.knots[0] != 0 or self.knots[-1] != 1:
            raise ValueError(f"at = {list(self.knots)}: must begin with 0 (the pole) and end with 1 (the rim)")
        if any(b <= a for a, b in pairwise(self.knots)):
            raise ValueError(f"at = {list(self.knots)}: out of order; every knot must be greater than the one before")
        return self

    @property
    def fractions(self) -> tuple[float, ...]:
        """The fractions at the knots; one alone of a constant mix."""
        return (self.fraction,) if isinstance(self.fraction, float) else tuple(self.fraction)

    @property
    def knots(self) -> tuple[float, ...]:
        """The knots; of a constant mix the pole alone."""
        if self.at is not None:
            return tuple(self.at)
        last = max(len(self.fractions) - 1, 1)
        return tuple(k / last for k in range(len(self.fractions)))

    @property
    def is_constant(self) -> bool:
        """True if the fraction is the same everywhere."""
        return len(set(self.fractions)) == 1

    @property
    def label(self) -> str:
        """Name of the mix: ``TangoPlus + 20 % VeroClear``, ``TangoPlus + 0 to 30 % VeroClear``."""
        pole, rim = 100 * self.fractions[0], 100 * self.fractions[-1]
        share = f"{pole:.3g}" if self.is_constant else f"{pole:.3g} to {rim:.3g}"
        return f"{self.from_} + {share} % {self.to}"


def _which(value: Any) -> str:
    return "<mix>" if isinstance(value, dict | Grade) else "<name>"


ResinOrMix = Annotated[
    Annotated[str, Field(min_length=1), Tag("<name>")] | Annotated[Grade, Tag("<mix>")], Discriminator(_which)
]
"""The name of a material, or a mix of two."""
