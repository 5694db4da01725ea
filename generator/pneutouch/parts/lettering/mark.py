"""Part marks: lettering on rigid bodies and a tally on the membrane's flange, engraved or raised in one batch.

A tally is a part mark for a narrow ring: grooves along the flange, counted like strokes on a slate.

It is read counter-clockwise, looking onto the dome. A long groove is the start; then follow a group of grooves for the
value, a wider gap, and a group for the copy. A narrow groove counts one, a middle one five. A is 1, B is 2 and so on.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.solid import mesh_of
from pneutouch.parts import Assembly
from pneutouch.parts.lettering.glyphs import is_clear, lettering, narrowest, rounded
from pneutouch.spec.part import ClampedFlange
from pneutouch.spec.printer import Printer
from pneutouch.spec.tray import Marks

FIVE, START = 3.0, 6.0
"""Widths of the groove for five and of the start groove, over the width of the groove for one."""

_BETWEEN, _APART = 1.3, 4.0
"""Distances between grooves and between groups, over the width of the groove for one."""

_ASIDE = 0.0137
"""Angle in rad of the start: off the x axis, where every mesh has vertices."""

EXPLAINED = (
    "Look onto the dome and go counter-clockwise from the longest stroke, the start. The first group is the letter "
    "(A is 1, without I and O), the second the copy; a narrow stroke counts one, a middle one five."
)


@dataclass(frozen=True, slots=True)
class TallyRing:
    """Sectors of a ring from radius ``inner`` to ``outer`` (mm): first and last angle of each, rad."""

    inner: float
    outer: float
    sectors: tuple[tuple[float, float], ...]

    @property
    def narrowest(self) -> float:
        """Width in mm of the narrowest groove, straight across its inner end, or its length if that is less."""
        angle = min(last - first for first, last in self.sectors)
        return min(2 * self.inner * math.sin(0.5 * angle), self.outer - self.inner)

    def polygons(self) -> list[Array]:
        """Outlines (n, 2) in mm, counter-clockwise, arcs within 0.01 mm."""
        return [self._polygon(first, last) for first, last in self.sectors]

    def _polygon(self, first: float, last: float) -> Array:
        steps = 1 + math.ceil((last - first) / math.sqrt(8 * 0.01 / self.outer))
        angle = np.linspace(first, last, steps + 1)
        arc = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.concatenate([self.outer * arc, self.inner * arc[::-1]])


def tally(index: int, copy: int, inner: float, outer: float, width: float) -> TallyRing | None:
    """Grooves for a value's ``index`` and a ``copy``, both from 1; ``width`` mm is the least width, at ``inner``.

    None if the ring is too short for them with a gap before the start.
    """
    sectors, at = [(0.0, START * width)], START * width
    for number in (index, copy):
        at += _APART * width
        # The widths represent the number, fives first.
        for share in [FIVE] * (number // 5) + [1.0] * (number % 5):
            sectors.append((at, at + share * width))
            at += (share + _BETWEEN) * width
        at -= _BETWEEN * width
    if at + _APART * width > 2 * math.pi * inner:
        return None
    return TallyRing(inner, outer, tuple((_ASIDE + first / inner, _ASIDE + last / inner) for first, last in sectors))


def read(sectors: list[tuple[float, float]]) -> tuple[int, int]:
    """Read index and copy from the angles (rad) of the grooves, in any order and any position on the ring."""
    start = max(range(len(sectors)), key=lambda k: sectors[k][1] - sectors[k][0])
    unit = (sectors[start][1] - sectors[start][0]) / START
    rest = sorted(((a - sectors[start][1]) % (2 * math.pi), b - a) for k, (a, b) in enumerate(sectors) if k != start)
    counts, end = [0], rest[0][0]
    for at, width in rest:
        if at - end > 0.5 * (_BETWEEN + _APART) * unit:
            counts.append(0)
        counts[-1] += 5 if width > 0.5 * (1 + FIVE) * unit else 1
        end = at + width
    index, copy = counts
    return index, copy


_STEP = 0.01
"""Distance in mm from a face at which its sections are taken."""

_TURNS = 24
"""Number of angles around a face at which a label is tried."""

HEIGHTS = (5.0, 4.5, 4.0, 3.5, 3.0)
"""Heights of capitals in mm, in the order tried; below 3 mm they are not legible."""


@dataclass(frozen=True, slots=True)
class RingFace:
    """A ring of a horizontal face: radii and ``z`` in mm; ``up``: facing up; ``mates``: to lie flat on a surface."""

    name: str
    z: float
    up: bool
    inner: float
    outer: float
    mates: bool


@dataclass(frozen=True, slots=True)
class LabelPosition:
    """Position of a label: capitals ``height`` mm tall, ``radius`` mm from the axis at ``angle`` rad, foot inwards."""

    face: RingFace
    height: float
    radius: float
    angle: float


def lettered_faces(assembly: Assembly, solid: Solid) -> list[RingFace]:
    """Faces of a rigid body in order of preference: those that are visible after mounting come first."""
    layout, seat = assembly.layout, assembly.scene.seat
    if solid.role == "ring":
        # The other ring, around which a flange is cast, is in the mould: its faces close on the cavity.
        if not isinstance(seat, ClampedFlange):
            return []
        return [RingFace("ring top", seat.ring_thickness, True, 0.0, layout.ring_radius, False)]
    if solid.role == "plug":
        return [RingFace("plug underside", layout.under, False, 0.0, layout.plate_radius, True)]
    if solid.role != "connector":
        return []
    faces = [
        RingFace("plate top", layout.plate_high, True, layout.ring_radius, layout.plate_radius, False),
        RingFace("plate underside", layout.plate_low, False, 0.0, layout.plate_radius, True),
    ]
    if layout.under < layout.plate_low:
        faces.append(RingFace("boss face", layout.under, False, 0.0, layout.plate_radius, True))
    return faces


def free_area(face: RingFace, solid: Solid, body: Body, depth: float, edge: float) -> Any:
    """CrossSection of the part of a face that is bare, has ``depth`` mm of solid behind it and ``edge`` mm to any edge.

    Around a bore it leaves space for a screw head, which is less than twice as wide (ISO 4762).
    """
    from manifold3d import CrossSection

    whole, inwards = body.manifold(), -1.0 if face.up else 1.0
    section = whole.slice(face.z + inwards * _STEP) ^ whole.slice(face.z + inwards * depth)
    section -= whole.slice(face.z - inwards * _STEP)
    section = (section ^ CrossSection.circle(face.outer, 180)).offset(-edge)
    if face.inner:
        section -= CrossSection.circle(face.inner + edge, 180)
    heads = [CrossSection.circle(2 * bore.radius, 48).translate((bore.x, bore.y)) for bore in solid.bores]
    return section - CrossSection.compose(heads) if heads else section


def spot(face: RingFace, area: Any, box: tuple[float, float], heights: Sequence[float]) -> LabelPosition | None:
    """Place for the tallest lettering of ``heights`` (mm), None if none fits; ``box``: its width and height at 1 mm."""
    from manifold3d import CrossSection

    if area.is_empty():
        return None
    reach = max(abs(x) for x in area.bounds())
    for height in heights:
        rectangle = CrossSection.square((box[0] * height, box[1] * height), True)
        for radius in _radii(reach, box[1] * height):
            for turn in range(_TURNS if radius else 1):
                position = LabelPosition(face, height, radius, 0.5 * math.pi + 2 * math.pi * turn / _TURNS)
                if (placed(rectangle, position) - area).area() < 1e-9:
                    return position
    return None


def placed(shape: Any, at: LabelPosition) -> Any:
    """CrossSection drawn about the origin, moved to its position; mirrored on a face that is read from below."""
    turn = math.degrees(at.angle) - 90.0 if at.radius else 0.0
    turned = (shape if at.face.up else shape.mirror((1.0, 0.0))).rotate(turn)
    return turned.translate((at.radius * math.cos(at.angle), at.radius * math.sin(at.angle)))


def _radii(reach: float, height: float) -> list[float]:
    """Distances from the axis to try: from the rim inwards in steps of a quarter millimetre, then the centre."""
    outermost = reach - 0.5 * height
    count = max(0, int((outermost - 0.5 * height) / 0.25) + 1)
    return [*(outermost - 0.25 * k for k in range(count)), 0.0]


_SAFETY = 1.2
"""Factor by which marks are larger than the printer's recommended detail."""

_PAST = 0.25
"""Distance in mm by which a tool extends past the face it cuts or adds to, so that no two faces coincide."""

_LEAST_LAND = 0.6
"""Material in mm left next to a groove: the vendor's smallest feature (objet.com Tips and Tricks)."""


@dataclass(frozen=True)
class Mark:
    """Label or tally applied to a body.

    Attributes:
        kind: text, tally or none.
        face: Name of the face that carries it.
        raised: True if raised, False if engraved.
        depth: Depth of the engraving or height of the raised mark, mm.
        stroke: Width of the narrowest line, as measured, mm.
        height: Height of capitals, mm; 0 for a tally.
        note: Reason if there is no mark, or not the requested kind.
    """

    kind: str
    face: str = ""
    raised: bool = False
    depth: float = 0.0
    stroke: float = 0.0
    height: float = 0.0
    note: str = ""


Tool = tuple[Any, float, float]
"""A CrossSection, and the lower and upper height of its extrusion, mm."""


class Marker:
    """Puts marks on the bodies of one printer; caches the label position of each geometry."""

    def __init__(self, printer: Printer, marks: Marks, labels: list[str]) -> None:
        self._printer, self._marks = printer, marks
        self._limit = printer.smallest.emboss_mm.recommended
        self._depth = _SAFETY * self._limit
        self._labels = labels
        self._spots: dict[Any, LabelPosition | None] = {}

    def marked(
        self, assembly: Assembly, solid: Solid, body: Body, label: str, number: tuple[int, int]
    ) -> tuple[Body, Mark]:
        """Body (in the design frame) with its mark: ``label`` as lettering, or ``number`` (value, copy) as a tally."""
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
        """Position where the widest label of the tray fits, the same for copies of a geometry; None without one."""
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
        """Body with a tally on the flange's top, or in its edge if a ring seals on the top."""
        from manifold3d import CrossSection

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
        shape = rounded(CrossSection(ring.polygons()))
        mark = Mark("tally", "flange edge" if clamped else "flange top", raised, depth, ring.narrowest, 0.0, note)
        return _combined(body, (shape, *ends), raised), mark

    def _band(self, assembly: Assembly, solid: Solid) -> tuple[float, float]:
        """Radii of the grooves on the flange's top: near its edge, away from the root of the dome."""
        layout = assembly.layout
        land = max(_LEAST_LAND, self._printer.smallest.wall(solid.material.kind).least or 0.0)
        outer = layout.flange_radius - land
        return max(outer - 2 * self._limit, layout.outer_radius + 0.5), outer


def shape_of(solid: Solid) -> Any:
    """Hashable key of a solid's geometry, whatever its resin: equal keys mean equal geometry."""
    return solid.name, solid.base, solid.bores, solid.adds, solid.cuts


def _combined(body: Body, tool: Tool, raised: bool) -> Body:
    """Cut the tool's parts from a body, or join them to it, in one batch."""
    from manifold3d import Manifold, OpType

    shape, low, high = tool
    parts = [part.extrude(high - low).translate((0.0, 0.0, low)) for part in shape.decompose()]
    whole = Manifold.batch_boolean([body.manifold(), *parts], OpType.Add if raised else OpType.Subtract)
    vertices, triangles = mesh_of(whole)
    return replace(body, vertices=vertices, triangles=triangles)
