"""A cured material: every number with its source; how its resin is cast, and how it relaxes."""

import math
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from pneutouch.errors import shown
from pneutouch.spec.fields import FieldsError, MaterialKind, SparseTable, Table
from pneutouch.spec.values import Quantity

SHRINKAGE_PERCENT = (0.0, 10.0)
"""Bounds of `Casting.shrinkage_percent`, linear: addition-cured silicones shrink by about 0.1 %, condensation-cured
ones by up to some percent; more is a number in another unit."""

CAST_SEAT = "clamped-flange-M2"
"""Seat of a cast membrane where nothing else is stated: no glue but silicone's own bonds silicone."""

_MOST = {"pot_life_min": 1e4, "cure_h": 1e4, "mixed_viscosity_Pa_s": 1e5}


def _check_positive(table: Table, most: dict[str, float]) -> None:
    """Raise ValueError for a quantity of the table that is not more than 0, or more than ``most`` of its key."""
    for key, limit in most.items():
        quantity: Quantity | None = getattr(table, key)
        for number in () if quantity is None else (quantity.value, quantity.low, quantity.high):
            if number is not None and not 0 < number <= limit:
                raise ValueError(f"{key}: {number:g} must be more than 0 and at most {limit:g}")


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
    def _can_be_mixed(self) -> "Casting":
        for index, part in enumerate(self.parts_by_mass):
            if not part > 0:
                raise ValueError(f"parts_by_mass[{index}] = {part:g}: must be more than 0")
        _check_positive(self, _MOST)
        low, high = SHRINKAGE_PERCENT
        for number in (self.shrinkage_percent.value, self.shrinkage_percent.low, self.shrinkage_percent.high):
            if number is not None and not low <= number <= high:
                raise ValueError(f"shrinkage_percent: {number:g} must be from {low:g} to {high:g} %")
        return self

    def masses_g(self, total_g: float) -> list[float]:
        """Mass of each part, g, in ``total_g`` of the mixed liquid."""
        whole = math.fsum(self.parts_by_mass)
        return [total_g * part / whole for part in self.parts_by_mass]


class MakingFacts(Table):
    """[making] of a printer or a material, in words for the sheet; one left out is said there to be unknown."""

    settings: str | None = Field(default=None, min_length=3, description="Settings of the machine or its slicer.")
    software: str | None = Field(default=None, min_length=3, description="Program of the machine and files it reads.")
    cleaning: str | None = Field(default=None, min_length=3, description="Baths, time and drying.")
    curing: str | None = Field(default=None, min_length=3, description="Post-cure: light, temperature, time.")
    airtightness: str | None = Field(default=None, min_length=3, description="What makes its walls hold air.")
    slicer: dict[str, float | str] = Field(
        default={}, description="Settings of PrusaSlicer by its own names; filament."
    )
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")

    @field_validator("slicer")
    @classmethod
    def _lines_of_a_file(cls, given: dict[str, float | str]) -> dict[str, float | str]:
        for key, value in given.items():
            bad_flow = key == "extrusion_multiplier" and not (isinstance(value, float) and 0.5 <= value <= 2.0)
            if bad_flow or not f"{key}{value}".isprintable():
                raise ValueError(
                    f"{key} = {shown(value)}: must be {'from 0.5 to 2' if bad_flow else 'one line of text'}"
                )
        return given


class RelaxationTerm(Table):
    """One term of a Prony series."""

    share: float = Field(gt=0, lt=1, description="Of the instantaneous modulus.")
    time_s: float = Field(gt=0, description="Relaxation time.")


class Relaxation(Table):
    """Modulus after a step of strain over the instantaneous one: 1 - sum of share (1 - exp(-t/time_s))."""

    terms: list[RelaxationTerm] = Field(min_length=1, max_length=20, description="In ascending order of time_s.")
    temperature_C: float | None = Field(default=None, description="Temperature of the test, if known.")
    source: str = Field(min_length=8, description="Table, page, DOI or measurement; how far it was verified.")
    shift: list[Annotated[list[float], Field(min_length=2, max_length=2)]] = Field(
        default=[], max_length=100, description="Pairs of a temperature, °C, rising, and the factor on all times there."
    )

    @model_validator(mode="after")
    def _relaxes_to_a_solid(self) -> "Relaxation":
        total = math.fsum(term.share for term in self.terms)
        if not total < 1:
            raise ValueError(f"terms: shares add up to {total:.9g}; it must be less than 1, so that a modulus is left")
        if any(not a[0] > b[0] for b, a in pairwise(self.shift)) or any(not one[1] > 0 for one in self.shift):
            raise ValueError("shift: its temperatures must rise, and its factors be more than 0")
        times = [term.time_s for term in self.terms]
        for k, (before, after) in enumerate(pairwise(times)):
            if not after > before:
                raise ValueError(f"terms[{k + 1}].time_s = {after:g}: must be more than the one before, {before:g}")
        return self


class PaperMeasurements(Table):
    """Measurements of the paper on its own sensor (R0 9.25 mm, t0 1.5 mm) in this material, Table S1."""

    sensitivity_0kPa_kPa_per_N: Quantity = Field(description="Sensitivity without driving pressure.")
    sensitivity_22kPa_kPa_per_N: Quantity = Field(description="Sensitivity at a driving pressure of 22 kPa.")
    hysteresis_percent: Quantity = Field(description="Hysteresis of a loading loop.")
    repeatability_kPa_per_N: Quantity = Field(description="Scatter of the sensitivity over repeated runs.")
    sensitivity_change_one_year_percent: Quantity | None = Field(
        default=None, description="Change of the sensitivity within a year."
    )


TENSION_ALONE_PERCENT = (10.0, 18.0)
"""Shortfall in equibiaxial stress, at stretches of 1.1 to 1.7, of laws fitted to tension alone: 10, 13 and 18 % of the
three rubbers with published tests of both kinds, and 10 to 16 % in the limit pressure of a thin sphere."""


class HyperelasticLaw(SparseTable):
    """A law of the material's own, where the neo-Hookean one with its shear modulus is not enough."""

    left_out = ("largest_stretch", "misfit_percent", "kinds")

    name: str = Field(description="neo-hookean, mooney-rivlin, yeoh or ogden.")
    constants: list[float] = Field(min_length=1, max_length=6, description="MPa; Ogden: mu, alpha, mu, alpha ...")
    largest_stretch: float | None = Field(
        default=None, gt=1, le=20, description="Fitted to a tensile curve from 1 to there; left out: not known."
    )
    kinds: list[Literal["tension", "planar", "equibiaxial", "puck"]] = Field(
        default=[], max_length=4, description="Kinds of test that it was fitted to; left out: tension alone."
    )
    misfit_percent: float | None = Field(
        default=None,
        ge=0,
        le=1000,
        description="Largest difference of the nominal stress to the curve over that range, of the datum, where the "
        "strain is 10 % or more.",
    )
    source: str = Field(min_length=8, description="Table, page, DOI or fit that the constants are from.")


_MIX_SUM = 1e-6
"""Greatest deviation from 1 that the sum of a mix's volume fractions may have."""


class Mix(Table):
    """Volume fractions of a digital material's base resins; the 3MF then carries it as a composite.

    No shipped material has one: vendors do not publish the ratios of their digital materials. A lab that has
    measured its own writes ``[mix]`` with ``source`` and ``[mix.fractions]`` into its own material file.
    """

    fractions: dict[str, float] = Field(description="Volume fraction of each base resin; together 1.")
    source: str = Field(min_length=8, description="Table, page or measurement that the fractions are from.")

    @model_validator(mode="after")
    def _whole(self) -> "Mix":
        for resin, fraction in self.fractions.items():
            if not fraction > 0:
                raise ValueError(f"fractions.{resin} = {fraction:g}: must be more than 0; leave out resins not in it")
        total = math.fsum(self.fractions.values())
        if abs(total - 1) > _MIX_SUM:
            raise ValueError(f"fractions add up to {total:.9g}; they must add up to 1")
        return self


class ArcGrading(Table):
    """A graded membrane along its arc, pole (0) to rim (1): lists of one length, linear between the places."""

    arc: list[float] = Field(min_length=2, description="Places along the arc, rising from 0 (pole) to 1 (rim).")
    stiff_fraction: list[float] = Field(min_length=2, description="Volume fraction of the second base resin.")
    shear_modulus_MPa: list[float] = Field(min_length=2, description="Shear modulus at these places.")

    @model_validator(mode="after")
    def _of_one_length(self) -> "ArcGrading":
        if not len(self.arc) == len(self.stiff_fraction) == len(self.shear_modulus_MPa):
            raise ValueError("along: arc, stiff_fraction and shear_modulus_MPa must be of one length")
        if self.arc[0] != 0 or self.arc[-1] != 1 or any(b <= a for a, b in pairwise(self.arc)):
            raise ValueError("along.arc: must rise from 0 to 1")
        if min(self.shear_modulus_MPa) <= 0 or not 0 <= min(self.stiff_fraction) <= max(self.stiff_fraction) <= 1:
            raise ValueError("along: moduli must be more than 0 and fractions from 0 to 1")
        return self


class MixByCurve(Table):
    """A mix by one of the mixing curves of its two resins: its properties if that curve is true."""

    curve: str = Field(min_length=1, description="Name of the mixing curve.")
    place: Literal["softer", "in use", "stiffer"] = Field(description="Against the curve in use.")
    shear_modulus_MPa: Quantity = Field(description="Shear modulus by this curve; of a graded membrane the mean.")
    elongation_at_break_percent: Quantity | None = Field(default=None, description="Elongation at break by this curve.")
    along_MPa: list[float] | None = Field(
        default=None, min_length=2, description="Moduli of a graded membrane, at along.arc."
    )
    beyond: bool = Field(
        default=False, description="Whether a fraction is beyond the curve's last point, whose modulus is then taken."
    )


STIFFEST_ELASTOMER_MPA = 60.0
"""Greatest shear modulus of a wall that this program models, our choice: beyond it a number is mostly in another unit,
such as kPa. Of 14 printed polyurethane filaments the stiffest has about 25 MPa (10.1089/3dp.2023.0010); 60 MPa is a
Shore A of 98.7 by Gent's relation, and a tenth of the modulus of rigid connectors, which the models hold for rigid."""

HARDEST = 99.9
"""Greatest Shore hardness: at 100 there is no modulus."""


DENSITY_G_PER_CM3: dict[MaterialKind, tuple[float, float]] = {"elastomer": (0.5, 3.0), "rigid": (0.1, 25.0)}
"""Least and greatest density by kind, our choice. The shipped materials have 1.02 to 1.18 and filled elastomers more;
an elastomer of less than half of that is a foam, through which a dome leaks. Rigid is anything from light wood to the
densest metal."""


def density_problem(
    density_g_per_cm3: float, kind: MaterialKind = "elastomer", thousandfold: str = "is it in kg/m3?"
) -> str | None:
    """Problem with the density of a material of this kind, in words; None for a plausible density.

    ``thousandfold`` is a question that is added if a thousandth of the density would be plausible.
    """
    low, high = DENSITY_G_PER_CM3[kind]
    if low <= density_g_per_cm3 <= high:
        return None
    unit = f"; {thousandfold}" if low <= 1e-3 * density_g_per_cm3 <= high else ""
    whose = "" if kind == "elastomer" else f" for a {kind} material"
    return f"must be from {low:g} to {high:g} g/cm3{whose}{unit}"


def elastomer_modulus_problem(modulus_MPa: float) -> str | None:
    """Problem with the shear modulus of an elastomer, in words; None for a plausible modulus."""
    if modulus_MPa <= STIFFEST_ELASTOMER_MPA:
        return None
    most = f"{STIFFEST_ELASTOMER_MPA:g} MPa to which walls are modelled here"
    return f"{modulus_MPa:g} MPa is more than the {most}; is it in kPa?"


_POSITIVE = {
    **dict.fromkeys(("shear_modulus_MPa", "young_modulus_MPa", "tensile_strength_MPa"), 1e6),
    "elongation_at_break_percent": 1e6,
    **dict.fromkeys(("shore_a", "shore_a_one_year", "shore_d"), HARDEST),
}
"""Quantities that must be more than 0, and the greatest value that each may have."""


class Material(SparseTable):
    """One cured material. A digital material is identified by its code together with its base resins."""

    left_out = ("casting", "curves", "making")

    title: str = Field(description="Common name.")
    code: str = Field(description="Short form for part numbers.")
    kind: MaterialKind = Field(description="elastomer or rigid.")
    base_resins: list[str] = Field(min_length=1, max_length=3, description="Resins the machine jets.")
    colour: str = Field(
        pattern=r"^#[0-9A-F]{6}$", description="#RRGGBB in capitals, such as #C8BFB4; for display alone."
    )
    density_g_per_cm3: Quantity = Field(description="Density of the cured material.")
    poisson_ratio: Quantity | None = Field(default=None, description="Poisson's ratio; an elastomer needs it.")
    shear_modulus_MPa: Quantity | None = Field(
        default=None, description="Small-strain shear modulus; an elastomer needs it."
    )
    young_modulus_MPa: Quantity | None = Field(default=None, description="Young's modulus of a rigid material.")
    shore_a: Quantity | None = Field(default=None, description="Hardness on the Shore A scale.")
    shore_a_one_year: Quantity | None = Field(default=None, description="Hardness after a year in light and air.")
    shore_d: Quantity | None = Field(default=None, description="Hardness on the Shore D scale.")
    tensile_strength_MPa: Quantity | None = Field(default=None, description="Tensile strength.")
    elongation_at_break_percent: Quantity | None = Field(default=None, description="Elongation at break.")
    law: HyperelasticLaw | None = Field(default=None, description="A law of the material's own; left out: neo-Hookean.")
    measured: PaperMeasurements | None = Field(
        default=None, description="Measurements of the paper on its sensor in this material."
    )
    mix: Mix | None = Field(
        default=None, description="Volume fractions of a digital material's base resins, where they are known."
    )
    along: ArcGrading | None = Field(default=None, description="Of a graded membrane; its numbers are means then.")
    curves: list[MixByCurve] = Field(
        default=[], description="Of a mix whose pair has several mixing curves: the same by each, the softest first."
    )
    relaxation: list[Relaxation] = Field(default=[], max_length=8, description="One entry a source.")
    glass_transition_C: Quantity | None = Field(default=None, description="Temperature of the transition to glass.")
    shear_modulus_is: Literal["relaxed", "instantaneous"] | None = Field(
        default=None, description="Which modulus shear_modulus_MPa is: relaxed (long-term) or instantaneous."
    )
    casting: Casting | None = Field(default=None, description="Of a resin that is cast in a mould, not printed.")
    making: MakingFacts | None = Field(default=None, description="As of a printer, before whose facts they come.")

    @model_validator(mode="after")
    def _relaxation_of_a_known_modulus(self) -> "Material":
        if self.relaxation and self.shear_modulus_is is None:
            raise ValueError('relaxation needs shear_modulus_is = "relaxed" or "instantaneous"')
        return self

    @model_validator(mode="after")
    def _mix_of_the_base_resins(self) -> "Material":
        if self.mix is not None and set(self.mix.fractions) != set(self.base_resins):
            raise ValueError(
                f"mix.fractions names {', '.join(sorted(self.mix.fractions)) or 'nothing'}; it must name exactly the "
                f"base_resins: {', '.join(self.base_resins)}"
            )
        return self

    @model_validator(mode="after")
    def _of_matter(self) -> "Material":
        _check_positive(self, _POSITIVE)
        return self

    @model_validator(mode="after")
    def _as_dense_as_its_kind(self) -> "Material":
        for key in ("value", "low", "high"):
            number = getattr(self.density_g_per_cm3, key)
            problem = None if number is None else density_problem(number, self.kind)
            if problem is not None:
                raise FieldsError(f"density_g_per_cm3.{key} = {number:g}: {problem}", "density_g_per_cm3")
        return self

    @model_validator(mode="after")
    def _cast_of_one(self) -> "Material":
        if self.casting is not None and (self.kind != "elastomer" or self.is_digital):
            raise FieldsError("casting: a resin that is cast is an elastomer with one base resin, itself", "casting")
        return self

    @model_validator(mode="after")
    def _elastomer_complete(self) -> "Material":
        if self.kind == "elastomer" and (self.shear_modulus_MPa is None or self.poisson_ratio is None):
            raise ValueError("an elastomer needs shear_modulus_MPa and poisson_ratio")
        modulus = self.shear_modulus_MPa
        for key in ("value", "low", "high") if self.kind == "elastomer" else ():
            number = getattr(modulus, key)
            problem = None if number is None else elastomer_modulus_problem(number)
            if problem is not None:
                raise ValueError(f"shear_modulus_MPa.{key}: {problem}")
        return self

    @property
    def is_cast(self) -> bool:
        """True if it is mixed by hand and cast in a mould."""
        return self.casting is not None

    @property
    def kind_shown(self) -> str:
        """The kind as users read it: a cast elastomer is ``cast``."""
        return "cast" if self.is_cast else self.kind

    def by_curve(self, other: MixByCurve) -> "Material":
        """Copy of this mix with modulus and elongation by another mixing curve, one of `curves`."""
        changes: dict[str, Any] = {
            "shear_modulus_MPa": other.shear_modulus_MPa,
            "elongation_at_break_percent": other.elongation_at_break_percent,
        }
        if self.along is not None:
            changes["along"] = self.along.model_copy(update={"shear_modulus_MPa": other.along_MPa})
        return self.model_copy(update=changes)

    @property
    def is_digital(self) -> bool:
        """True if the printer mixes it from more than one base resin."""
        return len(self.base_resins) > 1

    @property
    def is_uncoded(self) -> bool:
        """True for a mix by fractions, constant or graded, which no machine offers by a code."""
        return bool(self.curves) or self.along is not None

    @property
    def label(self) -> str:
        """Title with the base resins, without which a digital material's code is ambiguous."""
        return f"{self.title} ({' + '.join(self.base_resins)})" if self.is_digital else self.title
