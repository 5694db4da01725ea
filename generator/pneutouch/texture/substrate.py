"""The specimen under the dome: a soft layer on a rigid floor with rows of stiff bars, as a compliance along the path.

The effect of stiff bars. Vero is some 4,000 times stiffer than Agilus30, so a first-order theory in the contrast of
moduli is useless: a small volume of it already removes all the strain that it can. But such a stiff bar is a beam that
spreads the patch's load along its length (`BarRow.bending_length`) and hardly moves. So bars are taken as fixed, and

    over a bar      only the cover sinks, a layer as thin as the bar is deep, bonded to it;
    over a gap      the whole layer sinks;
    in between      the share of bars that the patch feels: the true profile, harmonic by harmonic, through the filter
                    of the patch and that of the cover, which gives how much of a load on top still reaches the bars'
                    depth;
    field           all of it in the field of the specimen with its bars: times mean compliance over bare compliance.

Both filters and both compliances are exact for their layers (Airy's function; Johnson, Contact Mechanics, 1985, ch.
13); their combination is an approximation, which docs/background/texture.md compares with finite elements. Linear, no
friction, uniform pressure over a disc, no surface relief.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.soft.layer import bonded_layer, reaching

_HIGHEST = 40.0
_STEP = 0.05
"""Greatest wavenumber and step of the integral over a disc's field, over 1/radius: compliances accurate to 3e-4."""

FIRST_ZERO = 3.8317
"""First zero of J1: value of k rho at which the patch does not respond to a pattern; rho is then 0.61 pitches."""


def patch_filter(k: Array, radius: Array | float) -> Array:
    """Share of a pattern that remains under a uniform disc: 2 J1(k rho)/(k rho), k in 1/mm; physics.md 4.2."""
    from scipy.special import j1

    x = np.maximum(k * radius, 1e-9)
    return np.asarray(2.0 * j1(x) / x)


class MatrixLayer(NamedTuple):
    """The soft layer: height in mm, shear modulus in MPa, Poisson ratio; bonded to a rigid floor."""

    height: float
    shear_modulus: float
    poisson_ratio: float

    def compliance(self, radius: Array, height: float | None = None) -> Array:
        """Mean deflection under a uniform disc over its force, mm/N, radii (n,); ``height`` (mm) or the layer's."""
        depth = self.height if height is None else height
        if depth <= 0.0:
            return np.zeros_like(radius)
        # Inverse Hankel transform of the load's square; x = k rho.
        x = np.asarray(_STEP * (np.arange(round(_HIGHEST / _STEP)) + 0.5), float)
        k = x / radius[..., None]
        kernel = bonded_layer(k, depth, self.shear_modulus, self.poisson_ratio) * k
        total = (patch_filter(x, 1.0) ** 2 * kernel).sum(axis=-1) * _STEP / radius
        # Beyond the last wavenumber the layer is a half-space, and the filter's square 4/(pi x^3) on average.
        tail = (1.0 - self.poisson_ratio) / self.shear_modulus * 2.0 / (np.pi * _HIGHEST**2) / radius
        return np.asarray((total + tail) / (2.0 * np.pi))


@dataclass(frozen=True, slots=True, eq=False)
class BarRow:
    """One row of stiff bars; mm. ``depth`` is the depth of their tops, ``edges`` (n, 2) are their sides on the path."""

    name: str
    pitch: float
    width: float
    height: float
    depth: float
    edges: Array

    @property
    def duty(self) -> float:
        """Share of the patterned part that bars cover."""
        return self.width / self.pitch

    def harmonic(self, order: int = 1) -> float:
        """Amplitude of the n-th harmonic of the covered share: 2 |sin(n pi w/p)|/(n pi), n = ``order``."""
        return float(2.0 * abs(np.sin(order * np.pi * self.duty)) / (order * np.pi))

    def series(self, length: float, orders: int) -> Array:
        """Coefficients c_n, n = 0..orders, of the covered share over a path: sum of c_n exp(2 pi i n x/length)."""
        n = np.arange(orders + 1)[:, None]
        middle, width = self.edges.mean(axis=1), np.diff(self.edges, axis=1)[:, 0]
        share = width / length * np.sinc(n * width / length)
        return np.asarray((share * np.exp(-2j * np.pi * n * middle / length)).sum(axis=1))

    def covers(self, place: Array) -> Array:
        """Array (n,): 1 for positions (mm) with a bar below, else 0."""
        inside = (place[:, None] >= self.edges[:, 0]) & (place[:, None] < self.edges[:, 1])
        return np.asarray(inside.any(axis=1), float)

    def bending_length(self, young: float, shear: float) -> float:
        """Length over which a bar spreads a load, mm: (4 E I/(4 pi mu))^(1/4), a beam on an elastic bed (Hetenyi 1946).

        4 pi mu is the order of the reaction of a soft body to a sinking line (slender rods: Batchelor 1970, doi
        10.1017/S002211207000191X, without its logarithm). Bars stand still if this length is greater than the patch.
        """
        return float((young * self.width * self.height**3 / 12.0 / (np.pi * shear)) ** 0.25)


def contrast(matrix: MatrixLayer, depth: float, radius: Array) -> Array:
    """Compliance over a gap minus compliance over a bar with its top at ``depth``, mm/N, for patch radii (n,)."""
    return np.asarray(matrix.compliance(radius) - matrix.compliance(radius, depth))


def amplitude(matrix: MatrixLayer, bars: BarRow, radius: Array, order: int = 1) -> Array:
    """Amplitude, mm/N, of a row's compliance at a harmonic of its pitch, for patch radii (n,); no other rows are there.

    Negative where the patch sinks more with its centre over a bar: beyond the first zero of the patch filter.
    """
    k = np.asarray(2.0 * np.pi * order / bars.pitch)
    felt = patch_filter(k, radius) * reaching(k, bars.depth, matrix.poisson_ratio)
    bare = matrix.compliance(radius)
    taken = contrast(matrix, bars.depth, radius)
    return np.asarray(bars.harmonic(order) * felt * taken * (1.0 - bars.duty * taken / bare))


@dataclass(frozen=True)
class Substrate:
    """A specimen under a patch of ``radius`` mm: compliance along a path of ``length`` mm, periodic over it."""

    matrix: MatrixLayer
    bars: tuple[BarRow, ...]
    length: float
    radius: float

    @cached_property
    def bare(self) -> float:
        """Compliance without bars, mm/N."""
        return float(self.matrix.compliance(np.array(self.radius)))

    @cached_property
    def shares(self) -> tuple[float, ...]:
        """Mean over bare compliance for each row as if it were the only one, over the part of the path it fills."""
        taken = [float(contrast(self.matrix, row.depth, np.array(self.radius))) for row in self.bars]
        return tuple(1.0 - row.duty * part / self.bare for row, part in zip(self.bars, taken, strict=True))

    def field(self, row: BarRow) -> float:
        """Field at a row over that of the bare layer: the product of the shares of all rows there, itself included."""
        pairs = zip(self.bars, self.shares, strict=True)
        low, high = row.edges.min(), row.edges.max()
        return float(np.prod([share for other, share in pairs if low < other.edges.max() and other.edges.min() < high]))

    def amplitude(self, row: BarRow, order: int = 1) -> float:
        """The function `amplitude`, mm/N, for a row under this patch, with the other rows there too."""
        share = self.shares[self.bars.index(row)]
        return float(amplitude(self.matrix, row, np.array(self.radius), order)) * self.field(row) / share

    def compliance(self, count: int) -> Array:
        """Compliance at ``count`` equally spaced places of the path, (count,), mm/N, from each row's Fourier series."""
        orders = min(count // 2 - 1, int(_HIGHEST / self.radius * self.length / (2.0 * np.pi)))
        k = np.asarray(2.0 * np.pi * np.arange(orders + 1) / self.length, float)
        spectrum = np.zeros(count // 2 + 1, complex)
        for row in self.bars:
            felt = patch_filter(k, self.radius) * reaching(k, row.depth, self.matrix.poisson_ratio)
            taken = float(contrast(self.matrix, row.depth, np.array(self.radius))) * self.field(row)
            spectrum[: orders + 1] -= taken * felt * row.series(self.length, orders)
        spectrum[0] = self._mean()
        return np.asarray(np.fft.irfft(spectrum, count) * count)

    def _mean(self) -> float:
        """Mean compliance along the path: rows' shares multiply, each to the power of the part that it fills."""
        filled = [float(np.diff(row.edges, axis=1).sum()) / row.duty / self.length for row in self.bars]
        pairs = zip(self.shares, filled, strict=True)
        return self.bare * float(np.prod([share ** min(part, 1.0) for share, part in pairs]))
