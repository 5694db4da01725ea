"""A soft object: the surface of a half-space or a layer, and how it gives way to the pressure of a wall on its axis."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.soft.layer import bonded_layer, half_space

_HIGHEST, _STEP, _TO_WIDTH = 60.0, 0.2, 5.0
"""Least greatest wavenumber and step of the integrals, over 1/reach, and greatest over 1/width of a ring."""


@dataclass(frozen=True, slots=True)
class SoftBody:
    """A soft object: Young's ``modulus`` (MPa), Poisson ratio, and the ``thickness`` (mm) of a layer that is bonded to
    a rigid ground; None: a half-space. ``radius`` of its surface, mm, as of a ball; None: it is flat."""

    modulus: float
    poisson: float = 0.49
    thickness: float | None = None
    radius: float | None = None

    @property
    def label(self) -> str:
        """The material in words."""
        layer = "" if self.thickness is None else f", a layer of {self.thickness:g} mm"
        return f"soft ({self.modulus:g} MPa{layer})"

    def deflection(self, k: Array) -> Array:
        """Deflection over pressure at wavenumbers k (1/mm), mm/MPa."""
        shear = 0.5 * self.modulus / (1.0 + self.poisson)
        if self.thickness is None:
            return half_space(k, shear, self.poisson)
        return bonded_layer(k, self.thickness, shear, self.poisson)


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
    def _waves(self) -> Array:
        from scipy.special import j0

        return np.asarray(j0(np.outer(self.radii, self._wavenumbers)) * self._spread)

    @cached_property
    def matrix(self) -> Array:
        """Deflection at the rings by a force on each, mm/N (n, n); symmetric."""
        return np.asarray((self._waves * self._by_wave) @ self._waves.T)

    @cached_property
    def _slopes(self) -> Array:
        from scipy.special import j1

        return np.asarray(j1(np.outer(self.radii, self._wavenumbers)) * self._spread)

    @cached_property
    def slopes(self) -> Array:
        """Slope dw/dr at the rings (rows) by a force on each, 1/N (n, n)."""
        return np.asarray(-(self._slopes * (self._wavenumbers * self._by_wave)) @ self._waves.T)

    def curving(self, forces: Array) -> Array:
        """Second derivatives, by the radii, of half the work of forces (n,) on the deflection, N/mm (n, n)."""
        k = self._wavenumbers
        square = k**2 * self._by_wave
        both = np.outer(forces, forces) * ((self._slopes * square) @ self._slopes.T)
        bent = (self._slopes / np.outer(self.radii, k) - self._waves) @ (square * (forces @ self._waves))
        both[np.diag_indices_from(both)] += forces * bent
        return np.asarray(both)

    def surface(self, forces: Array, r: Array) -> Array:
        """Deflection (m,) at radii r (m,), mm, under forces (n,), N."""
        from scipy.special import j0

        return np.asarray(j0(np.outer(r, self._wavenumbers)) @ (self._by_wave * (forces @ self._waves)))
