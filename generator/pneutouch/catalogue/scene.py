"""A scene: a design file with every name in it resolved, and checked against one another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError, shown
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION, DesignFile
from pneutouch.spec.fields import MaterialKind
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.part import AnyMount, AnySeat, CastRing, GluedFlange, OnePiece, PerforatedRing, Port, Sleeve, Tube
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes, override, read_toml, validate
from pneutouch.spec.values import name_of

if TYPE_CHECKING:
    from pneutouch.spec.calibration import SensorCalibration
    from pneutouch.spec.gauge import Gauge


@dataclass(frozen=True, slots=True)
class ResolvedDesign:
    """A design with everything that it names. ``where`` is the file as the user gave it, for messages.

    ``calibration`` and ``gauge`` are None if none is named, the mould's printer and material if the membrane is
    printed.
    """

    name: str
    where: str
    design: DesignFile
    membrane_material: Material
    connector_material: Material
    printer: Printer
    connector_printer: Printer
    tube: Tube
    port: Port
    seat: AnySeat
    mount: AnyMount
    calibration: SensorCalibration | None = None
    gauge: Gauge | None = None
    mould_printer: Printer | None = None
    mould_material: Material | None = None

    def __repr__(self) -> str:
        return f"ResolvedDesign({self.name!r}, {self.where!r})"

    @property
    def membrane_mode(self) -> Mode:
        """Print mode of the membrane; load_scene has checked that there is one."""
        if isinstance(self.seat, OnePiece):
            return _mode(self.printer, self.membrane_material, self.connector_material)
        return _mode(self.printer, self.membrane_material)

    @property
    def connector_mode(self) -> Mode:
        """Print mode of the connector; the membrane's if both grow in one print."""
        return (
            self.membrane_mode
            if isinstance(self.seat, OnePiece)
            else _mode(self.connector_printer, self.connector_material)
        )

    @property
    def hole_undersize(self) -> float:
        """Difference in diameter, mm, by which the connector's printer makes holes too small, to be added to bores."""
        return self.connector_printer.hole_undersize_mm.nominal

    @property
    def mesh_tolerance(self) -> float:
        """Chord tolerance in mm for every body: the finest step of the machines that build them.

        One tolerance for the assembly, so that faces shared by two bodies carry the same vertices.
        """
        return min(
            self.printer.finest_step(self.membrane_mode), self.connector_printer.finest_step(self.connector_mode)
        )

    @property
    def fit_clearance(self) -> float:
        """Clearance per side in mm between the connector and the body that its seat holds: the sum of their printers'
        stated accuracies. That body is the membrane, or the ring it is cast around, which the connector's printer
        makes."""
        held = self.connector_printer if isinstance(self.seat, CastRing) else self.printer
        return held.accuracy_mm.nominal + self.connector_printer.accuracy_mm.nominal


@dataclass(frozen=True, slots=True)
class DesignSource:
    """A design before its names are resolved: its name, its tables as a file has them, and where they were written."""

    name: str
    content: Mapping[str, Any]
    where: str

    @staticmethod
    def of(design: str | DesignSource, library: Library) -> DesignSource:
        """Source of a design by name, by path or as ``DESIGN@CALIBRATION``; of a source itself. Raises InputError."""
        if isinstance(design, DesignSource):
            return design
        plain, calibration = split_calibration(design, library)
        path = library.design_file(plain)
        named = {} if calibration is None else {CALIBRATION: calibration}
        if calibration is not None and calibration != NO_CALIBRATION:
            # The design's file does not hold this name: the error is on what was given.
            library.load("calibrations", calibration)
        return DesignSource(name_of(path), {**read_toml(path), **named}, str(path))

    def changed(self, changes: Changes) -> DesignFile:
        """The design file with fields changed. Raises InputError that names file, key and value."""
        return validate(DesignFile, override(self.content, changes, DesignFile), self.where)


def split_calibration(design: str, library: Library) -> tuple[str, str | None]:
    """Design and calibration of ``DESIGN@CALIBRATION``; the calibration is None if none is named."""
    plain, at, calibration = design.rpartition("@")
    if not at or not plain or design in library.paths("designs") or Path(design).is_file():
        return design, None
    # A path may hold the sign itself: lab@home/dome.toml.
    return (design, None) if "/" in calibration or calibration.endswith(".toml") else (plain, calibration)


def load_scene(
    design: str | DesignSource, changes: Changes | None = None, library: Library | None = None
) -> ResolvedDesign:
    """Load a design, given by name, by path or as a source, change fields and resolve its names. Raises InputError."""
    library = library or Library.default()
    source = DesignSource.of(design, library)
    return _resolved(source.name, source.where, source.changed(changes or {}), library)


def _resolved(name: str, where: str, design: DesignFile, library: Library) -> ResolvedDesign:
    def find(kind: str, table: str, key: str) -> Any:
        return library.load(kind, getattr(getattr(design, table), key), file=where, key=f"{table}.{key}")

    printer: Printer = find("printers", "print", "profile")
    scene = ResolvedDesign(
        name=name,
        where=where,
        design=design,
        membrane_material=membrane_material_of(design, where, library),
        connector_material=find("materials", "connector", "material"),
        printer=printer,
        connector_printer=find("printers", "print", "connector_profile"),
        tube=_tube_of(design, where, library),
        port=find("ports", "connector", "port"),
        seat=find("seats", "connector", "seat"),
        mount=_mount_of(design, where, library),
        calibration=_calibration(design, where, library),
        gauge=_named_gauge(design, where, library),
        mould_printer=find("printers", "mould", "profile") if printer.is_casting else None,
        mould_material=find("materials", "mould", "material") if printer.is_casting else None,
    )
    check_scene(scene, library)
    return scene


def membrane_material_of(design: DesignFile, where: str, library: Library) -> Material:
    """The resin that the design names, or the mix that it describes, at the design's temperature."""
    chosen, celsius = design.membrane.material, design.environment.temperature_C
    if isinstance(chosen, Grade):
        from pneutouch.catalogue.mixture import mixed_material

        material: Material = mixed_material(chosen, library, file=where, shape=design.membrane.dome)
    else:
        material = library.load("materials", chosen, file=where, key="membrane.material")
    if celsius is None:
        return material
    from pneutouch.catalogue.mixture import at_temperature

    return at_temperature(material, celsius, where)


def _calibration(design: DesignFile, where: str, library: Library) -> SensorCalibration | None:
    """The calibration that the design names; None without one."""
    name = design.calibration_name
    if name is None:
        return None
    calibration: SensorCalibration = library.load("calibrations", name, file=where, key=CALIBRATION)
    return calibration


def check_scene(scene: ResolvedDesign, library: Library | None = None) -> None:
    """Check the rules between the parts of a scene. Raises InputError that names ``scene.where`` and the key.

    With the ``library`` that the scene was resolved with, errors also state which profiles make a material.
    """
    check_kind(scene.where, "membrane.material", scene.membrane_material, "elastomer")
    check_kind(scene.where, "connector.material", scene.connector_material, "rigid")
    design, membrane = scene.design, scene.design.membrane.material
    soft = membrane if isinstance(membrane, str) else None
    _check_runs(scene, "print.profile", scene.printer, soft, scene.membrane_material, library)
    rigid = design.connector.material, scene.connector_material
    _check_runs(scene, "print.connector_profile", scene.connector_printer, *rigid, library)
    _check_one_piece(scene)
    _check_glue(scene)
    _check_cast_ring(scene.design, scene.where, scene.seat, scene.printer)
    _check_calibration(scene)
    _check_mould(scene, library)


def _mode(printer: Printer, *materials: Material) -> Mode:
    mode = printer.mode_for(*materials)
    assert mode is not None
    return mode


def check_kind(where: str, key: str, material: Material, kind: MaterialKind) -> None:
    """Raise InputError for a material of another kind."""
    if material.kind != kind:
        raise InputError(f"{material.label} is {material.kind}", file=where, key=key, remedy=f"it must be {kind}")


def _check_runs(
    scene: ResolvedDesign, key: str, printer: Printer, name: str | None, material: Material, library: Library | None
) -> None:
    if printer.mode_for(material) is None:
        from pneutouch.catalogue.printers import cannot_run

        table, field = key.split(".")
        value = getattr(getattr(scene.design, table), field)
        raise cannot_run(printer, name, material, library, f"{key} =", file=scene.where, key=key, value=value)


def _check_one_piece(scene: ResolvedDesign) -> None:
    """Raise InputError unless one machine holds both materials of a membrane grown onto its connector."""
    if not isinstance(scene.seat, OnePiece):
        return
    chosen, problem = scene.design.print, None
    if chosen.profile != chosen.connector_profile:
        problem = (
            f"both bodies grow in one print, so print.connector_profile = {shown(chosen.connector_profile)} must be "
            f"{shown(chosen.profile)}, as print.profile"
        )
    elif scene.printer.mode_for(scene.membrane_material, scene.connector_material) is None:
        problem = (
            f"the {scene.printer.title} cannot print {scene.membrane_material.label} and "
            f"{scene.connector_material.label} together; it holds {scene.printer.resins_at_once} of "
            f"{', '.join(scene.printer.resins)}"
        )
    if problem is not None:
        raise InputError(problem, file=scene.where, key="connector.seat", value=scene.design.connector.seat)


def _check_glue(scene: ResolvedDesign) -> None:
    """Raise InputError if a glue is named for a seat that is neither a glued flange nor a cast ring."""
    named = scene.design.connector.glue
    if named is not None and not isinstance(scene.seat, GluedFlange | CastRing):
        problem = f"connector.seat = {shown(scene.design.connector.seat)} has no glue at the flange"
        remedy = "leave it out, or take connector.seat = glued-flange"
        raise InputError(problem, file=scene.where, key="connector.glue", value=named, remedy=remedy)


def _check_mould(scene: ResolvedDesign, library: Library | None) -> None:
    """Raise InputError unless a printer, not a casting profile, makes the mould of a membrane that is cast."""
    if not scene.printer.is_casting:
        return
    if scene.mould_printer is None or scene.mould_material is None:
        raise InputError("the membrane is cast; the mould's printer and material are missing", file=scene.where)
    if scene.mould_printer.is_casting:
        raise InputError(
            f"the mould is printed, not cast; {scene.mould_printer.title} is no printer",
            file=scene.where,
            key="mould.profile",
            value=scene.design.mould.profile,
            remedy="take the profile of a printer",
        )
    check_kind(scene.where, "mould.material", scene.mould_material, "rigid")
    _check_runs(scene, "mould.profile", scene.mould_printer, scene.design.mould.material, scene.mould_material, library)


def _check_calibration(scene: ResolvedDesign) -> None:
    """Raise InputError if the calibration named is missing, or is of another resin or membrane."""
    name, calibration, membrane = scene.design.calibration_name, scene.calibration, scene.design.membrane
    if (name is None) != (calibration is None):
        raise InputError("the calibration named is not there", file=scene.where, key=CALIBRATION, value=name)
    if calibration is None:
        return
    why = calibration.misfit(membrane.material, membrane.dome)
    if why is not None:
        raise InputError(
            f"the calibration {why}",
            file=scene.where,
            key=CALIBRATION,
            value=name,
            remedy="calibrate a sensor of this membrane, or take the calibration's resin and sizes",
        )


def _tube_of(design: DesignFile, where: str, library: Library) -> Tube:
    """The tube that the design names, else the first of its port. Raises InputError if the port does not take it."""
    port = library.load("ports", design.connector.port, file=where, key="connector.port")
    name = design.pneumatics.tube
    if name is not None:
        library.load("tubes", name, file=where, key="pneumatics.tube")
        if name not in port.tubes:
            raise InputError(
                f"the port {design.connector.port} takes {', '.join(port.tubes)}",
                file=where,
                key="pneumatics.tube",
                value=name,
                remedy="give one of these, or another connector.port",
            )
    tube: Tube = library.load("tubes", name or port.tubes[0], file=where, key="tubes of connector.port")
    return tube


def _mount_of(design: DesignFile, where: str, library: Library) -> AnyMount:
    """The mount that the design names; a sleeve of the finger diameter stated. Raises InputError if it is no sleeve."""
    chosen, finger = design.connector.mount, design.connector.finger_diameter_mm
    mount: AnyMount = library.load("mounts", chosen, file=where, key="connector.mount")
    if finger is None:
        return mount
    if not isinstance(mount, Sleeve):
        sleeves = [name for name in library.paths("mounts") if isinstance(library.load("mounts", name), Sleeve)]
        raise InputError(
            f"connector.mount = {shown(chosen)} goes over no finger",
            file=where,
            key="connector.finger_diameter_mm",
            value=finger,
            remedy=f"take connector.mount = {' or '.join(sleeves)}, or leave it out",
        )
    return mount.for_finger(finger)


def _named_gauge(design: DesignFile, where: str, library: Library) -> Gauge | None:
    """The gauge of a design, None without one. Raises InputError if it does not read above the ambient pressure."""
    name, ambient_kPa = design.pneumatics.gauge, design.pneumatics.ambient_pressure_kPa
    if name is None:
        return None
    gauge: Gauge = library.load("gauges", name, file=where, key="pneumatics.gauge")
    if gauge.gauge_pressures_kPa(ambient_kPa)[1] <= 0:
        raise InputError(
            f"the {gauge.title} reads to {gauge.range_kPa.high:g} kPa absolute, not above the ambient "
            f"{ambient_kPa:g} kPa",
            file=where,
            key="pneumatics.gauge",
            value=name,
            remedy="take another gauge",
        )
    return gauge


def _check_cast_ring(design: DesignFile, where: str, seat: AnySeat, printer: Printer) -> None:
    """Raise InputError for a ring around which nothing is cast, or a ring stated for a seat without one.

    ``printer`` makes the membrane; ``where`` is the design's file.
    """
    chosen = design.connector.seat
    if not isinstance(seat, CastRing):
        if design.cast_ring != PerforatedRing():
            problem = f"connector.seat = {shown(chosen)} has no ring that a flange is cast around"
            remedy = "leave the table out, or take connector.seat = cast-ring"
            raise InputError(problem, file=where, key="cast_ring", remedy=remedy)
        return
    if not printer.is_casting:
        raise InputError(
            f"the flange is cast around its ring; print.profile = {shown(design.print.profile)} prints the membrane",
            file=where,
            key="connector.seat",
            value=chosen,
            remedy="take print.profile = silicone-casting with a membrane.material that is cast, or another seat",
        )
