"""Work of ``fit-material``: the law of a material from a laboratory's own tests, and its material file."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.bench.coupons import DIGITS
from pneutouch.bench.tensile.choose import (
    MISFIT,
    NEO_HOOKEAN,
    WORST_MISFIT,
    LawChoice,
    PuckFit,
    PuckSize,
    choose_law,
    fit_puck,
)
from pneutouch.bench.tensile.law_fit import LawFit, TensionCurve, difference
from pneutouch.bench.tensile.read import SpecimenSize, read_tension
from pneutouch.catalogue import KINDS, Library, user_folder
from pneutouch.catalogue.printers import makers
from pneutouch.errors import InputError
from pneutouch.formats import versioned
from pneutouch.mechanics.laws import hyperelastic
from pneutouch.mechanics.paper_sensor import young_modulus
from pneutouch.output.files import check_writable, digest, json_bytes, replace_files, with_manifest, write_folder
from pneutouch.report.fit_charts import LawCurve, law_chart
from pneutouch.results.fit import LawRecord, MaterialFit, PulledSpecimen, TriedLaw
from pneutouch.results.record import plain
from pneutouch.spec.files import check_of, read_bytes, whole_head
from pneutouch.spec.material import TENSION_ALONE_PERCENT, HyperelasticLaw, Material, density_problem
from pneutouch.spec.options import FitOptions
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.spec.values import Quantity, file_name, plain_name
from pneutouch.wording import rounded

HARDNESS_SHARE = (0.4, 0.65)
"""Usual range of Young's modulus over that of Gent's relation for the hardness: TangoPlus by the paper's modulus has
0.49, five of the six silicones on the Shore A scale 0.44 to 0.52 (docs/reference/materials.md)."""

_MOST_BYTES = 100_000_000
_GRID = 200


def fit_report(fitted: FittedMaterial) -> MaterialFit:
    """Record of a fit."""
    choice, law = fitted.choice, fitted.law
    small = hyperelastic(law.form.name, law.constants, 0.49).mu
    fits = (law,) if choice is None else choice.fits
    refused = {} if choice is None else choice.refused
    pulled = () if choice is None else zip(choice.curves, choice.each, strict=True)
    report = MaterialFit(
        material=fitted.options.name,
        file=str(fitted.path),
        test="puck" if choice is None else "tension",
        largest_stretch=fitted.largest,
        law=LawRecord(*_figures(law)),
        shear_modulus_small_strain_MPa=small,
        shear_modulus_MPa=fitted.neo_hookean.constants[0],
        shear_modulus_uncertainty_MPa=fitted.neo_hookean.errors[0],
        specimens=tuple(
            PulledSpecimen(curve.file, curve.kind, int(curve.stretch.size), 100 * curve.slack, modulus)
            for curve, modulus in pulled
        ),
        fits=tuple(TriedLaw(*_figures(fit), refused.get(k)) for k, fit in enumerate(fits)),
        profile=_profile(fitted),
        notes=tuple(_notes(fitted, small)),
    )
    return rounded(report, 6)


def _figures(fit: LawFit) -> tuple[str, str, tuple[float, ...], tuple[float, ...], float, float]:
    """Fields of a law's record."""
    return fit.form.name, fit.form.label, fit.constants, fit.errors, 100 * fit.misfit, 100 * fit.worst


def _notes(fitted: FittedMaterial, small: float) -> list[str]:
    notes = []
    if fitted.choice is not None:
        notes += [f"{curve.file}: {note}" for curve in fitted.choice.curves for note in curve.notes]
        slack = max(curve.slack for curve in fitted.choice.curves)
        if slack > 0.03:
            notes.append(
                f"{100 * slack:.2g} % of strain were taken off as slack: measure on marks of the specimen, not on the "
                "crosshead, or set the zero of the force with the specimen hanging free"
            )
    if fitted.law.misfit > MISFIT:
        notes.append(
            f"no law that the data determine is within {100 * MISFIT:g} % of them; {fitted.law.form.label} is off by "
            f"up to {100 * fitted.law.misfit:.2g} %"
        )
    if fitted.choice is not None and fitted.choice.kinds == ("tension",):
        low, high = TENSION_ALONE_PERCENT
        notes.append(
            f"fitted to tension alone: its stress in two directions is likely {low:g} to {high:g} % too low, which the "
            "intervals of limit pressure and height hold; measure an equibiaxial or an inflated specimen too"
        )
    notes += [*_uncast(fitted), *_hardness(fitted, small)]
    notes.append("the intervals hold the scatter of these points alone, not that of other batches, rates or ages")
    return notes


def _uncast(fitted: FittedMaterial) -> list[str]:
    """Note on a material that no printer profile makes and whose file lacks the data for casting; else none."""
    if _material(fitted).is_cast or _profile(fitted) is not None:
        return []
    return [
        f"{fitted.path} has no table [casting], which a material that is cast needs: add it there, or fit it again: "
        "pneutouch fit-material --like DragonSkin20"
    ]


def _profile(fitted: FittedMaterial) -> str | None:
    """Name of a profile that makes the material, for a cast one rather one that casts; None if none runs it."""
    material = _material(fitted)
    made = makers(material, Library.default())
    cast = [name for name, one in made.items() if one.is_casting == material.is_cast]
    return next(iter([*cast, *made]), None)


def _material(fitted: FittedMaterial) -> Material:
    return Material.model_validate(tomllib.loads(fitted.text))


def _hardness(fitted: FittedMaterial, small: float) -> list[str]:
    """Note that compares the modulus with the hardness in the material file; none without a hardness."""
    material = _material(fitted)
    if material.shore_a is None:
        return []
    share = 3.0 * small / young_modulus(material.shore_a.nominal)
    low, high = HARDNESS_SHARE
    text = (
        f"Young's modulus at small strain is {share:.2f} of Gent's relation at Shore A {material.shore_a.nominal:g}; "
        f"of others {low:g} to {high:g}"
    )
    return [text if low <= share <= high else f"{text}: an outlier; was this material measured, in these units?"]


def _chart(fitted: FittedMaterial) -> str:
    stretch = np.linspace(1.0, fitted.largest, _GRID)
    laws = [fitted.law] if fitted.law.form == fitted.neo_hookean.form else [fitted.law, fitted.neo_hookean]
    if fitted.puck is not None:
        stretch = np.linspace(float(fitted.puck.stretch.min()), 1.0, _GRID)
        off = fitted.law.stress(fitted.puck.stretch) / fitted.puck.stress - 1.0
        curves = [LawCurve(fitted.law.form.label, stretch, fitted.law.stress(stretch), fitted.puck.stretch, off)]
        return law_chart([(fitted.puck.stretch, fitted.puck.stress)], curves, fitted.largest)
    assert fitted.choice is not None
    curves, kinds = [], fitted.choice.kinds
    for law in laws:
        off_at, off, _ = (
            np.concatenate(parts) for parts in zip(*(difference(law, c) for c in fitted.choice.curves), strict=True)
        )
        curves.append(LawCurve(law.form.label, stretch, law.stress(stretch, kinds[0]), off_at, off))
    for kind in kinds[1:]:
        to = np.linspace(1.0, max(curve.stretch[-1] for curve in fitted.choice.curves if curve.kind == kind), _GRID)
        none = np.empty(0)
        curves.append(LawCurve(f"{fitted.law.form.label}, {kind}", to, fitted.law.stress(to, kind), none, none))
    points = [(curve.stretch, curve.stress) for curve in fitted.choice.curves]
    return law_chart(points, curves, fitted.largest)


def fit_material(data: Sequence[Path], options: FitOptions, library: Library | None = None) -> FittedMaterial:
    """Read, check and fit; nothing is written. Raises InputError for unusable data, and if a file of the name is not of
    a fit."""
    plain_name(options.name, key="name")
    size = puck_of(options)
    if not data:
        raise InputError("no file of data", key="data", remedy="give the CSV of a tensile or puck test")
    if size is not None and len(data) > 1:
        raise InputError("one puck, and more than one file", key="puck_mm", remedy="give one file")
    density = options.density_g_per_cm3
    problem = None if density is None else density_problem(density)
    if problem is not None:
        raise InputError(problem, key="density_g_per_cm3", value=density)
    path = user_folder() / "printprofiles/materials" / f"{options.name}.toml"
    library = library or Library.default()
    choice, puck = None, None
    if size is not None:
        puck = fit_puck(data[0], size)
        law = LawFit(NEO_HOOKEAN, (puck.modulus,), (puck.error,), puck.misfit, puck.misfit)
        neo, largest = law, puck.largest
    else:
        curves = _curves(data, options)
        choice = choose_law(curves, options.stretch_to, options.slack)
        law, neo, largest = choice.law, choice.neo_hookean, choice.largest
    if law.misfit > WORST_MISFIT:
        raise InputError(
            f"no law comes within {100 * WORST_MISFIT:g} % of the stress; {law.form.label} is off by up to "
            f"{100 * law.misfit:.2g} %, and shipped ones by 1 to 8 %",
            file=data[0],
            remedy="were the kind of test, the units and the zeros stated right? Give `stretch_to` to fit less far",
        )
    fitted = FittedMaterial(tuple(data), options, law, neo, largest, choice, puck, path, "")
    return replace(fitted, text=material_file(fitted, library))


def _curves(data: Sequence[Path], options: FitOptions) -> list[TensionCurve]:
    """Curves of the files. Raises InputError unless ``kinds`` is empty or has one entry for each."""
    size = SpecimenSize(options.gauge_length_mm, options.width_mm, options.thickness_mm, options.opening_mm)
    if options.kinds and len(options.kinds) != len(data):
        raise InputError("give one for each file, in their order", key="kinds", value=",".join(options.kinds))
    return [read_tension(file, size, kind) for file, kind in zip_longest(data, options.kinds)]


def write_material(fitted: FittedMaterial, report: MaterialFit, out: Path) -> Path:
    """Write the material file into the user's folder, plot and figures into ``out/fit-<name>/``; return that folder."""
    folder = out / f"fit-{fitted.options.name}"
    check_writable(folder)
    inputs = {
        "data": {path.name: digest(read_bytes(path, _MOST_BYTES, "data")) for path in fitted.data},
        "stretch_to": fitted.options.stretch_to,
        "slack": fitted.options.slack,
        "kinds": fitted.options.kinds,
        "material": fitted.text,
    }
    made = {"fit.json": json_bytes(versioned("fit", plain(report))), "fit.svg": _chart(fitted).encode()}
    write_folder(folder, with_manifest(made, folder.name, inputs))
    replace_files({fitted.path: fitted.text.encode()})
    return folder


def puck_of(options: FitOptions) -> PuckSize | None:
    """Size of the puck if the test is one; else None."""
    if options.puck_mm is None:
        return None
    diameter, thickness = options.puck_mm
    return PuckSize(diameter, thickness, options.bonded)


@dataclass(frozen=True, slots=True)
class FittedMaterial:
    """Result of a fit.

    Attributes:
        data: Tensile files, one for each specimen; for a puck one file.
        options: Options as given.
        law: The law taken.
        neo_hookean: The neo-Hookean law fitted over the same stretches.
        largest: Stretch of tension up to which the laws were fitted.
        choice: The fits of all laws; None for a puck.
        puck: The fit of a puck; None for tension.
        path: Path of the material file.
        text: Content of the material file."""

    data: tuple[Path, ...]
    options: FitOptions
    law: LawFit
    neo_hookean: LawFit
    largest: float
    choice: LawChoice | None
    puck: PuckFit | None
    path: Path
    text: str


_COMMAND = "fit-material"
_COLOUR = "#C8BFB4"
_POISSON = {
    "value": 0.49,
    "source": "modelling value of the paper, Supplement B, for nearly incompressible elastomers; not measured",
}


def material_file(fitted: FittedMaterial, library: Library) -> str:
    """Content of the material file, checked. Raises InputError if a file of that name is not of a fit."""
    check_of(fitted.path, _COMMAND, "give another `name`, or move it away")
    content = _base(fitted, library)
    measured: dict[str, Quantity | HyperelasticLaw] = {"shear_modulus_MPa": _modulus(fitted), "law": _law(fitted)}
    facts, given = fitted.options, "as given to pneutouch fit-material"
    if facts.density_g_per_cm3 is not None:
        measured["density_g_per_cm3"] = Quantity(value=facts.density_g_per_cm3, source=f"{given}{_by(fitted)}")
    if facts.shore_a:
        readings = np.asarray(facts.shore_a)
        spread = rounded(float(readings.std(ddof=1)), DIGITS) if readings.size > 1 else None
        source = f"{given}, {readings.size} readings{_by(fitted)}"
        measured["shore_a"] = Quantity(value=rounded(float(readings.mean()), DIGITS), spread=spread, source=source)
    content |= {key: table.model_dump(exclude_none=True) for key, table in measured.items()}
    KINDS["materials"].validate(content, str(fitted.path))
    names = ", ".join(file_name(path.name) for path in fitted.data)
    return whole_head(_COMMAND, names) + toml_text(content)


def _base(fitted: FittedMaterial, library: Library) -> dict[str, Any]:
    """Data of the material that are known: those of the one it is ``like``, or of a shipped one of its name; else the
    least that a file needs. Raises InputError for a rigid one, or without a density."""
    name, facts = fitted.options.name, fitted.options
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
    if facts.density_g_per_cm3 is None:
        problem = f"no material is called {name}, so that its density is not known"
        raise InputError(
            problem, key="density_g_per_cm3", remedy="give it in g/cm3, or name a material that it is `like`"
        )
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
    return "" if fitted.options.lab is None else f"; {fitted.options.lab}"


def _modulus(fitted: FittedMaterial) -> Quantity:
    neo, value = fitted.neo_hookean, rounded(fitted.neo_hookean.constants[0], DIGITS)
    how = f"neo-Hookean fit to a stretch of {fitted.largest:.3g}, misfit {100 * neo.misfit:.3g} %"
    each, kinds = ((), ()) if fitted.choice is None else (fitted.choice.each, fitted.choice.kinds)
    low = high = spread = None
    if len(each) > 1:
        low, high = rounded(min(*each, value), DIGITS), rounded(max(*each, value), DIGITS)
        # Kinds of test differ by more than the scatter of specimens.
        spread = rounded(float(np.std(each, ddof=1)), DIGITS) if len(kinds) == 1 else None
        how += f"; low, high{' and spread' if spread else ''}: of {len(each)} specimens"
    return Quantity(value=value, low=low, high=high, spread=spread, source=f"{_test(fitted)}: {how}{_by(fitted)}")


def _law(fitted: FittedMaterial) -> HyperelasticLaw:
    law = fitted.law
    slack = "" if fitted.choice is None else f", {_slack(fitted)} of slack taken off"
    # Not checked here: the whole file is, with its path in the message.
    kinds = ["puck"] if fitted.choice is None else [*fitted.choice.kinds]
    return HyperelasticLaw.model_construct(
        name=law.form.name,
        kinds=[] if kinds == ["tension"] else kinds,
        constants=[rounded(constant, DIGITS) for constant in law.constants],
        largest_stretch=rounded(fitted.largest, DIGITS),
        misfit_percent=float(f"{100 * law.misfit:.3g}"),
        source=f"{_test(fitted)}: {law.form.label}{slack}; misfit: largest relative difference of nominal stress, "
        f"running mean over 0.1 of stretch, from 10 % strain on{_by(fitted)}",
    )


def _slack(fitted: FittedMaterial) -> str:
    assert fitted.choice is not None
    return ", ".join(f"{100 * curve.slack:.2g} %" for curve in fitted.choice.curves)


def _test(fitted: FittedMaterial) -> str:
    """Text that describes the test."""
    names = ", ".join(file_name(path.name) for path in fitted.data)
    puck = puck_of(fitted.options)
    if puck is not None:
        held = "faces held" if puck.bonded else "faces free to slide"
        return f"puck of {puck.diameter:g} mm x {puck.thickness:g} mm pressed, {held} ({names})"
    assert fitted.choice is not None
    facts = fitted.choice.curves[0].facts
    stated = [f"{key}: {facts[key]}" for key in ("Speed (mm/min)", "Strain Measurement", "Standard") if key in facts]
    kinds = " and ".join("uniaxial tension" if kind == "tension" else kind for kind in fitted.choice.kinds)
    return f"{kinds}, {names}" + (f" ({', '.join(stated)})" if stated else "")
