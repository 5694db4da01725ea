"""A mixing curve: the shear modulus over the volume fraction of the stiff resin, as points with their source."""

from __future__ import annotations

from itertools import pairwise

from pydantic import Field, model_validator

from pneutouch.errors import shown
from pneutouch.spec.fields import Table

FROM_CURVE = "mixing curve"
"""First words of the source of a modulus that a mixing curve gave."""


class MixingPoint(Table):
    """A point of the curve: the modulus of a catalogue material, or one measured.

    ``fraction_low`` and ``fraction_high`` bound the fraction where it is not known.
    """

    fraction: float = Field(ge=0, le=1, description="Volume fraction of the stiff resin.")
    fraction_low: float | None = Field(
        default=None, ge=0, le=1, description="Least fraction that this modulus may have; left out: it is known."
    )
    fraction_high: float | None = Field(
        default=None, ge=0, le=1, description="Greatest fraction that this modulus may have; left out: it is known."
    )
    material: str | None = Field(default=None, min_length=1, description="Catalogue material of this modulus.")
    shear_modulus_MPa: float | None = Field(default=None, gt=0, description="Where it was measured.")
    shear_modulus_spread_MPa: float | None = Field(default=None, ge=0, description="One standard deviation.")
    elongation_at_break_percent: float | None = Field(default=None, gt=0, description="Elongation at break of the mix.")
    source: str = Field(min_length=8, description="Table, page, DOI or measurement of the point.")

    @model_validator(mode="after")
    def _one_modulus(self) -> MixingPoint:
        if (self.material is None) == (self.shear_modulus_MPa is None):
            raise ValueError(
                f"the point at fraction = {self.fraction:g} must have either material or shear_modulus_MPa"
            )
        if self.shear_modulus_spread_MPa is not None and self.shear_modulus_MPa is None:
            raise ValueError(f"the point at fraction = {self.fraction:g}: a spread needs its shear_modulus_MPa")
        if not self.low <= self.fraction <= self.high:
            raise ValueError(
                f"fraction = {self.fraction:g}: must lie between fraction_low = {self.low:g} and "
                f"fraction_high = {self.high:g}"
            )
        return self

    @property
    def low(self) -> float:
        """The least fraction that this modulus may have."""
        return self.fraction if self.fraction_low is None else self.fraction_low

    @property
    def high(self) -> float:
        """The greatest fraction that this modulus may have."""
        return self.fraction if self.fraction_high is None else self.fraction_high


class MixingCurveNames(Table):
    """Names of the curves that one file gives: the one in use, and those through the ends of every point's range."""

    fraction: str = Field(min_length=1, description="The curve through the points, used if no curve is named.")
    fraction_low: str = Field(min_length=1, description="The stiffer curve, through the points' fraction_low.")
    fraction_high: str = Field(min_length=1, description="The softer curve, through the points' fraction_high.")

    @model_validator(mode="after")
    def _apart(self) -> MixingCurveNames:
        if len(set(self.by_name)) < len(type(self).model_fields):
            raise ValueError(f"curves: {', '.join(self.by_name)}; every curve must have a name of its own")
        return self

    @property
    def by_name(self) -> dict[str, str]:
        """The key of a point's fraction, by the name of the curve; the one in use first."""
        return {getattr(self, key): key for key in type(self).model_fields}


class MixingCurve(Table):
    """Stiffness of the mixes of two base resins; one file a pair, ``SOFT+STIFF.toml``."""

    title: str = Field(description="Name of the pair.")
    soft: str = Field(min_length=1, description="Soft base resin.")
    stiff: str = Field(min_length=1, description="Stiff base resin.")
    assumption: str = Field(min_length=8, description="Source of the curve.")
    curves: MixingCurveNames | None = Field(
        default=None, description="Names of the curves, where sources differ; a measured curve has none."
    )
    points: list[MixingPoint] = Field(
        min_length=2,
        max_length=50,
        description="Points of the curve, by rising fraction; the first is the soft resin alone.",
    )

    @model_validator(mode="after")
    def _rising(self) -> MixingCurve:
        fractions = [point.fraction for point in self.points]
        for a, b in pairwise(fractions):
            if b <= a:
                raise ValueError(f"points: fraction {b:g} after {a:g}; they must rise")
        for side in ("low", "high"):
            for one, other in pairwise(self.points):
                if getattr(other, side) < getattr(one, side):
                    raise ValueError(
                        f"points: fraction_{side} {getattr(other, side):g} at fraction {other.fraction:g} after "
                        f"{getattr(one, side):g} at {one.fraction:g}; it must not fall"
                    )
        if self.soft == self.stiff:
            raise ValueError(f"stiff = {shown(self.stiff)}: must be another resin than soft")
        if fractions[0] != 0:
            raise ValueError(f"points: the first fraction is {fractions[0]:g}; must be 0, the soft resin alone")
        if self.curves is not None:
            self._check_ends()
            if not self.points[-1].low < fractions[-1] < self.points[-1].high:
                raise ValueError(
                    "curves: the last point's fraction must lie between its fraction_low and its fraction_high; leave "
                    "[curves] out of a curve that was measured"
                )
        return self

    def _check_ends(self) -> None:
        """Each end of the ranges must be a curve itself: it begins with the soft resin and its fractions rise."""
        for side in ("low", "high"):
            ends = [getattr(point, side) for point in self.points]
            if ends[0] != 0 or any(b <= a for a, b in pairwise(ends)):
                raise ValueError(
                    f"points: fraction_{side} = {', '.join(f'{end:g}' for end in ends)}; with names for the curves "
                    "they must begin with 0 and rise"
                )

    @property
    def is_assumed(self) -> bool:
        """True if some fraction is not known but placed between ``fraction_low`` and ``fraction_high``."""
        return any(point.low < point.high for point in self.points)

    def through(self, key: str) -> list[float]:
        """Fractions of the points on the curve of a key of `MixingCurveNames`."""
        side = {"fraction": "fraction", "fraction_low": "low", "fraction_high": "high"}[key]
        return [getattr(point, side) for point in self.points]

    @property
    def common_top(self) -> float:
        """The greatest fraction at which every curve of the file gives a modulus."""
        return self.points[-1].low
