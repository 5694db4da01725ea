"""A mixing curve: the shear modulus over the volume fraction of the stiff resin, as points with their source."""

from __future__ import annotations

from itertools import pairwise

from pydantic import Field, model_validator

from pneutouch.spec.fields import Table


class MixingPoint(Table):
    """A point of the curve: the modulus of a catalogue material, or one measured.

    ``fraction_low`` and ``fraction_high`` say how far the fraction may be off where it is not known.
    """

    fraction: float = Field(ge=0, le=1)
    fraction_low: float | None = Field(default=None, ge=0, le=1)
    fraction_high: float | None = Field(default=None, ge=0, le=1)
    material: str | None = Field(default=None, min_length=1, description="Catalogue material of this modulus.")
    shear_modulus_MPa: float | None = Field(default=None, gt=0, description="Where it was measured.")  # noqa: N815
    elongation_at_break_percent: float | None = Field(default=None, gt=0)
    source: str = Field(min_length=8)

    @model_validator(mode="after")
    def _one_modulus(self) -> MixingPoint:
        if (self.material is None) == (self.shear_modulus_MPa is None):
            raise ValueError(
                f"the point at fraction = {self.fraction:g} must have either material or shear_modulus_MPa"
            )
        low = self.fraction if self.fraction_low is None else self.fraction_low
        high = self.fraction if self.fraction_high is None else self.fraction_high
        if not low <= self.fraction <= high:
            raise ValueError(
                f"fraction = {self.fraction:g}: must lie between fraction_low = {low:g} and fraction_high = {high:g}"
            )
        return self


class MixingCurve(Table):
    """How stiff a mix of two base resins is; one file a pair, ``SOFT+STIFF.toml``."""

    title: str
    soft: str = Field(min_length=1, description="Soft base resin.")
    stiff: str = Field(min_length=1, description="Stiff base resin.")
    assumption: str = Field(min_length=8, description="What the curve rests on.")
    points: list[MixingPoint] = Field(min_length=2, max_length=50)

    @model_validator(mode="after")
    def _rising(self) -> MixingCurve:
        fractions = [point.fraction for point in self.points]
        for a, b in pairwise(fractions):
            if b <= a:
                raise ValueError(f"points: fraction {b:g} after {a:g}; they must rise")
        if fractions[0] != 0:
            raise ValueError(f"points: the first fraction is {fractions[0]:g}; must be 0, the soft resin alone")
        return self
