"""Printer profiles that can make a material, and the error for a named profile that cannot."""

from collections.abc import Collection
from typing import Any

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError
from pneutouch.spec.material import Casting, Material
from pneutouch.spec.printer import Printer


def makers(material: Material, library: Library, among: Collection[str] | None = None) -> dict[str, Printer]:
    """The profiles (those ``among``, if given) that make a material, by name; invalid files are left out."""
    printers = library.readable("printers", Printer)
    named = printers if among is None else among
    return {name: one for name, one in printers.items() if name in named and one.mode_for(material) is not None}


def casting_missing(printer: Printer, material: Material) -> bool:
    """True if a profile could cast a material but the material's file has no table [casting]."""
    return printer.is_casting and not material.is_cast and set(material.base_resins) <= set(printer.resins)


def uncast(printer: Printer, material: Material, file: str) -> InputError:
    """Error for a material that is to be cast although its ``file`` does not state how."""
    needed = [key for key, field in Casting.model_fields.items() if field.is_required()]
    remedy = (
        f"the profile {printer.title} casts {material.label}: add the table [casting] with {', '.join(needed)}, or fit "
        "it again: pneutouch fit-material --like DragonSkin20"
    )
    return InputError("missing", file=file, key="casting", remedy=remedy)


def cannot_run(
    printer: Printer, name: str | None, material: Material, library: Library | None, setting: str, **place: Any
) -> InputError:
    """Error for a material that a profile does not make; with a ``library`` it names profiles that do.

    ``name`` is the material's name, None for a mix; ``setting`` is the setting that takes another profile, such as
    ``print.profile``; ``place`` holds file, key and value of what was given.
    """
    if casting_missing(printer, material):
        known = {} if library is None else library.paths("materials")
        return uncast(printer, material, str(known.get(name or "", place.get("file") or name)))
    at_once = f"it runs {', '.join(printer.resins)}, {printer.resins_at_once} at once"
    if material.is_uncoded and printer.voxel_print is None:
        at_once = "no machine has a code for this mix, and it has no voxel print"
    elif material.is_digital and not any(mode.digital_materials for mode in printer.mode):
        at_once = "it mixes no digital materials"
    remedy = at_once if library is None else f"{at_once}; {made_by(material, library, setting)}"
    return InputError(f"the {printer.title} cannot run {material.label}", remedy=remedy, **place)


def made_by(material: Material, library: Library, setting: str, among: Collection[str] | None = None) -> str:
    """Remedy that names the profiles (``among`` those given) that make a material, with processes, or what to add."""
    profiles = [f"{name} (process {one.process})" for name, one in makers(material, library, among).items()]
    others = makers(material, library)
    if others and not profiles:
        return f"{material.label} takes {' or '.join(others)}, which is not on the shelf"
    if not profiles:
        casts = next(
            (one for one in library.readable("printers", Printer).values() if casting_missing(one, material)), None
        )
        if casts is not None:
            return f"{material.label} has no table [casting], which the profile {casts.title} needs"
        return f"no profile runs {material.label}; {own_profile(material)}"
    return f"{material.label} takes {setting} {' or '.join(profiles)}"


def own_profile(material: Material) -> str:
    """Remedy for a material that no profile can make."""
    resins = ", ".join(material.base_resins)
    return f"add {resins} to the resins of a profile of your own: pneutouch new NAME --from PROFILE"
