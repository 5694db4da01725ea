"""Drawing of a specimen: its patterns, and the two or three closed bodies that share their faces."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.catalogue import Library
from pneutouch.catalogue.library import is_specimen
from pneutouch.errors import ComputationError, InputError, nearest
from pneutouch.parts.lettering.glyphs import lettering, rounded
from pneutouch.parts.specimen import FAMILIES, Box, Mesh, PatternContext, PatternGeometry, complement
from pneutouch.parts.specimen.family import MOST_TRIANGLES, check_inside, joined
from pneutouch.parts.specimen.plate import plate
from pneutouch.spec.fields import Table
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes, override, read_toml
from pneutouch.spec.specimen import FramePlate, Specimen, validate_specimen
from pneutouch.spec.values import name_of


@dataclass(frozen=True, slots=True)
class ResolvedSpecimen:
    """A specimen with the profiles that it names. ``where`` is the file as the user gave it, for messages."""

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
        """Block in mm: x along the path, z up, its bottom at z = 0."""
        block = self.specimen.block
        return Box((0.0, 0.0, 0.0), (block.length_mm, block.width_mm, block.height_mm))

    @property
    def tolerance(self) -> float:
        """Chord tolerance in mm: the printer's finest step."""
        return self.printer.finest_step(self.mode)

    @property
    def context(self) -> PatternContext:
        """Context in which patterns are drawn."""
        speed = self.specimen.scan.speed_mm_per_s
        return PatternContext(self.block, self.printer, self.matrix, self.inclusion, speed, self.tolerance, self.where)


def load_specimen(name: str, changes: Changes | None = None, library: Library | None = None) -> ResolvedSpecimen:
    """Load a specimen by name or path, changed, with names resolved. Raises InputError naming file, key and value."""
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


_MARK = 1.2
"""Depth of cut letters, as a multiple of the printer's recommended detail."""


@dataclass(frozen=True)
class SpecimenBodies:
    """Patterns in the order of the file, and bodies (matrix, inclusion, frame) in the block's coordinates, mm."""

    scene: ResolvedSpecimen
    patterns: tuple[PatternGeometry, ...]
    bodies: tuple[Body, ...]

    @cached_property
    def offset(self) -> Array:
        """Shift (3,) in mm to the print frame, in which no coordinate is negative."""
        return np.asarray(-np.min([body.bounds[0] for body in self.bodies], axis=0) + 0.0)

    @property
    def printed(self) -> tuple[Body, ...]:
        """The bodies in the print frame."""
        return tuple(body.moved(self.offset) for body in self.bodies)


def draw(scene: ResolvedSpecimen) -> SpecimenBodies:
    """Draw every layer and divide the block among the bodies.

    Raises InputError for impossible layers, or layers that meet, ComputationError if a body does not come out closed.
    """
    patterns = _patterns(scene)
    whole = joined([pattern.mesh for pattern in patterns])
    meshes = [("matrix", scene.matrix, complement(scene.block, whole)), ("inclusion", scene.inclusion, whole)]
    if scene.specimen.frame is not None and scene.frame is not None:
        under = _frame(scene, scene.specimen.frame, scene.frame, [mesh for _, _, mesh in meshes])
        meshes.append(("frame", scene.frame, under))
    bodies = tuple(Body(name, name, material, mesh.vertices, mesh.triangles) for name, material, mesh in meshes)
    for body in bodies:
        if not body.is_closed() or not body.welded().is_closed():
            raise ComputationError(
                f"the {body.name} does not come out closed",
                file=scene.where,
                remedy="change a pitch, cell or depth by 0.01 mm, or report it",
            )
    return SpecimenBodies(scene, patterns, bodies)


def _patterns(scene: ResolvedSpecimen) -> tuple[PatternGeometry, ...]:
    context, layers = scene.context, scene.specimen.layer
    boxes: list[Box] = []
    for number, layer in enumerate(layers):
        box = FAMILIES[layer.kind].box(layer, context, number)
        check_inside(box, context, number, layer)
        for other, earlier in enumerate(boxes):
            gap = box.gap(earlier)
            if gap < 1e-3:
                meet = "overlaps" if gap < 0 else "touches" if gap == 0 else "comes within a micrometre of"
                raise context.refuse(
                    number,
                    "depth_mm",
                    layer.depth_mm,
                    f"{meet} layer[{other}], which reaches from {_span(earlier.low)} to "
                    f"{_span(earlier.high)} mm; change depth_mm, start_mm or end_mm until matrix lies between them",
                )
        boxes.append(box)
    patterns = tuple(FAMILIES[layer.kind].draw(layer, context, number) for number, layer in enumerate(layers))
    total = sum(len(pattern.mesh.triangles) for pattern in patterns)
    if total > MOST_TRIANGLES:
        raise InputError(
            f"layer: all patterns together take {total / 1000000.0:.1f} million triangles",
            file=scene.where,
            remedy=f"the most is {MOST_TRIANGLES / 1000000.0:g} million, so take larger cells",
        )
    return patterns


def _span(corner: tuple[float, float, float]) -> str:
    return "(" + ", ".join(f"{value:.4g}" for value in corner) + ")"


def _frame(scene: ResolvedSpecimen, frame: FramePlate, material: Material, bodies: list[Mesh]) -> Mesh:
    """Mesh of the frame, with letters between the block and the near edge. Raises InputError for a bad size."""
    where, smallest = scene.where, scene.printer.smallest
    land = 0.5 * (frame.border_mm - frame.hole_diameter_mm)
    least = smallest.wall(material.kind).least or smallest.wall(material.kind).recommended
    if land < least:
        raise InputError(
            f"frame.hole_diameter_mm = {frame.hole_diameter_mm:g}: leaves {land:.3g} mm next to the hole",
            file=where,
            remedy=f"it must be at most {frame.border_mm - 2 * least:.3g} mm, or raise frame.border_mm",
        )
    letters, depth = _letters(scene, frame)
    return plate(
        scene.block,
        bodies,
        frame.border_mm,
        frame.thickness_mm,
        frame.hole_diameter_mm,
        scene.tolerance,
        letters,
        depth,
    )


def _letters(scene: ResolvedSpecimen, frame: FramePlate) -> tuple[list[Array], float]:
    if not frame.mark:
        return [], 0.0
    least = scene.printer.smallest.emboss_mm.recommended
    depth, space = _MARK * least, frame.border_mm - 2.0
    shape = rounded(lettering(frame.mark, min(5.0, space), _MARK * least))
    low, bottom, high, top = shape.bounds()
    free = scene.block.high[0]
    if high - low > free or top - bottom > space or space < 2.0:
        raise InputError(
            f"{high - low:.1f} x {top - bottom:.1f} mm do not fit on {free:g} x {space:g} mm",
            file=scene.where,
            key="frame.mark",
            value=frame.mark,
            remedy="take fewer letters, or raise frame.border_mm",
        )
    if frame.thickness_mm - depth < least:
        raise InputError(
            f"frame.thickness_mm = {frame.thickness_mm:g}: letters {depth:g} mm deep need at least "
            f"{depth + least:g} mm",
            file=scene.where,
        )
    middle = np.array([0.5 * free, -0.5 * frame.border_mm])
    return [np.asarray(line) + middle for line in shape.to_polygons()], depth
