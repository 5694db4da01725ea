"""Start of a new design of a given process or resin: a profile that runs it, a seat, pressures."""

from typing import Any, get_args

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.catalogue.runs import casting_missing, makers, own_profile, uncast
from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.inflation import LIMIT_HEIGHT, pressure
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.casting import CAST_SEAT
from pneutouch.spec.design import DesignFile
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer, Process
from pneutouch.units import KPA

PROCESSES: tuple[str, ...] = get_args(Process)
"""Processes of the profiles."""

_SHARE = 0.4
"""Highest driving pressure of a new design over the closed-form limit pressure: below the rating of a resin whose
modulus is known to a factor of two."""


def process_values(process: str | None, material: str | None, library: Library) -> dict[str, dict[str, Any]]:
    """Values that differ from the defaults, by table and key. Raises InputError if no profile fits."""
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
    if printers[profile].is_casting:
        values |= {"connector": {"seat": CAST_SEAT}, "mould": {}}
    pressures_kPa = _pressures_kPa(library.load("materials", chosen), default)
    if pressures_kPa is not None:
        values["pneumatics"] = {"driving_pressures_kPa": pressures_kPa}
    return values


def profile_note(
    values: dict[str, dict[str, Any]], library: Library, *, process: str | None, material: str | None
) -> str:
    """Note on the profile, and on the resin if none was given, that `process_values` took, with other profiles of that
    resin."""
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
    also = f"; so does {', '.join(others)}, set by print.profile" if others else ""
    return f"{taken}{unnamed}{also}"


def _soft(name: str, library: Library) -> Material:
    material: Material = library.load("materials", name, key="material")
    if material.kind != "elastomer":
        problem = f"{material.label} is {material.kind}"
        raise InputError(problem, key="material", value=name, remedy="the membrane's must be an elastomer")
    return material


def _resin_of(printer: Printer, name: str | None, resin: Material | None, library: Library) -> str | None:
    """The resin given where the printer runs it; none given: the design's default, else the first that it runs."""
    if resin is not None:
        return name if printer.mode_for(resin) is not None else None
    known = library.all("materials", Material)
    usual = str(DesignFile().membrane.material)
    order = [usual, *printer.resins, *known]
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


def _pressures_kPa(material: Material, design: DesignFile) -> list[float] | None:
    """Driving pressures for a resin: four from none to a share of the limit, two digits each; None if the default ones
    suit it."""
    membrane, usual_kPa = design.membrane, design.pneumatics.driving_pressures_kPa
    sensor = material_sensor(material)
    size = membrane.inner_radius_mm, membrane.wall_thickness_mm
    limit = float(pressure(np.array(LIMIT_HEIGHT), *size, sensor.wall.shear_modulus))
    highest_kPa = _SHARE * limit / KPA
    if highest_kPa >= usual_kPa[-1]:
        return None
    return [0.0, *(float(f"{share * highest_kPa:.2g}") for share in (0.25, 0.5, 1.0))]
