"""A material law fitted to a laboratory's own test, as the program states it."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class LawRecord:
    """A fitted law."""

    name: str
    """Name of the law."""
    label: str
    """Name of the law in words."""
    constants: tuple[float, ...]
    """Constants of the law: MPa, exponents without unit."""
    uncertainties: tuple[float | None, ...]
    """Standard uncertainty of each constant; null: not determined."""
    misfit_percent: float
    """Greatest relative difference of nominal stress between the law and the running mean of the data."""
    misfit_of_points_percent: float
    """Greatest relative difference of nominal stress between the law and single points."""


@dataclass(frozen=True, slots=True)
class TriedLaw(LawRecord):
    """A law that was fitted to the same data."""

    refused: str | None
    """Reason why the law was not chosen; null: nothing is against it."""


@dataclass(frozen=True, slots=True)
class PulledSpecimen:
    """A specimen that was measured."""

    data: str
    """Name of the data file."""
    kind: str
    """Kind of test: tension, planar or equibiaxial."""
    points: int
    """Number of points."""
    slack_percent: float
    """Strain at the start of the test that was taken off as slack."""
    shear_modulus_MPa: float
    """Small-strain shear modulus."""


@dataclass(frozen=True, slots=True)
class MaterialFit:
    """A material law fitted to a lab's own test."""

    material: str
    """Name of the fitted material."""
    file: str
    """Path of the material file that was written."""
    test: Literal["tension", "puck"]
    """Kind of test: specimens pulled, in one or two directions, or a puck between plates."""
    largest_stretch: float
    """Greatest stretch of tension up to which the data were fitted; other tests to the same first invariant."""
    law: LawRecord
    """Law that was chosen."""
    shear_modulus_small_strain_MPa: float
    """Shear modulus of the law at small strain."""
    shear_modulus_MPa: float
    """Shear modulus of the neo-Hookean law over the same stretches."""
    shear_modulus_uncertainty_MPa: float | None
    """Standard uncertainty of the neo-Hookean modulus; null: not determined."""
    specimens: tuple[PulledSpecimen, ...]
    """Measured specimens; empty for a puck."""
    fits: tuple[TriedLaw, ...]
    """Every law that was fitted."""
    profile: str | None
    """Printer profile that makes the material; null: none does."""
    notes: tuple[str, ...]
    """Notes in words."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
