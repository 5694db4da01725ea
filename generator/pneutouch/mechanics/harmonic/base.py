"""The rigid base under a wall that is no body of revolution: met at every angle as the solid meets it."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.contact import X, Y, Z, face_operator, upward
from pneutouch.mechanics.harmonic.fields import Harmonics
from pneutouch.mechanics.harmonic.surface import SurfaceHeight, revolved
from pneutouch.mechanics.solid.base_contact import BaseContact, BaseFace, BaseLoad
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.terms import TermState


class HarmonicBase:
    """Base that both faces of the wall can lie down on; an `EnergyTerm` of coefficients (n_nodes, columns)."""

    noise = 0.0

    def __init__(self, solid: SolidModel, base: BaseContact, harmonics: Harmonics, signs: Array) -> None:
        self._solid = solid
        self._outer = _HarmonicFace(base.outer, harmonics, signs)
        self._inner = _HarmonicFace(base.inner, harmonics, signs)

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at coefficients x."""
        outer, inner = self._outer.meet(x), self._inner.meet(x)
        energy, gradient = 0.0, np.zeros(self._solid.size)
        if outer is not None:
            energy += self._outer.energy(outer[1])
            gradient = self._solid.push(self._outer.force(*outer))
        if inner is not None:
            energy += self._inner.energy(inner[1])
            gradient = gradient + self._solid.swell(self._inner.force(*inner))
        return TermState(
            energy,
            gradient,
            None if outer is None else self._outer.hessian(*outer),
            None if inner is None else self._inner.hessian(*inner),
        )

    def load(self, x: Array) -> BaseLoad:
        """Load of the outer wall on the base at coefficients x."""
        met = self._outer.meet(x)
        if met is None:
            return BaseLoad()
        most = float(met[1].max())
        return BaseLoad(float(np.vdot(self._outer.weight, met[1])), most, most / self._outer.stiffness)


class _HarmonicFace:
    """One face of the wall at the angles; arrays of points are (n_edges, n_points, n_angles)."""

    def __init__(self, face: BaseFace, harmonics: Harmonics, signs: Array) -> None:
        self._face, self.stiffness = face, face.stiffness
        self._operator = face_operator(face.edges, face.shape.shape[0], harmonics, signs)
        angles = harmonics.contact_angles.size
        self.weight = np.repeat(face.weight[..., None], angles, axis=2) / angles

    def meet(self, x: Array) -> tuple[SurfaceHeight, Array] | None:
        """The base under the points and their tractions; None if no point is below it."""
        place = self._operator.fields(x)
        if place[..., Z].min() >= self._face.high:
            return None
        under = revolved(self._face.surface, place[..., X], place[..., Y])
        traction = np.maximum(self.stiffness * (under.height - place[..., Z]), 0.0)
        return (under, traction) if traction.any() else None

    def energy(self, traction: Array) -> float:
        return float(np.vdot(self.weight, traction**2)) / (2.0 * self.stiffness)

    def force(self, under: SurfaceHeight, traction: Array) -> Array:
        return self._operator.forces(-(self.weight * traction)[..., None] * upward(under.slope))

    def hessian(self, under: SurfaceHeight, traction: Array) -> Array:
        normal = upward(under.slope)
        stiff = np.where(traction > 0.0, self.stiffness, 0.0) * self.weight
        form = (stiff[..., None] * normal)[..., :, None] * normal[..., None, :]
        form[..., :Z, :Z] += (self.weight * traction)[..., None, None] * under.curve
        return self._operator.stiffness(form)
