"""Mass, centre and inertia of bodies, by their meshes and their exact volumes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid

_KG, _M = 1e-3, 1e-3


@dataclass(frozen=True)
class RigidInertia:
    """Mass in kg, centre of mass in m (3,), and inertia about the origin of the frame, kg m2 (3, 3)."""

    mass: float
    centre: Array
    about_origin: Array

    @property
    def about_centre(self) -> Array:
        """Inertia about the centre of mass, kg m2 (3, 3)."""
        return self.about_origin - _steiner(self.mass, self.centre)

    def __add__(self, other: RigidInertia) -> RigidInertia:
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        return RigidInertia(mass, centre, self.about_origin + other.about_origin)

    def without(self, part: RigidInertia) -> RigidInertia:
        """Inertia that is left when a part of it moves on its own."""
        return self + RigidInertia(-part.mass, part.centre, -part.about_origin)


def ball_inertia(mass: float, centre: Array, gyration: float) -> RigidInertia:
    """A mass (kg) about ``centre`` (m) with one radius of gyration (m) about all axes."""
    return RigidInertia(mass, centre, _steiner(mass, centre) + mass * gyration**2 * np.eye(3))


def inertia_of(bodies: Iterable[Body], solids: Iterable[Solid]) -> RigidInertia:
    """Inertia of bodies in their common frame, at the nominal densities of their materials.

    The mass is that of the exact volume. Centre and shape of the tensor are the mesh's, whose volume differs by the
    chord tolerance: the tensor is scaled by the ratio of both volumes.
    """
    parts = [_inertia(body, solid) for body, solid in zip(bodies, solids, strict=True)]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _inertia(body: Body, solid: Solid) -> RigidInertia:
    """Inertia by the integrals of 1, x and x y over the tetrahedra from the origin to every triangle."""
    a, b, c = np.moveaxis(body.corners * _M, 1, 0)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    total, sums = volumes.sum(), a + b + c
    centre = (volumes[:, None] * sums).sum(axis=0) / 4.0 / total
    second = sum(np.einsum("i,ij,ik->jk", volumes, part, part) for part in (a, b, c, sums)) / 20.0
    density = solid.mass * _KG / total
    return RigidInertia(density * total, centre, density * (np.trace(second) * np.eye(3) - second))


def _steiner(mass: float, centre: Array) -> Array:
    return np.asarray(mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)))
