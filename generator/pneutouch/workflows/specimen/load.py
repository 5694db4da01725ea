"""A specimen's file with every name resolved: its materials, its printer and the context of its patterns."""

from dataclasses import dataclass
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import is_specimen
from pneutouch.errors import InputError, nearest
from pneutouch.parts.specimen import Box, PatternContext
from pneutouch.spec.fields import Table
from pneutouch.spec.material import Material
from pneutouch.spec.names import name_of
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes, override, read_toml
from pneutouch.spec.specimen import Specimen, validate_specimen


@dataclass(frozen=True, slots=True)
class ResolvedSpecimen:
    """All that a specimen names. ``where`` is the file as the user gave it, for messages."""

    name: str
    where: str
    specimen: Specimen
    matrix: Material
    inclusion: Material
    frame: Material | None
    printer: Printer
    mode: Mode

    @property
    def block(self) -> Box:
        """The block in mm: x along the path, z up; its bottom is z = 0."""
        block = self.specimen.block
        return Box((0.0, 0.0, 0.0), (block.length_mm, block.width_mm, block.height_mm))

    @property
    def tolerance(self) -> float:
        """Chord tolerance in mm: the printer's finest step."""
        return self.printer.finest_step(self.mode)

    @property
    def context(self) -> PatternContext:
        """Surroundings in which patterns are drawn."""
        speed = self.specimen.scan.speed_mm_per_s
        return PatternContext(self.block, self.printer, self.matrix, self.inclusion, speed, self.tolerance, self.where)


def load_specimen(name: str, changes: Changes | None = None, library: Library | None = None) -> ResolvedSpecimen:
    """Load a specimen by name or path, change fields and resolve its names.

    Raises InputError that names file, key and value.
    """
    library = library or Library.default()
    files = library.paths("specimens")
    try:
        path = files[name] if name in files else library.design_file(name)
    except InputError as error:
        if error.key != "design":
            raise
        remedy = f"give the name or the path of a specimen.{nearest(name, files)}"
        raise InputError("no such specimen or file", key="specimen", value=name, remedy=remedy) from None
    content = override(read_toml(path), changes or {}, Specimen)
    if not is_specimen(content):
        raise InputError(
            "has no [block] table, so it is no specimen", file=path, remedy="a sensor is built by its own name"
        )
    return _resolved(name_of(path), str(path), validate_specimen(content, str(path)), library)


def _resolved(name: str, where: str, specimen: Specimen, library: Library) -> ResolvedSpecimen:
    def find(kind: str, table: Table, section: str, key: str) -> Any:
        return library.load(kind, getattr(table, key), file=where, key=f"{section}.{key}")

    printer: Printer = find("printers", specimen.print, "print", "profile")
    matrix = find("materials", specimen.block, "block", "matrix")
    inclusion = find("materials", specimen.block, "block", "inclusion")
    frame = None
    if specimen.frame is not None:
        frame = find("materials", specimen.frame, "frame", "material") if specimen.frame.material else inclusion
    together = [material for material in (matrix, inclusion, frame) if material is not None]
    mode = printer.mode_for(*together)
    if mode is None:
        labels = ", ".join(dict.fromkeys(material.label for material in together))
        raise InputError(
            f"the {printer.title} cannot hold {labels} together",
            file=where,
            key="print.profile",
            value=specimen.print.profile,
            remedy=f"it runs {', '.join(printer.resins)}, {printer.resins_at_once} at once",
        )
    return ResolvedSpecimen(name, where, specimen, matrix, inclusion, frame, printer, mode)
