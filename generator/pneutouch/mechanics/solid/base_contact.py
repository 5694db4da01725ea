"""Frictionless contact with the rigid base under the dome: a penalty potential on both faces of the wall.

Also contact of the outer wall with the free top of its own flange: both deform, which couples their nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.solid.banded import FaceSums
from pneutouch.mechanics.solid.elements import AXIAL, RADIAL, TermState, line_shapes
from pneutouch.mechanics.solid.mesh import SolidMesh
from pneutouch.mechanics.solid.object_contact import Contact

_POINTS = 3
"""Number of quadrature points of an edge, as many as for the contact with the plate."""


@dataclass(frozen=True)
class BaseLoad:
    """Load of the outer wall on its support: force along the axis (mu R0^2), greatest traction (mu, per area at rest)
    and greatest penetration (R0); all 0 without contact."""

    force: float = 0.0
    traction: float = 0.0
    penetration: float = 0.0

    def __add__(self, other: BaseLoad) -> BaseLoad:
        """Total of two loads on different parts of the wall."""
        most = (max(a, b) for a, b in ((self.traction, other.traction), (self.penetration, other.penetration)))
        return BaseLoad(self.force + other.force, *most)


class BaseContact:
    """Contact energy psi = (k/2) sum w <-g>^2 on both faces, g the height over the base; an `EnergyTerm`.

    The stiffness is that of the contact with the plate. A wall lies down on its base point by point from the clamp
    outward, so plain Newton steps converge, and the stiff potential needs no more iterations than a soft one. Rounding
    of the gaps is no greater than for the plate, which the residual allows for.
    """

    noise = 0.0

    def __init__(self, outer: BaseFace, inner: BaseFace, faces: FaceSums) -> None:
        self.outer, self.inner, self._faces = outer, inner, faces

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2), or at coefficients of harmonics."""
        outer, inner = self.outer.meet(x), self.inner.meet(x)
        energy, gradient = 0.0, np.zeros(self._faces.outer.size)
        if outer is not None:
            energy += self.outer.energy(outer)
            gradient = self._faces.push(self.outer.force(outer))
        if inner is not None:
            energy += self.inner.energy(inner)
            gradient = gradient + self._faces.swell(self.inner.force(inner))
        return TermState(
            energy,
            gradient,
            None if outer is None else self.outer.hessian(outer),
            None if inner is None else self.inner.hessian(inner),
        )

    def waves(self, x: Array) -> list[tuple[Array, Array] | None]:
        """Second derivatives on the inner and the outer face at positions x: by edge positions (n_edges, 2 n, 2 n), and
        by displacements around the axis (n_edges, n, n), which also move a point outwards; None off the base."""
        meetings = [(face, face.meet(x)) for face in (self.inner, self.outer)]
        return [None if met is None else (face.hessian(met), face.around(met)) for face, met in meetings]

    def load(self, x: Array) -> BaseLoad:
        """Load of the outer wall on the base at positions x (n_nodes, 2)."""
        face, meeting = self.outer, self.outer.meet(x)
        if meeting is None:
            return BaseLoad()
        most = float(meeting.traction.max())
        return BaseLoad(float(np.vdot(face.weight, meeting.traction)), most, most / face.stiffness)


@dataclass(frozen=True)
class BaseMeeting:
    """Radius and traction of the points of a face, and slope and curvature of the base, (n_edges, n_points) each."""

    radius: Array
    traction: Array
    slope: Array
    curve: Array


class BaseFace:
    """The quadrature points of one face of the wall, and the base that they can meet: flat from ``start`` outward, with
    a step up at the ``ring``, given as radius and height (R0)."""

    def __init__(
        self, edges: Index, rest: Array, contact: Contact, start: float, ring: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        self.edges, self.start, self.stiffness = edges, start, contact.stiffness
        self._ring, self.high = ring
        x, w = np.polynomial.legendre.leggauss(_POINTS)
        self.shape, slope = line_shapes(x, edges.shape[1])
        line = rest[edges]
        measure = np.hypot(line[..., 0] @ slope.T, line[..., 1] @ slope.T) * w
        self.weight = 2.0 * np.pi * (line[..., 0] @ self.shape.T) * measure
        self._pairs = (self.shape[:, :, None] * self.shape[:, None, :]).reshape(_POINTS, -1)
        # Edges and corners of the base are as round as the longest cell, as the rim of a plate is.
        self._rim = contact.longest

    def meet(self, nodes: Array) -> BaseMeeting | None:
        """Contact of the points below the base's surface at positions (n_nodes, 2); None without any."""
        line = nodes[self.edges]
        z = line[..., 1] @ self.shape.T
        if z.min() >= self.high:
            return None
        r = line[..., 0] @ self.shape.T
        height, slope, curve = self.surface(r)
        traction = np.maximum(self.stiffness * (height - z), 0.0)
        return BaseMeeting(r, traction, slope, curve) if traction.any() else None

    def surface(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the base at radii r, with its first two derivatives."""
        rim, short = self._rim, np.maximum(self.start - r, 0.0)
        height, slope, curve = -0.5 * short**2 / rim, short / rim, np.where(short > 0.0, -1.0 / rim, 0.0)
        if self.high:
            for corner, sign in ((self._ring, 1.0), (self._ring + self.high, -1.0)):
                along = np.clip((r - corner) / rim + 0.5, 0.0, 1.0)
                beyond = np.maximum(r - corner - 0.5 * rim, 0.0)
                height = height + sign * (0.5 * rim * along**2 + beyond)
                slope = slope + sign * along
                curve = curve + sign * np.where((along > 0.0) & (along < 1.0), 1.0 / rim, 0.0)
        return height, slope, curve

    def energy(self, meeting: BaseMeeting) -> float:
        """Energy of the contact, nondimensional."""
        return float(np.vdot(self.weight, meeting.traction**2)) / (2.0 * self.stiffness)

    def force(self, meeting: BaseMeeting) -> Array:
        """Derivative of the energy by edge positions, (n_edges, 2 n)."""
        load = self.weight * meeting.traction
        out = np.empty((load.shape[0], 2 * self.edges.shape[1]))
        out[:, AXIAL] = -load @ self.shape
        out[:, RADIAL] = (load * meeting.slope) @ self.shape
        return out

    def hessian(self, meeting: BaseMeeting) -> Array:
        """Second derivative by edge positions, (n_edges, 2 n, 2 n)."""
        touching: Flags = meeting.traction > 0.0
        stiff = np.where(touching, self.stiffness, 0.0) * self.weight
        n = self.edges.shape[1]
        out = np.zeros((stiff.shape[0], 2 * n, 2 * n))
        out[:, AXIAL, AXIAL] = (stiff @ self._pairs).reshape(-1, n, n)
        if meeting.slope[touching].any():
            across = -((stiff * meeting.slope) @ self._pairs).reshape(-1, n, n)
            out[:, RADIAL, AXIAL], out[:, AXIAL, RADIAL] = across, across
            along = stiff * meeting.slope**2 + self.weight * meeting.traction * meeting.curve
            out[:, RADIAL, RADIAL] = (along @ self._pairs).reshape(-1, n, n)
        return out

    def around(self, meeting: BaseMeeting) -> Array:
        """Second derivative of the energy by displacements around the axis, (n_edges, n, n)."""
        load = self.weight * meeting.traction * meeting.slope / np.maximum(meeting.radius, 1.0e-300)
        n = self.edges.shape[1]
        return np.asarray((load @ self._pairs).reshape(-1, n, n))


_FLANGE_POINTS = 3
_ROOT_STEPS = 30
_ROOT = 1.0e-14


class _Touch(NamedTuple):
    """Spline coordinate on the flange's top under each wall point, and the traction, (n_edges, n_points) each."""

    place: Array
    traction: Array


def meeting_nodes(mesh: SolidMesh) -> Index:
    """Nodes coupled by the contact, (n_edges, 3 + n_top): those of each edge of the outer wall within a flange width of
    its foot, and those of the flange's top; no rows without a flange."""
    top = top_nodes(mesh)
    if top.size == 0:
        return np.zeros((0, 3), np.intp)
    foot = mesh.nodes[top[0]]
    width = mesh.nodes[top[-1], 0] - foot[0]
    near = mesh.outer[np.hypot(*(mesh.nodes[mesh.outer[:, 0]] - foot).T) < width]
    return np.concatenate([near, np.broadcast_to(top, (near.shape[0], top.size))], axis=1)


def top_nodes(mesh: SolidMesh) -> Index:
    """Nodes of the flange's top from the foot of the wall to the rim, (n_top,)."""
    if mesh.flange.size == 0:
        return np.zeros(0, np.intp)
    return np.append(mesh.flange[:, [0, 2]].ravel(), mesh.flange[-1, 1])


class FlangeContact:
    """Contact energy psi = (k/2) sum w <-g>^2 on the outer wall near its foot; an `EnergyTerm`.

    g is the height of a point of the wall over the top of the flange at the same radius. The top is the natural cubic
    spline through its nodes: its tangent is continuous, and so the energy is once continuously differentiable.
    """

    noise = 0.0

    def __init__(self, meeting: Index, rest: Array, contact: Contact, faces: FaceSums) -> None:
        self._faces, self._stiffness = faces, contact.stiffness
        self._edges, self._top = meeting[:, :3], meeting[0, 3:]
        x, w = np.polynomial.legendre.leggauss(_FLANGE_POINTS)
        self._shape, slope = line_shapes(x, 3)
        line = rest[self._edges]
        measure = np.hypot(line[..., 0] @ slope.T, line[..., 1] @ slope.T) * w
        self._weight = 2.0 * np.pi * (line[..., 0] @ self._shape.T) * measure
        self._spline = cardinal_splines(self._top.size)

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        met = self._meet(x)
        if met is None:
            return TermState(0.0, np.zeros(self._faces.outer.size))
        energy = float(np.vdot(self._weight, met.traction**2)) / (2.0 * self._stiffness)
        n, first, second = evaluated(self._spline, met.place)
        r, z = x[self._top].T
        speed = first @ r
        tilt = (first @ z) / speed
        bend = (second @ z - tilt * (second @ r)) / speed**2
        by_gap = self._directions(tilt, n)
        load = self._weight * met.traction
        stiff = np.where(met.traction > 0.0, self._stiffness * self._weight, 0.0)
        blocks = np.einsum("eq,eqi,eqk->eik", stiff, by_gap, by_gap)
        blocks -= np.einsum("eq,eqik->eik", load, self._curvature(tilt, bend, n, first / speed[..., None]))
        return TermState(energy, self._faces.folded(-np.einsum("eq,eqi->ei", load, by_gap)), fold_blocks=blocks)

    def load(self, x: Array) -> BaseLoad:
        """Load of the wall on the flange at positions x (n_nodes, 2)."""
        met = self._meet(x)
        if met is None:
            return BaseLoad()
        most = float(met.traction.max())
        return BaseLoad(float(np.vdot(self._weight, met.traction)), most, most / self._stiffness)

    def _meet(self, x: Array) -> _Touch | None:
        """Contact of the wall points below the flange's top at positions x (n_nodes, 2); None without any."""
        line, top = x[self._edges], x[self._top]
        r, z = line[..., 0] @ self._shape.T, line[..., 1] @ self._shape.T
        # A spline rises over its highest node by less than its nodes differ.
        if z.min() > top[:, 1].max() + np.ptp(top[:, 1]):
            return None
        place = _located(self._spline, top[:, 0], r)
        height = z - evaluated(self._spline, place)[0] @ top[:, 1]
        below = (height < 0.0) & (r < top[-1, 0])
        return _Touch(place, np.where(below, -self._stiffness * height, 0.0)) if below.any() else None

    def _directions(self, tilt: Array, n: Array) -> Array:
        """Derivative of the gaps by the positions of wall and top, interleaved r and z, (n_edges, n_points, 2 m)."""
        out = np.empty((*tilt.shape, 2 * (3 + n.shape[-1])))
        out[..., 0:6:2], out[..., 1:6:2] = -tilt[..., None] * self._shape, self._shape
        out[..., 6::2], out[..., 7::2] = tilt[..., None] * n, -n
        return out

    def _curvature(self, tilt: Array, bend: Array, n: Array, turn: Array) -> Array:
        """Second derivative of the gaps by positions, (n_edges, n_points, 2 m, 2 m); ``turn`` are slopes over speed.

        The place on the top follows from its radius: d place = (dr - n dR) / speed.
        """
        m = 2 * (3 + n.shape[-1])
        # Change of the radius of a point relative to the top: only this makes a gap nonlinear.
        slide = np.zeros((*tilt.shape, m))
        slide[..., 0:6:2], slide[..., 6::2] = self._shape, -n
        # Change of the tilt of the top at a fixed place.
        tip = np.zeros((*tilt.shape, m))
        tip[..., 6::2], tip[..., 7::2] = -tilt[..., None] * turn, turn
        cross = slide[..., :, None] * tip[..., None, :]
        along = bend[..., None, None] * slide[..., :, None] * slide[..., None, :]
        return np.asarray(-along - cross - np.swapaxes(cross, -1, -2))


def cardinal_splines(count: int) -> Array:
    """Coefficients (count - 1, 4, count) of the natural cubic splines that are 1 at one of the knots 0, 1, 2, ... and 0
    at the others, indexed by interval, power of the distance from the interval's start, and knot of the 1."""
    value = np.eye(count)
    system = 4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)
    right = np.zeros((count, count))
    right[1:-1] = 6.0 * (value[2:] - 2.0 * value[1:-1] + value[:-2])
    system[[0, -1]] = value[[0, -1]]
    bend = np.linalg.solve(system, right)
    slope = value[1:] - value[:-1] - (2.0 * bend[:-1] + bend[1:]) / 6.0
    return np.stack([value[:-1], slope, 0.5 * bend[:-1], (bend[1:] - bend[:-1]) / 6.0], axis=1)


def evaluated(spline: Array, place: Array) -> tuple[Array, Array, Array]:
    """Values and first two derivatives (..., count) at places (...); linear beyond the ends."""
    last = spline.shape[0]
    held = np.clip(place, 0.0, last)
    beyond = (place - held)[..., None]
    k = np.minimum(held.astype(np.intp), last - 1)
    t = (held - k)[..., None]
    a, b, c, d = (spline[k, power] for power in range(4))
    slope = b + t * (2.0 * c + t * 3.0 * d)
    bend = np.where(beyond == 0.0, 2.0 * c + 6.0 * t * d, 0.0)
    return a + t * (b + t * (c + t * d)) + beyond * slope, slope, bend


def _located(spline: Array, radii: Array, r: Array) -> Array:
    """Spline coordinates at which the top, with node radii ``radii``, has the radii r."""
    first = (r - radii[0]) / (radii[1] - radii[0])
    place = np.where(r < radii[0], first, np.interp(r, radii, np.arange(radii.size)))
    for _ in range(_ROOT_STEPS):
        n, slope, _ = evaluated(spline, place)
        step = (np.minimum(r, radii[-1]) - n @ radii) / (slope @ radii)
        place = place + step
        if np.abs(step).max() < _ROOT:
            break
    return place
