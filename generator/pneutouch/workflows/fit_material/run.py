"""Fit a material: curves or a puck in, law, modulus and material file out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneutouch.bench.tensile.choose import NEO_HOOKEAN, choose_law
from pneutouch.bench.tensile.fit import LawFit
from pneutouch.bench.tensile.puck import fit_puck
from pneutouch.bench.tensile.read import read_tension
from pneutouch.catalogue import Library, user_folder
from pneutouch.errors import InputError
from pneutouch.output.files import check_writable, replace_files, write_folder
from pneutouch.spec.material import density_problem
from pneutouch.spec.names import plain_name
from pneutouch.workflows.fit_material.document import document, files
from pneutouch.workflows.fit_material.fitted import FitOptions, FittedMaterial
from pneutouch.workflows.fit_material.profile import material_file


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


def write_material(fitted: FittedMaterial, out: Path) -> tuple[Path, dict[str, Any]]:
    """Write the material file into the user's folder, and plot and figures into ``out/fit-<name>/``; that folder, the
    document."""
    content = document(fitted)
    folder = out / f"fit-{fitted.options.name}"
    check_writable(folder)
    made = files(fitted, content)
    replace_files({fitted.path: fitted.text.encode()})
    write_folder(folder, made)
    return folder, content


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
