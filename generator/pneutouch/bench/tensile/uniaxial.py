"""Nominal stress of the hyperelastic laws in uniaxial tension, incompressible: P = dW/dlambda (Treloar 1975, ch. 5)."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.laws.tension import first_invariant


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
