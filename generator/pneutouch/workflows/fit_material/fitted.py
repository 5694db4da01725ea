"""The options of ``fit-material`` and its results."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pneutouch.bench.tensile.choose import LawChoice
from pneutouch.bench.tensile.fit import LawFit
from pneutouch.bench.tensile.puck import PuckFit, PuckSize
from pneutouch.bench.tensile.read import SpecimenSize


@dataclass(frozen=True, slots=True)
class MaterialFacts:
    """Facts of a material that a fit does not find: ``like`` is a known material whose other numbers are kept,
    ``density`` in g/cm3, ``shore_a`` readings of hardness, ``lab`` who measured."""

    like: str | None = None
    density: float | None = None
    shore_a: tuple[float, ...] = ()
    lab: str | None = None


_NO_SIZE, _NO_FACTS = SpecimenSize(), MaterialFacts()


@dataclass(frozen=True, slots=True)
class FitOptions:
    """Options of a fit: its data and its method.

    Attributes:
        data: Tensile files, one a specimen; of a puck one file.
        name: Of the material.
        size: Lengths of the specimen, where the files have force and extension.
        puck: Size of the puck, where the test is one.
        largest: Stretch to fit up to; None: what a sensor reaches with such a modulus.
        slack: Strain to take off each curve; None: found.
        facts: Further entries of the file on the material.
    """

    data: tuple[Path, ...]
    name: str
    size: SpecimenSize = _NO_SIZE
    puck: PuckSize | None = None
    largest: float | None = None
    slack: float | None = None
    facts: MaterialFacts = _NO_FACTS


@dataclass(frozen=True, slots=True)
class FittedMaterial:
    """Result of a fit.

    Attributes:
        options: As given.
        law: The law taken.
        neo_hookean: The neo-Hookean law over the same stretches.
        largest: Stretch of tension up to which they were fitted.
        choice: The fits of all laws; None of a puck.
        puck: The fit of a puck; None of tension.
        path: The material file.
        text: Its content.
    """

    options: FitOptions
    law: LawFit
    neo_hookean: LawFit
    largest: float
    choice: LawChoice | None
    puck: PuckFit | None
    path: Path
    text: str
