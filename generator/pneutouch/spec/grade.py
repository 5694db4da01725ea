"""A graded membrane, two base resins mixed droplet by droplet, and the curve of the modulus of such a mix."""

from itertools import pairwise
from typing import Annotated, Any

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from pneutouch.errors import shown
from pneutouch.spec.fields import Table

MOST_KNOTS = 12
"""Greatest number of knots of a grade: a wall of a few bending lengths shows no more."""


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
    def _sound(self) -> "Grade":
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
        """Fractions at the knots; one value if ``fraction`` is one number."""
        return (self.fraction,) if isinstance(self.fraction, float) else tuple(self.fraction)

    @property
    def knots(self) -> tuple[float, ...]:
        """Knots from 0 (pole) to 1 (rim), even if not given; (0,) if ``fraction`` is one number."""
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


FROM_CURVE = "mixing curve"
"""First words of the ``source`` of a modulus that is computed from a mixing curve."""


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
    def _one_modulus(self) -> "MixingPoint":
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
    def _apart(self) -> "MixingCurveNames":
        if len(set(self.by_name)) < len(type(self).model_fields):
            raise ValueError(f"curves: {', '.join(self.by_name)}; every curve must have a name of its own")
        return self

    @property
    def by_name(self) -> dict[str, str]:
        """Key of `MixingPoint` that holds the fraction on a curve, by the curve's name; the one in use first."""
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
    def _rising(self) -> "MixingCurve":
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
        """Raise ValueError unless fractions begin with 0 and rise strictly, the low and the high ones."""
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
        """Fractions of the points on the curve that ``key`` of `MixingCurveNames` names."""
        side = {"fraction": "fraction", "fraction_low": "low", "fraction_high": "high"}[key]
        return [getattr(point, side) for point in self.points]

    @property
    def common_top(self) -> float:
        """Greatest fraction up to which every curve of the file gives a modulus."""
        return self.points[-1].low
