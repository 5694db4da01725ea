"""Uniaxial tension: its first invariant, and the tension that has one, by which states of other kinds are compared."""

import numpy as np

from pneutouch.arrays import Array


def first_invariant(stretch: Array | float) -> Array:
    """I1 = l^2 + 2/l of uniaxial tension of an incompressible solid."""
    lengths = np.asarray(stretch, float)
    return np.asarray(lengths**2 + 2.0 / lengths)


def same_invariant(first: Array | float) -> Array:
    """The stretch of uniaxial tension, at least 1, that has a first invariant (at least 3): l^3 - I1 l + 2 = 0.

    It compares states of other kinds, such as the biaxial one of an inflated dome, with a tensile test: the laws in use
    depend on the first invariant alone, or nearly.
    """
    invariant = np.maximum(np.asarray(first, float), 3.0)
    # The largest of three real roots, by the cosine of a third of an angle.
    third = np.arccos(np.clip(-np.sqrt(27.0 / invariant**3), -1.0, 1.0)) / 3.0
    return np.asarray(2.0 * np.sqrt(invariant / 3.0) * np.cos(third))
