"""Frictionless contact with the rigid base under the dome: a penalty potential on both faces of the wall."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.banded import FaceSums
from pneutouch.mechanics.solid.elements import TermState
from pneutouch.mechanics.solid.object_contact import Contact, FacePoints


@dataclass(frozen=True)
class BaseLoad:
    """Load of the outer wall on base or flange: force along the axis (mu R0^2), greatest traction (mu, per area at
    rest) and greatest penetration (R0); all 0 without contact."""

    force: float = 0.0
    traction: float = 0.0
    penetration: float = 0.0

    def __add__(self, other: "BaseLoad") -> "BaseLoad":
        """Total of two loads on different parts of the wall."""
        most = (max(a, b) for a, b in ((self.traction, other.traction), (self.penetration, other.penetration)))
        return BaseLoad(self.force + other.force, *most)


def load_on(face: FacePoints, traction: Array) -> BaseLoad:
    """Load of the points of a face with the tractions (n_edges, n_points)."""
    most = float(traction.max())
    return BaseLoad(float(np.vdot(face.weight, traction)), most, most / face.stiffness)


class BaseContact:
    """Contact energy (k/2) sum w <-g>^2 over the points of both faces, an `EnergyTerm`: g is a point's height over the
    base, <-g> its depth below, w its area at rest, and k the stiffness of the contact with the plate.

    A wall lies down on its base point by point from the clamp outward, so plain Newton steps converge, for a stiff
    potential as fast as for a soft one. Rounding of the gaps is no greater than at the plate, which is allowed for.
    """

    noise = 0.0

    def __init__(self, outer: "BaseFace", inner: "BaseFace", faces: FaceSums) -> None:
        self.outer, self.inner, self._faces = outer, inner, faces

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2), or at coefficients x of the harmonic model."""
        energy, gradient, blocks = 0.0, np.zeros(self._faces.outer.size), list[Array | None]()
        for face, edges in ((self.outer, self._faces.outer), (self.inner, self._faces.inner)):
            met = face.meet(x)
            blocks.append(None if met is None else face.hessian(met))
            if met is not None:
                energy += face.energy(met.traction)
                gradient = gradient + edges.vector([face.lift(met)])
        return TermState(energy, gradient, *blocks)

    def waves(self, x: Array) -> list[tuple[Array, Array] | None]:
        """Second derivatives at positions x for the inner, then the outer face: by edge positions (n_edges, 2 n, 2 n)
        and by displacements around the axis (n_edges, n, n); None for a face that does not touch the base."""
        meetings = [(face, face.meet(x)) for face in (self.inner, self.outer)]
        return [None if met is None else (face.hessian(met), face.around(met)) for face, met in meetings]

    def load(self, x: Array) -> BaseLoad:
        """Load of the outer wall on the base at positions x (n_nodes, 2)."""
        meeting = self.outer.meet(x)
        return BaseLoad() if meeting is None else load_on(self.outer, meeting.traction)


@dataclass(frozen=True)
class BaseMeeting:
    """Radius and vertical traction at points of a face, slope and curvature of the base there; (n_edges, n_points)."""

    radius: Array
    traction: Array
    slope: Array
    curve: Array


class BaseFace(FacePoints):
    """The quadrature points of one face of the wall, and the base that they can meet: flat from the radius ``start``
    outward at the height ``low``, with a ring that begins at radius ``ring[0]`` and rises to ``ring[1]``; R0."""

    def __init__(
        self,
        edges: Index,
        rest: Array,
        contact: Contact,
        start: float,
        ring: tuple[float, float] = (0.0, 0.0),
        low: float = 0.0,
    ) -> None:
        super().__init__(edges, rest, contact.stiffness)
        self.start, self._low = start, low
        self._ring, self.high = ring
        # Edges and corners of the base are as round as the longest cell, as the rim of a plate is.
        self._rim = contact.longest

    def meet(self, nodes: Array) -> BaseMeeting | None:
        """Contact at positions (n_nodes, 2); None if no point is below the base's surface."""
        r, z = self.positions(nodes)
        if z.min() >= self._low + self.high:
            return None
        height, slope, curve = self.surface(r)
        traction = np.maximum(self.stiffness * (height - z), 0.0)
        return BaseMeeting(r, traction, slope, curve) if traction.any() else None

    def surface(self, r: Array) -> tuple[Array, Array, Array]:
        """Height (R0) of the base at radii r, and its first two derivatives, arrays like r."""
        rim, short = self._rim, np.maximum(self.start - r, 0.0)
        height, slope, curve = self._low - 0.5 * short**2 / rim, short / rim, np.where(short > 0.0, -1.0 / rim, 0.0)
        if self.high:
            for corner, sign in ((self._ring, 1.0), (self._ring + self.high, -1.0)):
                along = np.clip((r - corner) / rim + 0.5, 0.0, 1.0)
                beyond = np.maximum(r - corner - 0.5 * rim, 0.0)
                height = height + sign * (0.5 * rim * along**2 + beyond)
                slope = slope + sign * along
                curve = curve + sign * np.where((along > 0.0) & (along < 1.0), 1.0 / rim, 0.0)
        return height, slope, curve

    def lift(self, meeting: BaseMeeting) -> Array:
        """Derivative of the energy by edge positions, (n_edges, 2 n)."""
        return -self.force(meeting.traction, meeting.slope)

    def hessian(self, meeting: BaseMeeting) -> Array:
        """Second derivative of the energy by edge positions, (n_edges, 2 n, 2 n)."""
        return self.stiffened(meeting.traction > 0.0, meeting.slope, meeting.traction * meeting.curve)

    def around(self, meeting: BaseMeeting) -> Array:
        """Second derivative of the energy by displacements around the axis, (n_edges, n, n)."""
        return self.across(meeting.traction * meeting.slope / np.maximum(meeting.radius, 1.0e-300))
