"""Write a new file to start from: a commented design, or a copy of a design, a specimen, an example or a profile."""

import os
from dataclasses import dataclass, replace
from itertools import chain, count
from pathlib import Path
from typing import Any, get_args

import numpy as np

from pneutouch.catalogue import KINDS, DesignSource, Library, load_scene, user_folder
from pneutouch.catalogue.library import COMMANDS, examples, is_specimen
from pneutouch.catalogue.printers import casting_missing, makers, own_profile, uncast
from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.membrane import LIMIT_HEIGHT, pressure
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.output.files import create_file, replace_file
from pneutouch.shape import starting_sizes
from pneutouch.spec.design import DesignFile
from pneutouch.spec.files import is_file, read_bytes
from pneutouch.spec.material import CAST_SEAT, Material
from pneutouch.spec.membrane_table import Membrane
from pneutouch.spec.printer import Printer, Process
from pneutouch.spec.read import Changes, override, read_toml
from pneutouch.spec.toml_text import design_template
from pneutouch.spec.values import plain_name
from pneutouch.units import KPA

PROFILES = ("printers", "gauges", "materials")
"""Kinds of files, besides designs, that a laboratory may have of its own."""

PRINTED_PORT = "push-in-4"
"""Port of a new design: `check` finds nothing on it with filament, stereolithography and PolyJet, and it needs no tap.
The default of the design file is the paper's barb, whose tip and bore are too thin for some of them."""

_DRAWN = ("designs", "specimens", "pads")
"""Kinds of files that describe printed things."""


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that was written, and the words of the command that takes it: ``("select", "fingertip.toml")``.

    ``first`` is a step to do before that command. For a profile, ``profile`` is its kind and ``command`` empty.
    """

    path: Path
    command: tuple[str, ...]
    first: str = ""
    profile: str | None = None


def new_design(
    name: str, folder: Path, process: str | None = None, material: str | None = None, changes: Changes | None = None
) -> tuple[Path, str | None]:
    """Write ``folder/name.toml`` with every key, its default or its value in ``changes``, unit, bounds and help; never
    over a file.

    With ``process`` or ``material`` the design starts with a profile that runs it, and a note that names the profile is
    returned with the path (else None). Raises InputError if no profile does.
    """
    kept = f"The values are the defaults, except the port: {PRINTED_PORT}, which every printer makes"
    note = f"Every key may be left out. {kept}"
    library, free = Library.default(), process is None and material is None
    values = {"connector": {"port": PRINTED_PORT}} if free else process_values(process, material, library)
    if changes:
        taken = next((key for key in ("print.profile", "membrane.material") if key in changes and not free), None)
        if taken is not None:
            raise InputError(
                "process and resin come by their own options", key="set", value=taken, remedy="leave it out"
            )
        load_scene(DesignSource(name, values, name), changes, library)
        values, note = (
            override(values, changes, DesignFile),
            "Every key may be left out. The values are the defaults and what was asked for",
        )
    path = write_design(
        name, folder, design_template(name, values, f"{note}{'' if free else ', and what process and resin need'}.")
    )
    return path, None if free else profile_note(values, library, process=process, material=material)


def drawn(changes: Changes | None, shape: str | None, drawing: Path | None) -> Changes | None:
    """Changes with a shape and its sizes as numbers, in proportion to the inner radius, or with a profile as drawn.

    Raises InputError for a shape beside a drawing, and for those that cannot be read or made.
    """
    given = dict(changes or {})
    if drawing is not None:
        if shape not in (None, "profile"):
            raise InputError("a drawing is of the shape profile", key="shape", value=shape, remedy="leave it out")
        from pneutouch.output.drawn_profile import drawn_profile

        profile = drawn_profile(drawing)
        as_drawn = {"membrane.inner_radius_mm": profile[0][0], "membrane.profile_mm": profile}
        return {"membrane.shape": "profile", **as_drawn, **given}
    if shape is None:
        return changes
    radius = float(given.get("membrane.inner_radius_mm", Membrane().inner_radius_mm))
    sizes = {f"membrane.{key}": size for key, size in starting_sizes(shape, radius).items()}
    return {"membrane.shape": shape, **sizes, **given}


def new_changed(source: DesignSource, name: str, folder: Path, *, overwrite: bool = False) -> Path:
    """Write a design, every key with its value, as ``folder/name.toml``; a file is replaced only with ``overwrite``.
    Raises InputError."""
    values = source.changed({}).model_dump(by_alias=True)
    text = design_template(name, values, "Every key may be left out.")
    return write_design(name, folder, text, overwrite=overwrite)


def new_from(source: str, name: str | None = None, out: Path | None = None, changes: Changes | None = None) -> NewFile:
    """Copy a design, a specimen, an example, a printer, a gauge or a material, by name, to a new name.

    A design or a specimen may be given by its path.

    The copy goes to ``out``, else an example to the working folder and all others to the user's folder, where they are
    found by their names. ``name`` may be left out for an example, which keeps its own. Only a design takes ``changes``;
    printers, gauges and materials go only to the user's folder. No file is replaced. Raises InputError.
    """
    library, shipped = Library.default(), examples()
    kind = _profile_kind(source, library)
    if kind is not None:
        return _own_profile(kind, source, name, out, changes, library)
    if changes:
        return _changed(DesignSource.of(source, library), changes, name, out)
    for one in _DRAWN:
        if source in library.paths(one):
            return _copied(one, library.paths(one)[source], name, out)
    if source in shipped:
        example = shipped[source]
        called, text = plain_name(name or source, key="name"), example.path.read_text(encoding="utf-8")
        if example.kind == "campaign":
            # The runs of a campaign lie in the folder of its file.
            path = (out or Path()) / called / "campaign.toml"
            create_file(path, text.encode())
            first = f"put the files of your runs into {path.parent} and name them in {path}"
            return NewFile(path, (COMMANDS[example.kind], str(path.parent)), first)
        path = (out or Path()) / f"{called}.toml"
        create_file(path, text.encode())
        return NewFile(path, (COMMANDS[example.kind], str(path)))
    path = Path(source)
    if path.suffix == ".toml" or is_file(path):
        content = read_toml(path)
        kind = "specimens" if is_specimen(content) else "pads" if "pad" in content else "designs"
        return _copied(kind, path, name, out)
    known = dict.fromkeys([*shipped, *(name for one in (*_DRAWN, *PROFILES) for name in library.paths(one))])
    problem = f"no such design, specimen, example, printer, gauge or material.{nearest(source, known)}"
    raise InputError(problem, key="from", value=source)


def change_of_copy(source: str) -> str:
    """Remedy that shows how to change a copy. Raises InputError as `new_from` does for a name of two kinds."""
    kind = _profile_kind(source, Library.default())
    return "change it with `set`" if kind is None else f"it is one of the {kind}: change the file of the copy"


def _profile_kind(source: str, library: Library) -> str | None:
    """The kind of profile that a name stands for; None if it stands for a printed thing, an example or nothing.

    Raises InputError if it stands for several, one of them a profile.
    """
    kinds = [one for one in (*_DRAWN, *PROFILES) if source in library.paths(one)]
    owners = [f"{one} ({library.paths(one)[source]})" for one in kinds]
    if source in examples():
        kinds, owners = ["examples", *kinds], ["examples", *owners]
    profiles = [one for one in kinds if one in PROFILES]
    if profiles and len(kinds) > 1:
        problem = f"stands for one of the {' and one of the '.join(owners)}"
        raise InputError(problem, key="from", value=source, remedy="give the one to copy a name of its own")
    return profiles[0] if profiles else None


def _own_profile(
    kind: str, source: str, name: str | None, out: Path | None, changes: Changes | None, library: Library
) -> NewFile:
    """A copy of a printer profile, a gauge or a material in the user's folder."""
    if changes:
        problem = f"{source} is one of the {kind}, and this changes a design"
        raise InputError(problem, key="set", remedy="change the file of the copy")
    if out is not None:
        remedy = f"leave it out: a copy of one of the {kind} is found in {KINDS[kind].folder} of your folder alone"
        raise InputError("is of designs, specimens and examples", key="out", value=str(out), remedy=remedy)
    return NewFile(_copied(kind, library.paths(kind)[source], name, None).path, (), profile=kind)


def _changed(source: DesignSource, changes: Changes, name: str | None, out: Path | None) -> NewFile:
    if name is None:
        raise _nameless(source.name)
    changed = replace(source, content=override(source.content, changes, DesignFile))
    written = new_changed(changed, name, out or user_folder() / KINDS["designs"].folder)
    return NewFile(written, ("check", name if out is None else str(written)))


def _nameless(original: str) -> InputError:
    return InputError(f"{original} is the name of the original", key="name", remedy="give the copy another name")


def _copied(kind: str, path: Path, name: str | None, out: Path | None) -> NewFile:
    KINDS[kind].validate(read_toml(path), str(path))
    if name is None:
        raise _nameless(path.stem)
    folder = out or user_folder() / KINDS[kind].folder
    written = write_design(name, folder, read_bytes(path).decode("utf-8-sig"), kind)
    # A name finds what lies in the user's folder alone.
    return NewFile(written, ("check", name if out is None else str(written)))


def free_name() -> str:
    """A name that no design has, neither of the user's nor of the shipped ones."""
    known = Library.default().paths("designs")
    return next(name for name in chain(["my-sensor"], (f"my-sensor-{k}" for k in count(2))) if name not in known)


def check_name(name: str, folder: Path, kind: str = "designs") -> Path:
    """Path of the file of a new design. Raises InputError for a bad name, or one that would hide another design."""
    path = folder / f"{plain_name(name, key='name')}.toml"
    known = Library.default().paths(kind).get(name)
    if known is not None and known.resolve() != path.resolve():
        problem = f"{known} is a {kind.removesuffix('s')} of this name, which the new file would hide"
        raise InputError(problem, key="name", value=name, remedy="give another name")
    return path


def check_free(name: str, folder: Path, *, overwrite: bool = False, kind: str = "designs") -> Path:
    """Path of the file of a new design, or of another ``kind``, checked before anything is computed for it.

    Raises InputError as `check_name` does, for a file that exists (unless ``overwrite``), and for a folder that cannot
    be written.
    """
    path = check_name(name, folder, kind)
    if path.is_dir():
        raise InputError("this is a folder", file=path, remedy="give another name")
    if not overwrite and (path.exists() or path.is_symlink()):
        problem = "there is such a file already"
        raise InputError(problem, file=path, remedy="give another name, or `overwrite` to replace it")
    parent = next(one for one in (folder, *folder.absolute().parents) if one.exists())
    if not parent.is_dir():
        raise InputError(f"{parent} is not a folder", file=path)
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} cannot be written", file=path, remedy="give a folder you may write to with `out`")
    return path


def write_design(name: str, folder: Path, text: str, kind: str = "designs", *, overwrite: bool = False) -> Path:
    """Write the text of a design as ``folder/name.toml``; replace a file only if ``overwrite``."""
    path = check_name(name, folder, kind)
    (replace_file if overwrite else create_file)(path, text.encode())
    return path


PROCESSES: tuple[str, ...] = get_args(Process)
"""Processes that a profile may have."""

_SHARE = 0.4
"""Ratio of a new design's highest driving pressure to the closed-form limit pressure: below the rating of a resin whose
modulus is known to a factor of two."""


def process_values(process: str | None, material: str | None, library: Library) -> dict[str, dict[str, Any]]:
    """Values of a design by table and key that differ from the defaults. Raises InputError if no profile fits."""
    if process is not None and process not in PROCESSES:
        raise InputError(f"unknown.{nearest(process, PROCESSES)}", key="process", value=process)
    default = DesignFile()
    printers = library.all("printers", Printer)
    usual = [default.print.profile, *(name for name in printers if name != default.print.profile)]
    names = [name for name in usual if process is None or printers[name].process == process]
    resin = _soft(material, library) if material else None
    runs = {name: one for name in names if (one := _resin_of(printers[name], material, resin, library)) is not None}
    if not runs:
        raise _no_profile(process, material, resin, library)
    profile, chosen = next(iter(runs.items()))
    values: dict[str, dict[str, Any]] = {"membrane": {"material": chosen}, "print": {"profile": profile}}
    values["connector"] = {"port": PRINTED_PORT}
    if printers[profile].is_casting:
        values["connector"]["seat"], values["mould"] = CAST_SEAT, {}
    pressures_kPa = usual_pressures_kPa(library.load("materials", chosen), default)
    if pressures_kPa is not None:
        values["pneumatics"] = {"driving_pressures_kPa": pressures_kPa}
    return values


def profile_note(
    values: dict[str, dict[str, Any]], library: Library, *, process: str | None, material: str | None
) -> str:
    """Note on the profile, and on the resin if none was given, that `process_values` took, with its other profiles."""
    profile, chosen = str(values["print"]["profile"]), str(values["membrane"]["material"])
    resin: Material = library.load("materials", chosen)
    printers = library.readable("printers", Printer)
    others = [
        name
        for name, one in printers.items()
        if name != profile and process in (None, one.process) and one.mode_for(resin) is not None
    ]
    taken = f"profile {profile} ({printers[profile].title}) runs {chosen}"
    unnamed = "" if material is not None else ", the resin taken because none is given"
    also = f"; others that do, set by print.profile: {', '.join(others)}" if others else ""
    return f"{taken}{unnamed}{also}"


def _soft(name: str, library: Library) -> Material:
    material: Material = library.load("materials", name, key="material")
    if material.kind != "elastomer":
        problem = f"{material.label} is {material.kind}"
        raise InputError(problem, key="material", value=name, remedy="the membrane's must be an elastomer")
    return material


def _resin_of(printer: Printer, name: str | None, resin: Material | None, library: Library) -> str | None:
    """The resin given, None if the printer does not run it; without one the default, or the first, that it runs."""
    if resin is not None:
        return name if printer.mode_for(resin) is not None else None
    known = library.all("materials", Material)
    order = [str(DesignFile().membrane.material), *printer.resins, *known]
    runs = (one for one in order if one in known and known[one].kind == "elastomer" and printer.mode_for(known[one]))
    return next(runs, None)


def _no_profile(process: str | None, material: str | None, resin: Material | None, library: Library) -> InputError:
    printers = library.readable("printers", Printer)
    if resin is None:
        able = sorted({one.process for one in printers.values() if _resin_of(one, None, None, library)})
        problem, remedy = "no profile of this process runs an elastomer", f"there are profiles of {', '.join(able)}"
        return InputError(problem, key="process", value=process, remedy=remedy)
    runs = {one.process: name for name, one in makers(resin, library).items()}
    if not runs:
        casts = next((one for one in printers.values() if casting_missing(one, resin)), None)
        if casts is not None:
            return uncast(casts, resin, str(library.paths("materials")[str(material)]))
        return InputError("no profile runs it", key="material", value=material, remedy=own_profile(resin))
    where = " or ".join(f"{each} ({name})" for each, name in sorted(runs.items()))
    return InputError(f"{resin.label} is not made by it", key="process", value=process, remedy=f"it takes {where}")


def usual_pressures_kPa(material: Material, design: DesignFile) -> list[float] | None:
    """Driving pressures for a resin: four, from 0 to a share of the limit, two digits; None if the default suits it."""
    membrane, usual_kPa = design.membrane, design.pneumatics.driving_pressures_kPa
    sensor = material_sensor(material)
    size = membrane.inner_radius_mm, membrane.wall_thickness_mm
    limit = float(pressure(np.array(LIMIT_HEIGHT), *size, sensor.wall.shear_modulus))
    highest_kPa = _SHARE * limit / KPA
    if highest_kPa >= usual_kPa[-1]:
        return None
    return [0.0, *(float(f"{share * highest_kPa:.2g}") for share in (0.25, 0.5, 1.0))]
