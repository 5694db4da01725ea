"""A scene: a design file with every name in it resolved, and checked against one another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError
from pneutouch.spec.design import Design
from pneutouch.spec.fields import Kind
from pneutouch.spec.material import Material
from pneutouch.spec.part import Barb, BoltCircle, GluedFlange
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import override, read_toml, validate


@dataclass(frozen=True, slots=True)
class Scene:
    """All that a design names. ``where`` is the file as the user gave it, for messages."""

    name: str
    where: str
    design: Design
    membrane_material: Material
    connector_material: Material
    printer: Printer
    connector_printer: Printer
    port: Barb
    seat: GluedFlange
    mount: BoltCircle

    @property
    def membrane_mode(self) -> Mode:
        """Print mode of the membrane; load_scene has made sure that there is one."""
        return _mode(self.printer, self.membrane_material)

    @property
    def connector_mode(self) -> Mode:
        """Print mode of the connector."""
        return _mode(self.connector_printer, self.connector_material)

    @property
    def mesh_tolerance(self) -> float:
        """Chord tolerance in mm for every body: the finest step of the machines that build them.

        One tolerance for the assembly, so that faces shared by two bodies carry the same vertices.
        """
        return min(
            self.printer.finest_step(self.membrane_mode),
            self.connector_printer.finest_step(self.connector_mode),
        )

    @property
    def fit_clearance(self) -> float:
        """Clearance per side in mm between two bodies: the printers' stated accuracies added up."""
        return self.printer.accuracy_mm.nominal + self.connector_printer.accuracy_mm.nominal


def load_scene(name: str, assignments: list[str] | None = None, library: Library | None = None) -> Scene:
    """Load a design by name or path, apply ``table.key=value`` overrides and resolve its names."""
    shelves = library or Library.default()
    path = shelves.design_file(name)
    content = override(read_toml(path), assignments or [], Design)
    return _resolved(path.stem, str(path), validate(Design, content, str(path)), shelves)


def default_scene(assignments: list[str] | None = None, library: Library | None = None) -> Scene:
    """The design of all defaults with overrides applied."""
    where = "the default design"
    design = validate(Design, override({}, assignments or [], Design), where)
    return _resolved("default", where, design, library or Library.default())


def _resolved(name: str, where: str, design: Design, shelves: Library) -> Scene:
    def find(kind: str, table: str, key: str) -> Any:
        chosen = getattr(getattr(design, table), key)
        return shelves.load(kind, chosen, asked_by=f"{where}: {table}.{key}")

    scene = Scene(
        name=name, where=where, design=design,
        membrane_material=find("materials", "membrane", "material"),
        connector_material=find("materials", "connector", "material"),
        printer=find("printers", "print", "profile"),
        connector_printer=find("printers", "print", "connector_profile"),
        port=find("ports", "connector", "port"),
        seat=find("seats", "connector", "seat"),
        mount=find("mounts", "connector", "mount"),
    )  # fmt: skip
    _check_kind(scene, "membrane.material", scene.membrane_material, "elastomer")
    _check_kind(scene, "connector.material", scene.connector_material, "rigid")
    _check_runs(scene, "print.profile", scene.printer, scene.membrane_material)
    _check_runs(scene, "print.connector_profile", scene.connector_printer, scene.connector_material)
    return scene


def _mode(printer: Printer, material: Material) -> Mode:
    mode = printer.mode_for(material)
    assert mode is not None
    return mode


def _check_kind(scene: Scene, key: str, material: Material, kind: Kind) -> None:
    if material.kind != kind:
        raise InputError(f"{scene.where}: {key}: {material.label} is {material.kind}; it must be {kind}")


def _check_runs(scene: Scene, key: str, printer: Printer, material: Material) -> None:
    if printer.mode_for(material) is None:
        table, name = key.split(".")
        value = getattr(getattr(scene.design, table), name)
        raise InputError(
            f"{scene.where}: {key} = {value!r}: the {printer.title} cannot run {material.label}; "
            f"it runs {', '.join(printer.resins)}, {printer.resins_at_once} at once"
        )
