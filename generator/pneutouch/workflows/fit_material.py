"""``fit-material``: the law of a material from the tensile or puck test of a laboratory, and its file.

Fit a material: curves or a puck in, law, modulus and material file out.

Result of a fit, as data and as files.
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pneutouch.bench.tensile.choose import MISFIT, NEO_HOOKEAN, LawChoice, choose_law
from pneutouch.bench.tensile.law_fit import LawFit, difference
from pneutouch.bench.tensile.puck import fit_puck
from pneutouch.bench.tensile.read import read_tension
from pneutouch.catalogue import Library, user_folder
from pneutouch.catalogue.printers import makers
from pneutouch.errors import InputError
from pneutouch.formats import versioned
from pneutouch.mechanics.laws import hyperelastic
from pneutouch.mechanics.paper_sensor import young_modulus
from pneutouch.output.files import check_writable, digest, json_bytes, replace_files, with_manifest, write_folder
from pneutouch.report.fit_charts import LawCurve, law_chart
from pneutouch.results.fit import LawRecord, MaterialFit, PulledSpecimen, TriedLaw
from pneutouch.results.record import plain
from pneutouch.rounding import rounded
from pneutouch.spec.files import read_bytes
from pneutouch.spec.material import Material, density_problem
from pneutouch.spec.values import plain_name
from pneutouch.workflows.fitted_material import FitOptions, FittedMaterial, material_file

HARDNESS_SHARE = (0.4, 0.65)
"""Young's modulus over that of Gent's relation where nothing is odd: TangoPlus by the paper's modulus has 0.50, eight
of the nine shipped silicones 0.44 to 0.52 (docs/reference/materials.md)."""

_MOST_BYTES = 100_000_000
_GRID = 200


def fit_report(fitted: FittedMaterial) -> MaterialFit:
    """All results of a fit."""
    choice, law = fitted.choice, fitted.law
    small = hyperelastic(law.form.name, law.constants, 0.49).mu
    fits = (law,) if choice is None else choice.fits
    refused = {} if choice is None else choice.refused
    report = MaterialFit(
        material=fitted.options.name,
        file=str(fitted.path),
        test="puck" if choice is None else "tension",
        largest_stretch=fitted.largest,
        law=LawRecord(*_figures(law)),
        shear_modulus_small_strain_MPa=small,
        shear_modulus_MPa=fitted.neo_hookean.constants[0],
        shear_modulus_uncertainty_MPa=fitted.neo_hookean.errors[0],
        specimens=() if choice is None else _specimens(choice),
        fits=tuple(TriedLaw(*_figures(fit), refused.get(k)) for k, fit in enumerate(fits)),
        profile=_profile(fitted),
        notes=tuple(_notes(fitted, small)),
    )
    return rounded(report, 6)


def _figures(fit: LawFit) -> tuple[str, str, tuple[float, ...], tuple[float, ...], float, float]:
    """The fields of a law's record."""
    return fit.form.name, fit.form.label, fit.constants, fit.errors, 100 * fit.misfit, 100 * fit.worst


def _specimens(choice: LawChoice) -> tuple[PulledSpecimen, ...]:
    return tuple(
        PulledSpecimen(curve.file, int(curve.stretch.size), 100 * curve.slack, modulus)
        for curve, modulus in zip(choice.curves, choice.each, strict=True)
    )


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
    notes += [*_uncast(fitted), *_hardness(fitted, small)]
    notes.append("the intervals hold the scatter of these points alone, not that of other batches, rates or ages")
    return notes


def _uncast(fitted: FittedMaterial) -> list[str]:
    """Data that a material which no profile makes needs before it can be cast."""
    if _material(fitted).is_cast or _profile(fitted) is not None:
        return []
    return [
        f"{fitted.path} has no table [casting], which a material that is cast needs: add it there, or fit it again: "
        "pneutouch fit-material --like DragonSkin20"
    ]


def _profile(fitted: FittedMaterial) -> str | None:
    """The profile that makes the material: one that casts where it is cast; None if none runs it."""
    material = _material(fitted)
    made = makers(material, Library.default())
    cast = [name for name, one in made.items() if one.is_casting == material.is_cast]
    return next(iter([*cast, *made]), None)


def _material(fitted: FittedMaterial) -> Material:
    return Material.model_validate(tomllib.loads(fitted.text))


def _hardness(fitted: FittedMaterial, small: float) -> list[str]:
    """The modulus against the hardness of the file."""
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
    curves = []
    for law in laws:
        off_at, off, _ = (
            np.concatenate(parts) for parts in zip(*(difference(law, c) for c in fitted.choice.curves), strict=True)
        )
        curves.append(LawCurve(law.form.label, stretch, law.stress(stretch), off_at, off))
    points = [(curve.stretch, curve.stress) for curve in fitted.choice.curves]
    return law_chart(points, curves, fitted.largest)


def fit_material(options: FitOptions, library: Library | None = None) -> FittedMaterial:
    """Read, check and fit; nothing is written. Raises InputError for data of no law and for a file of others."""
    plain_name(options.name, key="name")
    _check(options)
    path = user_folder() / "printprofiles/materials" / f"{options.name}.toml"
    library = library or Library.default()
    choice, puck = None, None
    if options.puck is not None:
        puck = fit_puck(options.data[0], options.puck)
        law = LawFit(NEO_HOOKEAN, (puck.modulus,), (puck.error,), puck.misfit, puck.misfit)
        neo, largest = law, puck.largest
    else:
        curves = [read_tension(file, options.size) for file in options.data]
        choice = choose_law(curves, options.largest, options.slack)
        law, neo, largest = choice.law, choice.neo_hookean, choice.largest
    fitted = FittedMaterial(options, law, neo, largest, choice, puck, path, "")
    return replace(fitted, text=material_file(fitted, library))


def write_material(fitted: FittedMaterial, report: MaterialFit, out: Path) -> Path:
    """Write the material file into the user's folder, and plot and figures into ``out/fit-<name>/``; that folder."""
    folder = out / f"fit-{fitted.options.name}"
    check_writable(folder)
    inputs = {
        "data": {path.name: digest(read_bytes(path, _MOST_BYTES, "data")) for path in fitted.options.data},
        "stretch_to": fitted.options.largest,
        "slack": fitted.options.slack,
        "material": fitted.text,
    }
    made = {"fit.json": json_bytes(versioned("fit", plain(report))), "fit.svg": _chart(fitted).encode()}
    files = with_manifest(made, folder.name, inputs)
    replace_files({fitted.path: fitted.text.encode()})
    write_folder(folder, files)
    return folder


def _check(options: FitOptions) -> None:
    """Raise InputError for options that do not go together."""
    if not options.data:
        raise InputError("no file of data", key="data", remedy="give the CSV of a tensile or puck test")
    if options.puck is not None and len(options.data) > 1:
        raise InputError("one puck, and more than one file", key="puck", remedy="give one file")
    for key, low, high in (("largest", 1.1, 20.0), ("slack", 0.0, 0.5)):
        value = getattr(options, key)
        if value is not None and not low <= value <= high:
            shown = "stretch_to" if key == "largest" else key
            raise InputError(f"must be from {low:g} to {high:g}", key=shown, value=value)
    _check_sizes(_lengths(options))
    density = options.facts.density
    problem = None if density is None else density_problem(density)
    if problem is not None:
        raise InputError(problem, key="density", value=density)


def _lengths(options: FitOptions) -> Sequence[tuple[str, float | None]]:
    size, puck = options.size, options.puck
    lengths = [("gauge_length", size.gauge_length), ("width", size.width), ("thickness", size.thickness)]
    return lengths if puck is None else [*lengths, ("puck", puck.diameter), ("puck", puck.thickness)]


def _check_sizes(lengths: Sequence[tuple[str, float | None]]) -> None:
    for key, value in lengths:
        if value is not None and not 0.05 <= value <= 1000.0:
            raise InputError("must be from 0.05 to 1000 mm", key=key, value=value)
