"""Contact with a rigid object, by default a flat plate with a rounded rim: a penalty potential on the outer wall."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.solid.elements import AXIAL, RADIAL, line_shapes
from pneutouch.mechanics.solid.mesh import END, START, SolidMesh

#: Curvature radius of the plate's rim over the plate's radius (0.5 mm at 30 mm diameter, assumed: the paper has none).
#: On a mesh with longer outer edges the rim is rounded to their length.
RIM = 1.0 / 30.0


def rim_radius(radius: Array, longest: Array, rim: float | None = None) -> Array:
    """Curvature radii of the rims of plates: the stated ``rim``, None: `RIM` times ``radius`` (0 if that is inf); at
    least ``longest``, the longest outer edge of the mesh. Lengths in one unit."""
    if rim is not None:
        return np.maximum(rim, longest)
    return np.maximum(np.where(np.isfinite(radius), RIM * radius, 0.0), longest)


def flat_radius(radius: Array, rim: Array) -> Array:
    """Radius up to which a plate is flat: its rim begins half the rim's radius inside, at most half way to the axis."""
    return np.maximum(radius - 0.5 * rim, 0.5 * radius)


class Indenter(Protocol):
    """A rigid body above the dome. All lengths in one unit: mm, or R0 inside the solver."""

    @property
    def height(self) -> float:
        """Height of the body's lowest point."""
        ...

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the underside is the object's own; outside them it turns up as a parabola."""
        ...

    def underside(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the underside at r and its first two derivatives; all shaped like r."""
        ...

    def at(self, height: float) -> "Indenter":
        """The body at another height."""
        ...


def first_contact(body: Indenter, r: Array, z: Array) -> tuple[float, float]:
    """Height of a body at its first contact from above with points r, z (n,), and the radius of this contact."""
    height = z - body.at(0.0).underside(r)[0]
    first = int(height.argmax())
    return float(height[first]), float(r[first])


@dataclass(frozen=True)
class Plate:
    """A plate with its underside at `height`, flat to `radius`, beyond a parabola of curvature 1/`rim`."""

    height: float
    radius: float
    rim: float

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the plate is flat."""
        return 0.0, self.radius

    def underside(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the underside at r and its first two derivatives; all shaped like r."""
        beyond = np.maximum(r - self.radius, 0.0)
        return self.height + 0.5 * beyond**2 / self.rim, beyond / self.rim, np.where(beyond > 0.0, 1.0 / self.rim, 0.0)

    def at(self, height: float) -> "Plate":
        """The plate at another height."""
        return Plate(height, self.radius, self.rim)


@dataclass(frozen=True)
class ContactEvaluation:
    """Contact at the quadrature points of the outer wall, nondimensional: vertical traction per area at rest, vertical
    gap, slope and second derivative of the object's underside, (n_edges, n_points) each."""

    energy: float
    traction: Array
    gap: Array
    slope: Array
    curve: Array


class FacePoints:
    """Quadrature points of edges of a face, with a contact energy (k/2) sum w <-g>^2: k ``stiffness``, g vertical gap,
    <-g> penetration, w ``weight`` (n_edges, n_points), area of a point at rest. ``shape`` and ``slope`` (n_points, n):
    values and derivatives of the shape functions of an edge's n nodes. ``rest``: positions (n_nodes, 2)."""

    def __init__(self, edges: Index, rest: Array, stiffness: float, points: int = 3) -> None:
        self.edges, self.stiffness = edges, stiffness
        x, w = np.polynomial.legendre.leggauss(points)
        self.shape, self.slope = line_shapes(x, edges.shape[1])
        line = rest[edges]
        measure = np.hypot(line[..., 0] @ self.slope.T, line[..., 1] @ self.slope.T) * w
        self.weight = 2.0 * np.pi * self.positions(rest)[0] * measure
        self._pairs = (self.shape[:, :, None] * self.shape[:, None, :]).reshape(points, -1)

    def positions(self, nodes: Array) -> tuple[Array, Array]:
        """Coordinates r and z, (n_edges, n_points) each, of the quadrature points for nodal values (n_nodes, 2)."""
        line = nodes[self.edges]
        return line[..., 0] @ self.shape.T, line[..., 1] @ self.shape.T

    def energy(self, traction: Array) -> float:
        """Energy of the contact for given tractions, nondimensional."""
        return float(np.vdot(self.weight, traction**2)) / (2.0 * self.stiffness)

    def force(self, traction: Array, slope: Array) -> Array:
        """Derivative of the energy by edge positions, (n_edges, 2 n), for tractions from above on the given slopes."""
        load = self.weight * traction
        out = np.empty((load.shape[0], 2 * self.shape.shape[1]))
        out[:, AXIAL] = load @ self.shape
        out[:, RADIAL] = -(load * slope) @ self.shape
        return out

    def stiffened(self, active: Flags, slope: Array, bend: Array) -> Array:
        """Second derivative of the energy, (n_edges, 2 n, 2 n), if the `active` points (n_edges, n_points) touch a
        surface with the given slopes; ``bend``: force down on it times its second derivative, per area at rest."""
        stiff = np.where(active, self.stiffness, 0.0)
        parts = [(AXIAL, AXIAL, stiff)]
        if slope.any():
            across = -stiff * slope
            parts += [(RADIAL, AXIAL, across), (AXIAL, RADIAL, across), (RADIAL, RADIAL, stiff * slope**2 + bend)]
        return self.blocks(parts)

    def blocks(self, parts: list[tuple[slice, slice, Array]]) -> Array:
        """Stiffness of the edges (n_edges, 2 n, 2 n) from ``parts``: direction of a traction, direction of the
        displacement that causes it, and the points' stiffness per area at rest (n_edges, n_points)."""
        n = self.shape.shape[1]
        out = np.zeros((self.weight.shape[0], 2 * n, 2 * n))
        for rows, columns, value in parts:
            out[:, rows, columns] = self.across(value)
        return out

    def across(self, value: Array) -> Array:
        """Stiffness of the edges (n_edges, n, n) for one direction, from that per area at rest (n_edges, n_points)."""
        n = self.shape.shape[1]
        return np.asarray(((self.weight * value) @ self._pairs).reshape(-1, n, n))


class Contact(FacePoints):
    """Contact of an object with the outer wall.

    A stiff penalty: the Newton step settles the contact inside its quadratic model (`newton.direction`), so the cost
    does not depend on k, and k is large enough for the penetration traction/k to be negligible.  The energy is once
    continuously differentiable: the line search meets no jump where points come and go.
    """

    def __init__(self, mesh: SolidMesh, nodes: Array, stiffness: float, points: int = 3) -> None:
        super().__init__(mesh.outer, nodes, stiffness, points)
        # Force due to rounding of the gap; no residual can fall below it.
        self.noise = float(np.finfo(np.float64).eps * stiffness * np.linalg.norm(self.weight))
        line = nodes[mesh.outer]
        self.longest = float(np.hypot(*(line[:, END] - line[:, START]).T).max())

    def outline(self, nodes: Array, points: int = 9) -> tuple[Array, Array]:
        """Coordinates r and z at ``points`` of every outer edge, ends included, (n_edges * points,) each."""
        shape, _ = line_shapes(np.linspace(-1.0, 1.0, points), self.edges.shape[1])
        line = nodes[self.edges]
        return (line[..., 0] @ shape.T).ravel(), (line[..., 1] @ shape.T).ravel()

    def touch(self, nodes: Array, plate: Indenter) -> ContactEvaluation:
        """Contact with the plate at positions (n_nodes, 2)."""
        r, z = self.positions(nodes)
        under, slope, curve = plate.underside(r)
        gap = under - z
        traction = np.maximum(-self.stiffness * gap, 0.0)
        return ContactEvaluation(self.energy(traction), traction, gap, slope, curve)

    def linear(self, touch: ContactEvaluation, move: Array) -> Array:
        """Tractions after a nodal displacement `move` (n_nodes, 2) with linearised gaps; negative for open gaps."""
        return np.asarray(-self.stiffness * self.opening(touch, move, touch.gap))

    def opening(self, touch: ContactEvaluation, move: Array, lift: float | Array) -> Array:
        """Gaps after a nodal displacement `move` (n_nodes, 2), linearised; ``lift`` is the gap before it."""
        r, z = self.positions(move)
        return np.asarray(lift + touch.slope * r - z)

    def least_share(self, here: Array, there: Array, slope_here: float, slope_there: float) -> float:
        """Share in (0, 1] of a move at which the energy of contact plus the rest of a quadratic model is minimal.

        The tractions, negative for open gaps, go from ``here`` to ``there`` (n_edges, n_points), the slope of the rest
        along the move from ``slope_here`` to ``slope_there``; 1 if the total still falls at the end.
        """
        begun, change = here.ravel(), (there - here).ravel()
        turning = begun * (begun + change) < 0.0
        at = np.concatenate([[0.0], np.sort(-begun[turning] / change[turning]), [1.0]])
        pushed = np.maximum(begun + at[:, None] * change, 0.0) @ (self.weight.ravel() * change / self.stiffness)
        slope = slope_here + at * (slope_there - slope_here) + pushed
        past = int(np.argmax(slope > 0.0))
        if not slope[0] < 0.0 < slope[past]:
            return 1.0
        before = past - 1
        return float(at[before] - slope[before] * (at[past] - at[before]) / (slope[past] - slope[before]))

    def hessian(self, touch: ContactEvaluation, active: Flags) -> Array:
        """Second derivative of the energy, (n_edges, 2 n, 2 n), if the `active` points (n_edges, n_points) touch."""
        return self.stiffened(active, touch.slope, -touch.traction * touch.curve)

    def footprint(self, nodes: Array, touch: ContactEvaluation, annular: bool = False) -> "Footprint":
        """Edges of the contact, largest pressure, and largest gap between wall and object inside the contact.

        ``annular``: the object meets the wall around the axis, not on it, so that a gap on the axis is no separation.
        """
        r, _ = self.positions(nodes)
        # Edges run from base to apex: in reverse order the points go outwards from the axis.
        out, gap, load = r.ravel()[::-1], touch.gap.ravel()[::-1], touch.traction.ravel()[::-1]
        meeting = np.flatnonzero(load > 0.0)
        if meeting.size == 0:
            return Footprint(0.0, 0.0, 0.0)
        last, first = int(meeting[-1]), int(meeting[0]) if annular else 0
        # The cell that contains an edge of contact cannot resolve it: gaps count from the next cell inside the contact.
        cell = 2 * self.shape.shape[0]
        begin, end = (min(first + cell, last), max(first + 1, last + 1 - cell)) if annular else (0, last + 1 - cell)
        inside = float(gap[begin : max(begin + 1, end)].max())
        inner = 0.0 if first == 0 else _edge(out[first::-1][:3], gap[:first][::-1][:2])
        return Footprint(_edge(out[last : last + 3], gap[last + 1 : last + 3]), inside, float(load.max()), inner)


@dataclass(frozen=True)
class Footprint:
    """Footprint of the contact: radius of its outer edge; largest gap inside it (positive: the wall has left the object
    there); largest traction; radius of its inner edge (0 if the wall touches on the axis)."""

    radius: float
    inside_gap: float
    traction: float
    inner: float = 0.0


def _edge(r: Array, gap: Array) -> float:
    """Radius of the contact's edge, between the last touching point r[0] and the first free one r[1]; ``gap`` is that
    at r[1] and r[2]. The gap of a smooth wall grows with the square of the distance from the edge, so its square root
    is extrapolated to 0; r[0] without two free points."""
    if gap.size < 2:
        return float(r[0])
    first, second = np.sqrt(np.maximum(gap, 0.0))
    if second <= first:
        return float(0.5 * (r[0] + r[1]))
    return float(np.clip(r[1] - first * (r[2] - r[1]) / (second - first), min(r[0], r[1]), max(r[0], r[1])))
