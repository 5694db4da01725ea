"""Rigid objects other than the plate, with undersides of arcs and lines of continuous slope.

Most are bodies of revolution; a cylinder and an edge lie across the dome. Imported only if such an object presses.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.spec.contact import ContactTable

STEEPEST = float(np.sqrt(3.0))
"""Steepest slope of an underside: that of a flank at 60 degrees to the plate. Contact is measured vertically: the
normal contact stiffness on a flank grows with 1 + slope^2, and a vertical flank has no gap to measure. Up to this slope
the force does not depend on it (`tests/mechanics/solid/test_indenter.py`)."""

_PER_EDGE = 4.0

_FLANKS = 4.0
"""Height of a bar's sides as drawn, over the radius of its edge."""


class UndersidePiece(NamedTuple):
    """A piece of an underside, from the radius ``start`` outwards.

    With ``radius`` 0 a parabola: height ``z`` at ``r``, ``slope`` and ``curve`` (second derivative). Else an arc about
    (``r``, ``z``): its lower side for a positive radius, its upper side for a negative one.
    """

    start: float
    r: float
    z: float
    slope: float = 0.0
    curve: float = 0.0
    radius: float = 0.0

    def scaled(self, factor: float) -> "UndersidePiece":
        """The piece with all lengths multiplied by ``factor``."""
        start, r, z, radius = (factor * x for x in (self.start, self.r, self.z, self.radius))
        return UndersidePiece(start, r, z, self.slope, self.curve / factor, radius)


class ProfileVertex(NamedTuple):
    """A corner of a profile at (r, z), rounded to ``radius``; mm."""

    r: float
    z: float
    radius: float = 0.0


class ObjectShapeError(ValueError):
    """Error for a profile that cannot be an underside; ``index`` is the vertex at fault."""

    def __init__(self, problem: str, index: int) -> None:
        super().__init__(problem)
        self.index = index


@dataclass(frozen=True)
class RigidObject:
    """A rigid body of revolution, or a straight one if ``lying``, with its lowest point at ``height``.

    label:  name of the object in words.
    pieces: the underside from the axis outwards, with its lowest point at 0; the slope is continuous.
    span:   see `Indenter`.  smallest: least radius of curvature that the mesh must resolve.
    circle: distance of the centre of a round section from the axis, and its radius; None for another section.
    lying:  True for a straight body across the plane of symmetry; radii are then distances from its middle.
    flanks: height, above the centre of a round section, up to which a bar's vertical sides are drawn.
    """

    label: str
    pieces: tuple[UndersidePiece, ...]
    span: tuple[float, float]
    smallest: float
    height: float = 0.0
    circle: tuple[float, float] | None = None
    lying: bool = False
    flanks: float = 0.0

    @cached_property
    def _table(self) -> Array:
        return np.array(self.pieces).T

    def underside(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the underside at radii r and its first two derivatives; all shaped like r."""
        table = self._table
        index = np.maximum(np.searchsorted(table[0], r, side="right") - 1, 0)
        _, at, z, slope, curve, radius = table[:, index]
        along = r - at
        bent = radius != 0.0
        drop = np.sqrt(np.where(bent, np.maximum(radius**2 - along**2, 0.0), 1.0))
        drop = np.where(bent, np.maximum(drop, 1e-9 * np.abs(radius)), 1.0)
        sign = np.sign(radius)
        height = np.where(bent, z - sign * drop, z + along * (slope + 0.5 * curve * along))
        first = np.where(bent, sign * along / drop, slope + curve * along)
        second = np.where(bent, sign * radius**2 / drop**3, curve)
        return self.height + height, first, second

    def outline(self, reach: float, count: int = 181) -> Array:
        """Section (n, 2) at r >= 0 for drawing: a round section whole, edge and side of a bar, else the underside."""
        if self.flanks:
            angle = np.linspace(-0.5, 0.0, count) * np.pi
            r, z = self.smallest * np.cos(angle), self.smallest * (1.0 + np.sin(angle))
            top = self.smallest + self.flanks
            return np.stack([np.append(r, self.smallest), self.height + np.append(z, top)], axis=1)
        if self.circle is not None:
            centre, radius = self.circle
            angle = np.linspace(-0.5, 1.5 if centre > 0.0 else 0.5, count) * np.pi
            return np.stack([centre + radius * np.cos(angle), self.height + radius * (1.0 + np.sin(angle))], axis=1)
        r = np.linspace(self.span[0], min(self.span[1], reach), count)
        return np.stack([r, self.underside(r)[0]], axis=1)

    def at(self, height: float) -> "RigidObject":
        """The body with its lowest point at another height."""
        return replace(self, height=height)

    def scaled(self, factor: float) -> "RigidObject":
        """The body with all lengths multiplied by ``factor``."""
        return replace(
            self,
            pieces=tuple(piece.scaled(factor) for piece in self.pieces),
            span=(factor * self.span[0], factor * self.span[1]),
            smallest=factor * self.smallest,
            height=factor * self.height,
            circle=None if self.circle is None else (factor * self.circle[0], factor * self.circle[1]),
            flanks=factor * self.flanks,
        )


def ball(radius: float) -> RigidObject:
    """A ball of ``radius`` (mm): an arc from its lowest point to the flank of 60 degrees, a parabola beyond."""
    body = _body("ball", [_arc(0.0, radius, 0.0)], None, _end(0.0, radius, STEEPEST), radius)
    return replace(body, circle=(0.0, radius))


def cylinder(radius: float) -> RigidObject:
    """A lying cylinder of ``radius`` (mm), endless across the plane of symmetry; its section is that of a ball."""
    return replace(ball(radius), label="cylinder", lying=True)


def edge(radius: float) -> RigidObject:
    """An endless bar with vertical sides and a half-round edge of ``radius`` (mm): below, a cylinder to 60 degrees."""
    return replace(cylinder(radius), label="edge", flanks=_FLANKS * radius)


def cone(half_angle: float, tip: float) -> RigidObject:
    """An endless cone of a half angle (rad, between axis and flank) with a tip rounded to the radius ``tip`` (mm)."""
    slope = float(1.0 / np.tan(half_angle))
    r, z = _on_arc(0.0, tip, slope)
    return _body("cone", [_arc(0.0, tip, 0.0), UndersidePiece(r, r, z, slope)], None, None, tip)


def ring(radius: float, section: float) -> RigidObject:
    """A ring, a wire of radius ``section`` bent to a circle of ``radius`` (mm): flanks to 60 degrees on both sides."""
    inner, outer = _end(radius, section, -STEEPEST), _end(radius, section, STEEPEST)
    body = _body("ring", [_arc(radius, section, inner.start)], inner, outer, section)
    return replace(body, circle=(radius, section))


def profile(vertices: Sequence[ProfileVertex]) -> RigidObject:
    """A body whose underside is the line through corners (r, z), each rounded to its radius (mm).

    The first corner may lie on the axis. The ends turn up with their own radii. Raises ObjectShapeError for a sharp
    corner, an arc that does not fit, and lines that go back inwards, down at an end, or are steeper than `STEEPEST`.
    """
    slopes = _slopes(vertices)
    first, last, on_axis = vertices[0], vertices[-1], vertices[0].r == 0.0
    before = [-slopes[0] if on_axis else None, *slopes]
    pieces = [] if on_axis else [UndersidePiece(first.r, first.r, first.z, slopes[0])]
    reaches = []
    for i, (vertex, inward, outward) in enumerate(zip(vertices, before, [*slopes, None], strict=True)):
        if inward != outward and not vertex.radius > 0.0:
            raise ObjectShapeError("a sharp edge; give its radius in mm as a third number", i)
        rounded, reach = ([], 0.0) if inward is None or outward is None else _corner(vertex, inward, outward)
        pieces += rounded
        reaches.append(reach)
    _check_space(vertices, reaches)
    inner = None if on_axis else _turned_up(first.r, first.z, slopes[0], first.radius)
    outer = _turned_up(last.r, last.z, slopes[-1], last.radius)
    # The range ends where the contact reaches an edge, for which a quarter of the cell density is enough.
    followed = [_PER_EDGE * edge.radius for edge in (last, *([] if on_axis else [first]))]
    followed += [vertex.radius for vertex, reach in zip(vertices, reaches, strict=True) if reach > 0.0]
    return _body("profile", pieces, inner, outer, min(followed))


_MAKE: dict[str, Callable[[dict[str, Any]], RigidObject]] = {
    "ball": lambda sizes: ball(sizes["ball_radius_mm"]),
    "cone": lambda sizes: cone(math.radians(sizes["cone_half_angle_deg"]), sizes["cone_tip_radius_mm"]),
    "ring": lambda sizes: ring(sizes["ring_radius_mm"], sizes["ring_section_radius_mm"]),
    "edge": lambda sizes: edge(sizes["edge_radius_mm"]),
    "cylinder": lambda sizes: cylinder(sizes["cylinder_radius_mm"]),
    "profile": lambda sizes: profile([ProfileVertex(*corner) for corner in sizes["profile_mm"]]),
}


def object_of(contact: ContactTable) -> RigidObject:
    """The object that a design's contact table describes, other than a plate. Raises ObjectShapeError as `profile`."""
    return _MAKE[contact.object](contact.sizes())


def _check_space(vertices: Sequence[ProfileVertex], reaches: Sequence[float]) -> None:
    """Raise ObjectShapeError if the arcs at both ends of a line need more length than it has."""
    for i, (a, b) in enumerate(pairwise(vertices)):
        if reaches[i] + reaches[i + 1] > (1.0 + 1e-9) * np.hypot(b.r - a.r, b.z - a.z):
            raise ObjectShapeError("its arc and that of its neighbour overlap; give smaller radii", i + 1)


def _body(
    label: str,
    pieces: list[UndersidePiece],
    inner: UndersidePiece | None,
    outer: UndersidePiece | None,
    smallest: float,
) -> RigidObject:
    """Object from its own pieces and the parabolas beyond them (None: no edge), shifted to its lowest point at 0."""
    inward = [] if inner is None else [inner._replace(start=0.0)]
    outward = [] if outer is None else [outer]
    span = (0.0 if inner is None else inner.r, np.inf if outer is None else outer.r)
    body = RigidObject(label, (*inward, *pieces, *outward), span, smallest)
    edges = np.array([x for x in (*(p.start for p in body.pieces), *(p.r for p in body.pieces), *span) if x < np.inf])
    lowest = float(body.underside(np.maximum(edges, 0.0))[0].min())
    return replace(body, pieces=tuple(piece._replace(z=piece.z - lowest) for piece in body.pieces))


def _arc(r: float, radius: float, start: float) -> UndersidePiece:
    """Arc about the centre (r, radius), whose lowest point is at height 0, from the radius ``start`` outwards."""
    return UndersidePiece(start, r, radius, radius=radius)


def _on_arc(r: float, radius: float, slope: float) -> tuple[float, float]:
    """Point (r, z) of `_arc` at which it has a given slope."""
    lean = np.hypot(1.0, slope)
    return float(r + radius * slope / lean), float(radius - radius / lean)


def _end(r: float, radius: float, slope: float) -> UndersidePiece:
    """Parabola that continues `_arc` from the point with a given slope on, and turns up."""
    return _turned_up(*_on_arc(r, radius, slope), slope, radius)


def _turned_up(r: float, z: float, slope: float, radius: float) -> UndersidePiece:
    """Parabola that turns up from (r, z), with a given slope and radius of curvature there."""
    return UndersidePiece(r, r, z, slope, float((1.0 + slope**2) ** 1.5 / abs(radius)))


def _slopes(vertices: Sequence[ProfileVertex]) -> list[float]:
    """Slopes of the lines between corners. Raises ObjectShapeError for lines that are not allowed."""
    if len(vertices) < 2:
        raise ObjectShapeError("an underside has two points at least", 0)
    slopes = []
    for i, (a, b) in enumerate(pairwise(vertices), start=1):
        if not b.r > a.r:
            raise ObjectShapeError("the underside must go outwards: each radius above the one before", i)
        slope = (b.z - a.z) / (b.r - a.r)
        if abs(slope) > STEEPEST * (1.0 + 1e-9):
            raise ObjectShapeError("the underside must be no steeper than 60 degrees", i)
        slopes.append(slope)
    if slopes[-1] < 0.0 or (vertices[0].r > 0.0 and slopes[0] > 0.0):
        problem = "an underside must not go down towards its edge; end it where it is level or goes up"
        raise ObjectShapeError(problem, len(vertices) - 1 if slopes[-1] < 0.0 else 0)
    return slopes


def _corner(vertex: ProfileVertex, before: float, after: float) -> tuple[list[UndersidePiece], float]:
    """Arc in a corner between lines of two slopes, with the line after it, and the length it takes of each line."""
    if before == after:
        return [UndersidePiece(vertex.r, vertex.r, vertex.z, after)], 0.0
    low, high = float(np.arctan(before)), float(np.arctan(after))
    reach = vertex.radius * abs(float(np.tan(0.5 * (high - low))))
    signed = vertex.radius if high > low else -vertex.radius
    r, z = vertex.r - reach * np.cos(low), vertex.z - reach * np.sin(low)
    arc = UndersidePiece(
        max(float(r), 0.0), float(r - signed * np.sin(low)), float(z + signed * np.cos(low)), radius=signed
    )
    r, z = float(vertex.r + reach * np.cos(high)), float(vertex.z + reach * np.sin(high))
    return [arc, UndersidePiece(r, r, z, after)], reach
