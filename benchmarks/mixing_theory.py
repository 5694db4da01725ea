"""Stiffness of a mix of a soft and a stiff incompressible solid: bounds and laws.

Shear moduli in MPa, ``fraction`` the volume fraction of the stiff solid, arrays of any shape. Every law gives the soft
modulus at 0 and the stiff one at 1, and rises between.
"""

from collections.abc import Callable

import numpy as np

from pneutouch.arrays import Array

Law = Callable[[Array, float, float], Array]
"""Fraction, soft modulus, stiff modulus to the mix's modulus."""

THRESHOLD = 0.163
"""Volume fraction at which stiff droplets of random places touch all through, as in the Abaqus/MATLAB mixture tool of
Agilus30 and VeroWhite (HELPER_MaterialsFE.m). It is the filling of spheres on a cubic lattice times the site threshold
of that lattice, pi/6 x 0.3116; Scher and Zallen (J. Chem. Phys. 53, 3759, 1970, DOI 10.1063/1.1674565) found near 0.16
for every lattice."""

VOXEL_THRESHOLD = 0.3116
"""`THRESHOLD` for voxels that fill their cells and touch by faces: site threshold of the simple cubic lattice."""

EXPONENT = 0.4
"""Exponent of the share of the stiff solid that is connected, in three dimensions (De Gennes, Scaling Concepts in
Polymer Physics, 1979), as Ouali, Cavaille and Perez took it (Plast. Rubber Compos. Process. Appl. 16, 55-60, 1991)."""


def voigt(fraction: Array, soft: float, stiff: float) -> Array:
    """Equal strain in both: no mix is stiffer (Hill 1952, DOI 10.1088/0370-1298/65/5/307)."""
    return np.asarray((1 - fraction) * soft + fraction * stiff)


def reuss(fraction: Array, soft: float, stiff: float) -> Array:
    """Equal stress in both: no mix is softer (Hill 1952)."""
    return np.asarray(1 / ((1 - fraction) / soft + fraction / stiff))


def hashin_shtrikman_low(fraction: Array, soft: float, stiff: float) -> Array:
    """No isotropic mix is softer: stiff islands in the soft solid.

    Hashin and Shtrikman (J. Mech. Phys. Solids 11, 127-140, 1963, DOI 10.1016/0022-5096(63)90060-7), both solids
    incompressible: G1 + f / (1/(G2 - G1) + 2 (1 - f)/(5 G1)).
    """
    return np.asarray(soft + fraction / (1 / (stiff - soft) + 2 * (1 - fraction) / (5 * soft)))


def hashin_shtrikman_high(fraction: Array, soft: float, stiff: float) -> Array:
    """No isotropic mix is stiffer: soft islands in the stiff solid; the same formula with the solids changed over."""
    return hashin_shtrikman_low(1 - np.asarray(fraction), stiff, soft)


def percolation(fraction: Array, soft: float, stiff: float, threshold: float = THRESHOLD) -> Array:
    """Droplets that touch all through beyond a threshold: Takayanagi's series and parallel model (Ouali et al. 1991).

    With psi = f ((f - fc)/(1 - fc))^0.4 connected, and nothing below the threshold fc, the modulus is
    ((1 - 2 psi + psi f) G1 G2 + (1 - f) psi G2^2) / ((1 - f) G2 + (f - psi) G1): below it that of `reuss`, which is
    less than an isotropic mix can have.
    """
    f = np.asarray(fraction, float)
    joined = f * np.clip((f - threshold) / (1 - threshold), 0.0, None) ** EXPONENT
    above = (1 - 2 * joined + joined * f) * soft * stiff + (1 - f) * joined * stiff**2
    # Nothing but the stiff solid leaves 0/0.
    whole = f >= 1
    below = np.where(whole, 1.0, (1 - f) * stiff + (f - joined) * soft)
    return np.where(whole, stiff, above / below)
