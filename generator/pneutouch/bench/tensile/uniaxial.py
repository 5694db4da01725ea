"""Nominal stress of the hyperelastic laws in uniaxial tension, incompressible: P = dW/dlambda (Treloar 1975, ch. 5)."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array


def first_invariant(stretch: Array | float) -> Array:
    """I1 = l^2 + 2/l of uniaxial tension."""
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


def tension_basis(name: str, count: int, stretch: Array) -> Array:
    """Columns (n, count) whose sum with the constants is the nominal stress: of the laws linear in their constants."""
    plain, above = stretch - stretch**-2, first_invariant(stretch) - 3.0
    if name == "neo-hookean":
        columns = [plain]
    elif name == "mooney-rivlin":
        columns = [2.0 * plain, 2.0 * plain / stretch]
    else:
        columns = [2.0 * (i + 1) * plain * above**i for i in range(count)]
    return np.stack(columns, axis=1)


def tension(name: str, constants: Sequence[float], stretch: Array) -> Array:
    """Nominal stress in MPa of a law by name at stretches (n,); its constants as in `mechanics.laws.LAWS`."""
    if name != "ogden":
        return np.asarray(tension_basis(name, len(constants), stretch) @ np.asarray(constants, float))
    pairs = zip(constants[::2], constants[1::2], strict=True)
    return np.asarray(
        sum((2.0 * mu / alpha) * (stretch ** (alpha - 1.0) - stretch ** (-0.5 * alpha - 1.0)) for mu, alpha in pairs)
    )
