"""Influence functions of a half-space and of a layer bonded to a rigid floor, by the wavenumber of the pressure.

Linear elasticity, no friction: exact for both (Airy's function; Johnson, Contact Mechanics, 1985, ch. 13,
doi:10.1017/CBO9781139171731).
"""

import numpy as np

from pneutouch.arrays import Array


def half_space(k: Array, shear: float, poisson: float) -> Array:
    """Deflection over pressure of a half-space at wavenumbers k (1/mm), mm/MPa: (1 - nu)/(mu k); Johnson, ch. 13."""
    return np.asarray((1.0 - poisson) / (shear * k))


def bonded_layer(k: Array, height: float, shear: float, poisson: float) -> Array:
    """Deflection over pressure, mm/MPa, of a layer bonded to a rigid floor, at wavenumbers k above 0 (1/mm).

    (1-nu)/(mu k) (c sinh 2q - 2q)/(c cosh 2q + 2q^2 + (1+c^2)/2), q = k h, c = 3 - 4 nu: at nu = 1/2 the formula of
    physics.md 4.2, for q to 0 the oedometer's h (1 - 2 nu)/(2 mu (1 - nu)). A test solves the layer independently."""
    q, c = k * height, 3.0 - 4.0 * poisson
    e = np.exp(-2.0 * q)
    # Both sides over exp(2q)/2, so that nothing overflows; sinh itself for small q, so that nothing cancels.
    few = np.minimum(q, 1.0)
    above = np.where(q < 1.0, 2.0 * e * (c * np.sinh(2.0 * few) - 2.0 * few), c * (1.0 - e * e) - 4.0 * q * e)
    return np.asarray(half_space(k, shear, poisson) * above / _below(q, c))


def reaching(k: Array, depth: float, poisson: float) -> Array:
    """Pressure on a rigid plate at ``depth`` over the pressure on top, at wavenumbers k; 1 in the limit of k or depth
    0.

    (1+c)((1+c)/2 cosh q + q sinh q)/(c cosh 2q + 2q^2 + (1+c^2)/2), q = k d, c = 3 - 4 nu. For great depth at nu = 1/2
    it is twice the (1 + kd) exp(-kd) of a half-space (physics.md 4.2), because the plate reflects the load.
    """
    q, c = k * depth, 3.0 - 4.0 * poisson
    e = np.exp(-2.0 * q)
    above = (1.0 + c) * np.exp(-q) * (0.5 * (1.0 + c) * (1.0 + e) + q * (1.0 - e))
    return np.asarray(above / _below(q, c))


def _below(q: Array, c: float) -> Array:
    """Denominator of `bonded_layer` and `reaching`, over exp(2q)/2."""
    e = np.exp(-2.0 * q)
    return np.asarray(c * (1.0 + e * e) + 2.0 * e * (2.0 * q * q + 0.5 * (1.0 + c * c)))
