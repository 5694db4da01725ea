"""A soft object: the surface of a half-space or a layer, and how it gives way to the pressure of a wall on its axis."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.soft.layer import bonded_layer, half_space

_HIGHEST, _STEP, _TO_WIDTH = 60.0, 0.2, 5.0
"""Least greatest wavenumber and step of the integrals, over 1/reach, and greatest over 1/width of a ring."""


@dataclass(frozen=True, slots=True)
class Nodule:
    """A ball in a half-space under the dome's axis: ``depth`` of its middle and ``radius``, mm; ``modulus``, MPa."""

    depth: float
    radius: float
    modulus: float


@dataclass(frozen=True, slots=True)
class SoftBody:
    """A soft object: Young's ``modulus`` (MPa), Poisson ratio, and the ``thickness`` (mm) of a layer that is bonded to
    a rigid ground; None: a half-space. ``nodule``: a stiffer ball inside, of the same Poisson ratio; None: it is even.
    ``label``: the object in words."""

    modulus: float
    poisson: float = 0.49
    thickness: float | None = None
    nodule: Nodule | None = None
    label: str = "soft object"

    def deflection(self, k: Array) -> Array:
        """Deflection over pressure at wavenumbers k (1/mm), mm/MPa."""
        shear = 0.5 * self.modulus / (1.0 + self.poisson)
        if self.thickness is None:
            return half_space(k, shear, self.poisson)
        return bonded_layer(k, self.thickness, shear, self.poisson)

    def taken(self, k: Array) -> Array:
        """Strain at the nodule by a pressure of each wavenumber k (1/mm), over the pressure, times the root of what it
        costs (2, m): the squares of its sums over a load are twice the work that the nodule takes from it.

        Eshelby's equivalent inclusion in the even field that the half-space has at the nodule's middle (Mura,
        Micromechanics of Defects in Solids, 1987, sec. 22, doi:10.1007/978-94-009-3489-4): of the strain without its
        change of volume, and of that change."""
        out = np.zeros((2, len(k)))
        nodule, nu = self.nodule, self.poisson
        if nodule is None:
            return out
        shear, depth, stiffer = 0.5 * self.modulus / (1.0 + nu), k * nodule.depth, nodule.modulus / self.modulus - 1.0
        volume = 4.0 / 3.0 * np.pi * nodule.radius**3
        shape, swelling = 2.0 * (4.0 - 5.0 * nu) / (15.0 * (1.0 - nu)), (1.0 + nu) / (3.0 * (1.0 - nu))
        # Johnson, Contact Mechanics, ch. 3: strain along the axis, and change of volume.
        along = ((1.0 - 2.0 * nu) / 3.0 + depth) * np.exp(-depth) / (2.0 * shear)
        changed = (1.0 - 2.0 * nu) * np.exp(-depth) / shear
        out[0] = np.sqrt(3.0 * shear * volume * stiffer / (1.0 + shape * stiffer)) * along
        if nu < 0.5:
            bulk = self.modulus / (3.0 * (1.0 - 2.0 * nu))
            out[1] = np.sqrt(bulk * volume * stiffer / (1.0 + swelling * stiffer)) * changed
        return out


@dataclass(frozen=True)
class RingCompliance:
    """Deflection of a body's surface by forces on rings of the ``radii`` (n,) and ``widths`` (n,), mm, over which each
    is spread evenly, all within ``reach``. Deflections and slopes at a ring are means over its width."""

    body: SoftBody
    radii: Array
    widths: Array
    reach: float

    @cached_property
    def _spread(self) -> Array:
        """Share of each wave that is left of it over the width of a ring (n, k)."""
        return np.asarray(np.sinc(np.outer(self.widths, self._wavenumbers) / (2.0 * np.pi)))

    @cached_property
    def _wavenumbers(self) -> Array:
        highest = max(_HIGHEST, _TO_WIDTH * self.reach / float(np.median(self.widths)))
        return np.asarray(_STEP * (np.arange(round(highest / _STEP)) + 0.5) / self.reach)

    @cached_property
    def _by_wave(self) -> Array:
        """Deflection by a force at each wavenumber, times the step of the integral (k,)."""
        k = self._wavenumbers
        return np.asarray(self.body.deflection(k) * k * _STEP / self.reach / (2.0 * np.pi))

    @cached_property
    def _taken(self) -> Array:
        """`SoftBody.taken` of a force at each wavenumber, times the step of the integral (2, k)."""
        k = self._wavenumbers
        return np.asarray(self.body.taken(k) * k * _STEP / self.reach / (2.0 * np.pi))

    def _deflected(self, waves: Array) -> Array:
        """Deflection by waves of force (..., k), wave by wave: the nodule couples them."""
        out = waves * self._by_wave
        return out if self.body.nodule is None else np.asarray(out - waves @ self._taken.T @ self._taken)

    @cached_property
    def _waves(self) -> Array:
        from scipy.special import j0

        return np.asarray(j0(np.outer(self.radii, self._wavenumbers)) * self._spread)

    @cached_property
    def matrix(self) -> Array:
        """Deflection at the rings by a force on each, mm/N (n, n); symmetric."""
        return np.asarray(self._deflected(self._waves) @ self._waves.T)

    @cached_property
    def _slopes(self) -> Array:
        from scipy.special import j1

        return np.asarray(j1(np.outer(self.radii, self._wavenumbers)) * self._spread)

    @cached_property
    def slopes(self) -> Array:
        """Slope dw/dr at the rings (rows) by a force on each, 1/N (n, n)."""
        return np.asarray(-self._deflected(self._slopes * self._wavenumbers) @ self._waves.T)

    def curving(self, forces: Array) -> Array:
        """Second derivatives, by the radii, of half the work of forces (n,) on the deflection, N/mm (n, n)."""
        k = self._wavenumbers
        both = np.outer(forces, forces) * (self._deflected(self._slopes * k) @ (self._slopes * k).T)
        bent = (k * self._slopes / self.radii[:, None] - k**2 * self._waves) @ self._deflected(forces @ self._waves)
        both[np.diag_indices_from(both)] += forces * bent
        return np.asarray(both)

    def surface(self, forces: Array, r: Array) -> Array:
        """Deflection (m,) at radii r (m,), mm, under forces (n,), N."""
        from scipy.special import j0

        return np.asarray(j0(np.outer(r, self._wavenumbers)) @ self._deflected(forces @ self._waves))
