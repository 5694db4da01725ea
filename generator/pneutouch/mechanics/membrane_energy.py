"""The wall's energy in the membrane theory: neo-Hookean, incompressible, equibiaxial (paper, eq. 7).

With thickness stretch lambda and in-plane stretches lambda**-1/2, W = C1 (lambda^2 + 2/lambda - 3), C1 = mu/2.
"""

from pneutouch.arrays import Array


def energy(shear_modulus: float, thickness_stretch: Array) -> Array:
    """Energy density, MPa, of the undeformed wall."""
    return 0.5 * shear_modulus * (thickness_stretch**2 + 2 / thickness_stretch - 3)


def energy_slope(shear_modulus: float, thickness_stretch: Array) -> Array:
    """Derivative of the energy density by the thickness stretch, MPa."""
    return shear_modulus * (thickness_stretch - thickness_stretch**-2)
