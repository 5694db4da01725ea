"""Layout of a tray: its parts meshed once for each geometry, marked, packed, and split into jobs by resin."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.catalogue import Library
from pneutouch.errors import ComputationError, InputError
from pneutouch.packing import PackedPosition, PackingArea, pack
from pneutouch.parts.lettering.mark import Mark, Marker, shape_of
from pneutouch.spec.printer import Mode, Printer
from pneutouch.units import UM
from pneutouch.workflows.tray.order import ExpandedTray, TrayOrder, TrayPiece, TrayVariant, changes, expand, jobs

StepReport = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class TrayPart:
    """One part of a tray; its bodies (named ``label-role``) share a frame with their least corner at the origin."""

    label: str
    value: TrayVariant
    copy: int
    solids: tuple[Solid, ...]
    bodies: tuple[Body, ...]
    marks: tuple[Mark, ...]
    place: PackedPosition

    @property
    def name(self) -> str:
        """Name on the tray, unlike the label, which parts of one sensor share."""
        return self.bodies[0].name

    @property
    def size(self) -> Array:
        """Extent (3,) in the part's frame, mm."""
        return np.asarray(np.max([body.bounds[1] for body in self.bodies], axis=0))

    @property
    def footprint(self) -> tuple[float, float]:
        """Extent along x and y on the tray, mm, turned if the part is."""
        x, y, _ = self.size
        return (float(y), float(x)) if self.place.turned else (float(x), float(y))

    @property
    def transform(self) -> Array:
        """Rows (4, 3): the images of the x, y and z axes, and the shift in mm, from the part's frame to the tray's."""
        place = self.place
        if not place.turned:
            return np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [place.x, place.y, 0]], float)
        return np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1], [place.x + self.size[1], place.y, 0]], float)

    def on_tray(self) -> tuple[Body, ...]:
        """The bodies in the tray's frame."""
        axes, shift = self.transform[:3], self.transform[3]
        return tuple(replace(body, vertices=body.vertices @ axes + shift) for body in self.bodies)


@dataclass(frozen=True, eq=False)
class TrayJob:
    """One run of the printer: its mode, the resins loaded, and the parts."""

    mode: Mode
    resins: tuple[str, ...]
    parts: tuple[TrayPart, ...]

    @property
    def height(self) -> float:
        """Height of the tallest part, mm."""
        return max(float(part.size[2]) for part in self.parts)

    @property
    def layers(self) -> int:
        """Number of layers of the tallest part."""
        return layers(self.height, self.mode)


@dataclass(frozen=True, eq=False)
class TrayLayout:
    """A tray ready to be written."""

    order: TrayOrder
    expanded: ExpandedTray
    jobs: tuple[TrayJob, ...]

    @property
    def printer(self) -> Printer:
        """Printer of the tray."""
        return self.expanded.printer

    @property
    def parts(self) -> tuple[TrayPart, ...]:
        """All parts, job after job."""
        return tuple(part for job in self.jobs for part in job.parts)

    @property
    def resin_note(self) -> str:
        """Text for the number of jobs and of resin changes."""
        if len(self.jobs) == 1:
            return "one job, no resin change"
        count = changes([frozenset(job.resins) for job in self.jobs])
        return f"{len(self.jobs)} jobs in this order, {count} {'resin' if count == 1 else 'resins'} loaded between them"

    def name(self, job: TrayJob) -> str:
        """Name of the files of a job."""
        name = self.order.name
        return name if len(self.jobs) == 1 else f"{name}-{self.jobs.index(job) + 1}"


def lay(order: TrayOrder, library: Library | None = None, progress: StepReport = lambda step: None) -> TrayLayout:
    """Draw, group, mesh, mark and pack the parts of a tray. Raises InputError if they cannot be made or do not fit."""
    progress("designs")
    expanded = expand(order, library)
    pieces, printer = expanded.pieces, expanded.printer
    groups = jobs([piece.materials for piece in pieces], printer, order.where)
    labels = [f"{p.value.letter}{copy}" for p in pieces for copy in range(1, p.value.copies + 1)]
    marker = Marker(printer, order.tray.tray.marks, labels)
    done = []
    for group in groups:
        progress("parts")
        done.append(_job([pieces[k] for k in group], printer, marker, order))
    return TrayLayout(order, expanded, tuple(done))


def layers(height: float, mode: Mode) -> int:
    """Number of layers of a mode in a height (mm); a micrometre too much counts as rounding."""
    return math.ceil((height - UM) / (UM * mode.layer_um))


def fill(job: TrayJob, printer: Printer) -> dict[str, float]:
    """Shares of the envelope's footprint that the parts' bounding boxes take, and their true outlines."""
    whole = printer.envelope.x * printer.envelope.y
    boxes = sum(part.footprint[0] * part.footprint[1] for part in job.parts)
    areas: dict[Any, float] = {}
    true = 0.0
    for part in job.parts:
        key = tuple(map(shape_of, part.solids))
        if key not in areas:
            areas[key] = outline(part.bodies).area()
        true += areas[key]
    return {"bounding_boxes": boxes / whole, "outlines": true / whole}


def outline(bodies: Sequence[Body]) -> Any:
    """Outline of bodies seen from above, as a `manifold3d.CrossSection`."""
    from manifold3d import CrossSection, OpType

    return CrossSection.batch_boolean([body.manifold().project() for body in bodies], OpType.Add)


def _job(pieces: list[TrayPiece], printer: Printer, marker: Marker, order: TrayOrder) -> TrayJob:
    mode = printer.mode_for(*(material for piece in pieces for material in piece.materials))
    assert mode is not None
    tolerance = printer.finest_step(mode)
    meshes: dict[Any, Body] = {}
    parts = []
    for piece in pieces:
        for solid in piece.solids:
            if shape_of(solid) not in meshes:
                meshes[shape_of(solid)] = solid.mesh(tolerance)
        plain = [replace(meshes[shape_of(solid)], material=solid.material) for solid in piece.solids]
        parts += [_part(piece, plain, copy, marker) for copy in range(1, piece.value.copies + 1)]
    _check_height(parts, printer, order.where)
    head, envelope = order.tray.tray, printer.envelope
    places = pack(
        [_box(part) for part in parts],
        PackingArea(envelope.x, envelope.y, head.margin_mm, head.spacing_mm),
        order.where,
    )
    parts = [replace(part, place=place) for part, place in zip(parts, places, strict=True)]
    for part in parts:
        # Vertices merge in float32, as readers of STL do.
        opened = next((body for body in part.on_tray() if not body.welded().is_closed()), None)
        if opened is not None:
            problem = f"{opened.name} of {part.value.design}: its mesh does not close; please report the design"
            raise ComputationError(problem)
    resins = dict.fromkeys(resin for piece in pieces for material in piece.materials for resin in material.base_resins)
    return TrayJob(mode, tuple(sorted(resins)), tuple(parts))


def _part(piece: TrayPiece, plain: list[Body], copy: int, marker: Marker) -> TrayPart:
    """A part with its marks, at the origin. In an assembly the rigid bodies are marked, the membrane is not."""
    value, label = piece.value, f"{piece.value.letter}{copy}"
    bodies, marks = [], []
    for solid, body in zip(piece.solids, plain, strict=True):
        done, mark = body, Mark("none", note="marked on the connector")
        if solid.role != "membrane" or len(piece.solids) == 1:
            done, mark = marker.marked(value.assembly, solid, body, label, (value.index, copy))
        stood = done if value.assembly.stands_up(solid.name) else done.turned_over()
        bodies.append(replace(stood, name=f"{label}-{solid.name}"))
        marks.append(mark)
    low = np.min([body.bounds[0] for body in bodies], axis=0)
    moved = tuple(body.moved(-low) for body in bodies)
    return TrayPart(label, value, copy, piece.solids, moved, tuple(marks), PackedPosition(0.0, 0.0, False))


def _box(part: TrayPart) -> tuple[float, float]:
    """Width and depth of a part in mm, rounded up to whole micrometres."""
    x, y, _ = part.size
    return math.ceil(x / UM - 1e-6) * UM, math.ceil(y / UM - 1e-6) * UM


def _check_height(parts: list[TrayPart], printer: Printer, where: str) -> None:
    for part in parts:
        if part.size[2] > printer.envelope.z:
            raise InputError(
                f"{part.name} of {part.value.design} is {part.size[2]:.1f} mm tall",
                file=where,
                remedy=f"the {printer.title} builds {printer.envelope.z:g} mm",
            )
