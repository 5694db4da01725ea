"""Array types, distinct and grouped values, roots by bisection, and cubics through values and slopes (Hermite)."""

from collections.abc import Callable, Hashable, Iterable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)
SharedKey = TypeVar("SharedKey", bound=Hashable)
Grouped = TypeVar("Grouped")

Array = NDArray[np.float64]
"""Real numbers in double precision."""

Singles = NDArray[np.float32]
"""Real numbers in single precision."""

Complex = NDArray[np.complex128]
"""Complex numbers."""

Flags = NDArray[np.bool_]
"""Truth values."""

Index = NDArray[np.intp]
"""Positions (indices) in another array."""

Indices = NDArray[np.int64]
"""Whole numbers that are kept or saved, such as the vertex numbers of triangles and edges."""

Labels = NDArray[np.uint8]
"""The material of each voxel."""

Pixels = NDArray[np.uint32]
"""Packed RGBA colours."""


def grouped(pairs: Iterable[tuple[SharedKey, Grouped]]) -> dict[SharedKey, list[Grouped]]:
    """The values of pairs (key, value) by key, both in the order in which they come."""
    groups: dict[SharedKey, list[Grouped]] = {}
    for key, value in pairs:
        groups.setdefault(key, []).append(value)
    return groups


def distinct(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """The distinct numbers in an array of any shape, ascending, (n,).

    `numpy.unique` would also import NumPy's masked arrays, which takes a tenth of the time that NumPy itself takes.
    """
    ordered = np.sort(values, axis=None)
    first = np.ones(ordered.size, dtype=bool)
    first[1:] = ordered[1:] != ordered[:-1]
    return ordered[first]


def bisected(function: Callable[[Array], Array], low: Array, high: Array, halvings: int = 60) -> Array:
    """Argument at which ``function`` turns from negative to positive between ``low`` and ``high``, elementwise.

    The result is ``low`` where the function is positive there already, and ``high`` where it is still negative there.
    All arrays have the same shape. 2**-60 of the bracket is below the rounding error of a root of that size.
    """
    a, b = np.array(low, float), np.array(high, float)
    for _ in range(halvings):
        middle = 0.5 * (a + b)
        below = function(middle) < 0
        a, b = np.where(below, middle, a), np.where(below, b, middle)
    return np.asarray(0.5 * (a + b))


def hermite(at: Array, x: Array, y: Array, slope: Array) -> Array:
    """Values (n,) at points ``at`` (n,) of the cubics through ``y`` with ``slope`` at ascending ``x``, (m,) each.

    Outside ``x`` the first and the last cubic continue. SciPy's `CubicHermiteSpline` agrees to 3e-16, but importing it
    takes 0.3 s; all imports of the solver take 0.5 s.
    """
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    span, step = x[k + 1] - x[k], y[k + 1] - y[k]
    share = (at - x[k]) / span
    bow = (1 - share) * (slope[k] * span - step) + share * (step - slope[k + 1] * span)
    return np.asarray(y[k] + share * step + share * (1 - share) * bow)
