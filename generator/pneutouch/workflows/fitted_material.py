"""The options of ``fit-material`` and its results.

The material file of a fit: the measured numbers, over those known of the material already.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.bench.tensile.choose import LawChoice
from pneutouch.bench.tensile.law_fit import LawFit
from pneutouch.bench.tensile.puck import PuckFit, PuckSize
from pneutouch.bench.tensile.read import SpecimenSize
from pneutouch.catalogue import KINDS, Library
from pneutouch.errors import InputError
from pneutouch.spec.material import HyperelasticLaw
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.values import Quantity, file_name


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


HEAD = "# Written by pneutouch fit-material"
"""First words of every file that is ours to overwrite."""

_COLOUR = "#C8BFB4"
_POISSON = {
    "value": 0.49,
    "source": "modelling value of the paper, Supplement B, for nearly incompressible elastomers; not measured",
}


def material_file(fitted: FittedMaterial, library: Library) -> str:
    """The text of the file, checked as a material. Raises InputError if a file of that name is not of a fit."""
    _check_ours(fitted.path)
    content = _base(fitted, library)
    measured: dict[str, Quantity | HyperelasticLaw] = {"shear_modulus_MPa": _modulus(fitted), "law": _law(fitted)}
    facts, given = fitted.options.facts, "as given to pneutouch fit-material"
    if facts.density is not None:
        measured["density_g_per_cm3"] = Quantity(value=facts.density, source=f"{given}{_by(fitted)}")
    if facts.shore_a:
        readings = np.asarray(facts.shore_a)
        spread = rounded(float(readings.std(ddof=1))) if readings.size > 1 else None
        source = f"{given}, {readings.size} readings{_by(fitted)}"
        measured["shore_a"] = Quantity(value=rounded(float(readings.mean())), spread=spread, source=source)
    content |= {key: table.model_dump(exclude_none=True) for key, table in measured.items()}
    KINDS["materials"].validate(content, str(fitted.path))
    names = ", ".join(file_name(path.name) for path in fitted.options.data)
    head = (
        f"{HEAD} from {names}.\n"
        "# Edit this line away and the command will no longer overwrite the file; delete the file to go back.\n"
    )
    return head + toml_text(content)


def rounded(value: float) -> float:
    """Round to four significant digits, more than a test has."""
    return float(f"{value:.4g}")


def _check_ours(path: Path) -> None:
    if not (path.exists() or path.is_symlink()):
        return
    if path.is_file() and not path.is_symlink():
        with path.open(encoding="utf-8", errors="replace") as file:
            if file.read(len(HEAD)) == HEAD:
                return
    problem = "was not written by pneutouch fit-material, so it is left as it is"
    raise InputError(problem, file=path, remedy="give another `name`, or move it away")


def _base(fitted: FittedMaterial, library: Library) -> dict[str, Any]:
    """Known numbers of the material: of the one it is like, of a shipped one of its name, else those that a file
    needs."""
    name, facts = fitted.options.name, fitted.options.facts
    known = library.paths("materials")
    like = facts.like or (name if name in known and known[name] != fitted.path else None)
    if like is not None:
        material = library.load("materials", like, key=None if facts.like is None else "like")
        if material.kind != "elastomer":
            raise InputError(f"{material.label} is rigid", key="like", value=like, remedy="name an elastomer")
        kept = read_toml(known[like])
        for key in ("measured", "along", "mix", "relaxation", "shear_modulus_is", "shore_a_one_year"):
            kept.pop(key, None)
        if facts.like is not None and like != name:
            kept |= {"title": name, "code": _code(name)}
        return kept
    if facts.density is None:
        problem = f"no material is called {name}, so that its density is not known"
        raise InputError(problem, key="density", remedy="give it in g/cm3, or name a material that it is `like`")
    return {
        "title": name,
        "code": _code(name),
        "kind": "elastomer",
        "base_resins": [name],
        "colour": _COLOUR,
        "poisson_ratio": _POISSON,
    }


def _code(name: str) -> str:
    return "".join(letter for letter in name if letter.isalnum())[:8].upper() or "OWN"


def _by(fitted: FittedMaterial) -> str:
    return "" if fitted.options.facts.lab is None else f"; {fitted.options.facts.lab}"


def _modulus(fitted: FittedMaterial) -> Quantity:
    neo, value = fitted.neo_hookean, rounded(fitted.neo_hookean.constants[0])
    how = f"neo-Hookean fit to a stretch of {fitted.largest:.3g}, misfit {100 * neo.misfit:.3g} %"
    each = () if fitted.choice is None else fitted.choice.each
    low = high = spread = None
    if len(each) > 1:
        low, high = rounded(min(*each, value)), rounded(max(*each, value))
        spread = rounded(float(np.std(each, ddof=1)))
        how += f"; low, high and spread: of {len(each)} specimens"
    return Quantity(value=value, low=low, high=high, spread=spread, source=f"{_test(fitted)}: {how}{_by(fitted)}")


def _law(fitted: FittedMaterial) -> HyperelasticLaw:
    law = fitted.law
    slack = "" if fitted.choice is None else f", {_slack(fitted)} of slack taken off"
    # Not checked here: the whole file is, with its path in the message.
    return HyperelasticLaw.model_construct(
        name=law.form.name,
        constants=[rounded(constant) for constant in law.constants],
        largest_stretch=rounded(fitted.largest),
        misfit_percent=float(f"{100 * law.misfit:.3g}"),
        source=f"{_test(fitted)}: {law.form.label}{slack}; misfit: largest relative difference of nominal stress, "
        f"running mean over 0.1 of stretch, from 10 % strain on{_by(fitted)}",
    )


def _slack(fitted: FittedMaterial) -> str:
    assert fitted.choice is not None
    return ", ".join(f"{100 * curve.slack:.2g} %" for curve in fitted.choice.curves)


def _test(fitted: FittedMaterial) -> str:
    """Description of the test, in words."""
    names = ", ".join(file_name(path.name) for path in fitted.options.data)
    puck = fitted.options.puck
    if puck is not None:
        held = "faces held" if puck.bonded else "faces free to slide"
        return f"puck of {puck.diameter:g} mm x {puck.thickness:g} mm pressed, {held} ({names})"
    assert fitted.choice is not None
    facts = fitted.choice.curves[0].facts
    stated = [f"{key}: {facts[key]}" for key in ("Speed (mm/min)", "Strain Measurement", "Standard") if key in facts]
    return f"uniaxial tension, {names}" + (f" ({', '.join(stated)})" if stated else "")
