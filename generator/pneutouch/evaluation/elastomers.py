"""The elastomers of a library that a design is compared with."""

from pneutouch.catalogue import Library
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

Resins = dict[str, Material]
"""Materials by name."""


def elastomers(library: Library, casting: bool = False) -> Resins:
    """Every printed elastomer of a library, by name; with ``casting`` those that are cast as well.

    A cast design needs both: the paper measured printed ones alone, and the model's error is taken from them.
    """
    materials = library.all("materials", Material)
    soft = {name: material for name, material in materials.items() if material.kind == "elastomer"}
    return {name: material for name, material in soft.items() if casting or not material.is_cast}


def alike(printer: Printer, resins: Resins) -> Resins:
    """Resins made as the membrane of a printer is: all printed ones, or those of a casting profile."""
    if not printer.is_casting:
        return {name: material for name, material in resins.items() if not material.is_cast}
    return {name: material for name, material in resins.items() if printer.mode_for(material) is not None}
