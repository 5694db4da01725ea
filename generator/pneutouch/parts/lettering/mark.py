"""Part marks: lettering on rigid bodies, a tally on the membrane's flange, cut in or raised in one batch."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.body import Body, Solid
from pneutouch.parts import Assembly
from pneutouch.parts.lettering.faces import HEIGHTS, LabelPosition, free_area, lettered_faces, placed, spot
from pneutouch.parts.lettering.glyphs import is_clear, lettering, narrowest, rounded
from pneutouch.parts.lettering.tally import TallyRing, tally
from pneutouch.spec.part import ClampedFlange
from pneutouch.spec.printer import Printer
from pneutouch.spec.tray import Marks

_SAFETY = 1.2
"""Marks are drawn larger than the printer's recommended detail by this factor."""

_PAST = 0.25
"""Distance in mm by which a tool reaches past the face it cuts or grows from, so that no two faces coincide."""

_LEAST_LAND = 0.6
"""Wall in mm kept next to a groove: the vendor's smallest feature (objet.com Tips and Tricks)."""


@dataclass(frozen=True)
class Mark:
    """Label or tally that was put on a body.

    Attributes:
        kind: text, tally or none.
        face: The face it is on.
        raised: Raised, not engraved.
        depth: Of the engraving, or height of the raising, mm.
        stroke: Its narrowest line, measured, mm.
        height: Of capitals, mm; 0 for a tally.
        note: Reason why there is none, or another than asked for.
    """

    kind: str
    face: str = ""
    raised: bool = False
    depth: float = 0.0
    stroke: float = 0.0
    height: float = 0.0
    note: str = ""


Tool = tuple[Any, float, float]
"""A CrossSection and the heights between which it stands, mm."""


class Marker:
    """Puts marks on the bodies of one printer; remembers where labels go on each geometry."""

    def __init__(self, printer: Printer, marks: Marks, labels: list[str]) -> None:
        self._printer, self._marks = printer, marks
        self._limit = printer.smallest.emboss_mm.recommended
        self._depth = _SAFETY * self._limit
        self._labels = labels
        self._spots: dict[Any, LabelPosition | None] = {}

    def marked(
        self, assembly: Assembly, solid: Solid, body: Body, label: str, number: tuple[int, int]
    ) -> tuple[Body, Mark]:
        """A body (design frame) with its mark: ``label`` in letters, or ``number`` (value, copy) as a tally."""
        if self._marks == "none":
            return body, Mark("none")
        if solid.role == "membrane":
            return self._tallied(assembly, solid, body, number)
        return self._lettered(assembly, solid, body, label)

    def _lettered(self, assembly: Assembly, solid: Solid, body: Body, label: str) -> tuple[Body, Mark]:
        at = self._spot(assembly, solid, body)
        if at is None:
            return body, Mark("none", note=f"no flat face of the {solid.name} has space for letters 3 mm tall")
        raised = self._marks == "raised" and not at.face.mates
        note = (
            "engraved: raised letters would keep the face from lying flat"
            if at.face.mates and self._marks == "raised"
            else ""
        )
        shape = rounded(placed(lettering(label, at.height, self._limit), at))
        out = 1.0 if at.face.up else -1.0
        ends = sorted(
            (at.face.z + out * (self._depth if raised else _PAST), at.face.z - out * (_PAST if raised else self._depth))
        )
        mark = Mark("text", at.face.name, raised, self._depth, narrowest(shape), at.height, note)
        return _combined(body, (shape, ends[0], ends[1]), raised), mark

    def _spot(self, assembly: Assembly, solid: Solid, body: Body) -> LabelPosition | None:
        """Position at which the widest label of the tray fits on a geometry: all copies carry theirs at one place."""
        key = (shape_of(solid), assembly.layout)
        if key not in self._spots:
            wall = self._printer.smallest.wall(solid.material.kind).recommended
            self._spots[key] = None
            for face in lettered_faces(assembly, solid):
                area = free_area(face, solid, body, self._depth + wall, _LEAST_LAND)
                position = spot(face, area, self._widest, self._heights)
                if position is not None:
                    self._spots[key] = position
                    break
        return self._spots[key]

    @cached_property
    def _widest(self) -> tuple[float, float]:
        """Width and height of a box that takes any label of the tray, capitals 1 mm tall."""
        size = HEIGHTS[-1]
        boxes = [lettering(label, size, self._limit).bounds() for label in self._labels]
        return max(b[2] - b[0] for b in boxes) / size, max(b[3] - b[1] for b in boxes) / size

    @cached_property
    def _heights(self) -> list[float]:
        """Heights of capitals at which the printer can make every glyph of the labels."""
        return [height for height in HEIGHTS if is_clear("".join(self._labels), height, self._limit)]

    def _tallied(self, assembly: Assembly, solid: Solid, body: Body, number: tuple[int, int]) -> tuple[Body, Mark]:
        """On the flange's top; in its edge where a ring seals on the top."""
        clamped = isinstance(assembly.scene.seat, ClampedFlange)
        layout, width = assembly.layout, self._depth
        inner, outer = self._band(assembly, solid)
        high, low = 0.0, -min(self._depth, layout.flange_thickness / 3)
        if clamped:
            inner, outer = layout.flange_radius - self._depth, layout.flange_radius + _PAST
            high, low = -layout.flange_thickness / 3, -2 * layout.flange_thickness / 3
        ring = tally(*number, inner, outer, width)
        if outer - inner < self._limit or high - low < self._limit:
            return body, Mark("none", note=f"the flange is too small for grooves of {self._limit:g} mm")
        if ring is None:
            return body, Mark("none", note="the tally does not go round the flange")
        raised = self._marks == "raised" and not clamped
        note = "engraved in the flange's edge: the ring seals on its top" if clamped else ""
        ends = (low, high) if clamped else (-_PAST, self._depth) if raised else (low, _PAST)
        depth = self._depth if raised or clamped else high - low
        shape = _grooves(ring)
        mark = Mark("tally", "flange edge" if clamped else "flange top", raised, depth, ring.narrowest, 0.0, note)
        return _combined(body, (shape, *ends), raised), mark

    def _band(self, assembly: Assembly, solid: Solid) -> tuple[float, float]:
        """Radii of the grooves on the flange's top: by its edge, clear of the root of the dome."""
        layout = assembly.layout
        land = max(_LEAST_LAND, self._printer.smallest.wall(solid.material.kind).least or 0.0)
        outer = layout.flange_radius - land
        return max(outer - 2 * self._limit, layout.outer_radius + 0.5), outer


def shape_of(solid: Solid) -> Any:
    """Key of the mesh of a solid, its resin apart: equal keys, equal geometry."""
    return solid.name, solid.base, solid.bores, solid.adds, solid.cuts


def _grooves(ring: TallyRing) -> Any:
    from manifold3d import CrossSection

    return rounded(CrossSection(ring.polygons()))


def _combined(body: Body, tool: Tool, raised: bool) -> Body:
    """Cut the tool's parts from a body, or join them, in one batch."""
    from manifold3d import Manifold, OpType

    shape, low, high = tool
    parts = [part.extrude(high - low).translate((0.0, 0.0, low)) for part in shape.decompose()]
    whole = Manifold.batch_boolean([body.manifold(), *parts], OpType.Add if raised else OpType.Subtract)
    mesh = whole.to_mesh64()
    vertices = np.array(mesh.vert_properties[:, :3], order="C")
    return replace(body, vertices=vertices, triangles=mesh.tri_verts.astype(np.int64))
