"""Second derivatives of an isotropic energy by the shears that an axisymmetric deformation does not have."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import BY_A, BY_J, Strain
from pneutouch.mechanics.solid.kinematics import F_RR, F_RZ, F_ZR, F_ZZ, HOOP

R_T, Z_T, T_R, T_Z = range(4)
"""The shears of a point: F_(r theta), F_(z theta), F_(theta R) and F_(theta Z)."""


def shear_moduli(law: Hyperelastic, strains: Array, pressure: Array) -> Array:
    """Hessian (n_points, 4, 4) by the shears, in MPa, of the law's energy plus ``pressure`` (n_points,), MPa, times J.

    ``strains`` (n_points, 5) as in `kinematics`. The deformation gradient is block diagonal, so its principal axes are
    two in the plane and the hoop. A shear between one of the first two and the hoop leaves the third alone: there the
    energy is that of a plane deformation, a function of a = |F|^2 and j = det F of this pair, with the Hessian 2 W_a
    for each shear alone and -W_j for both. It is smooth where stretches coincide.
    """
    e, d = 0.5 * (strains[:, F_RR] + strains[:, F_ZZ]), 0.5 * (strains[:, F_RR] - strains[:, F_ZZ])
    k, g = 0.5 * (strains[:, F_ZR] - strains[:, F_RZ]), 0.5 * (strains[:, F_ZR] + strains[:, F_RZ])
    # F = rotation(left) diag(stretches) rotation(right); left + right has the direction (e, k), left - right (d, g).
    mean, half = np.hypot(e, k), np.hypot(d, g)
    stretch, hoop = np.stack([mean + half, mean - half]), strains[:, HOOP]
    other = stretch[::-1]
    jet = law.energy(Strain((stretch**2 + hoop**2).ravel(), (stretch * hoop).ravel(), other.ravel())).data
    alone = 2.0 * jet[BY_A].reshape(2, -1)
    both = -(jet[BY_J].reshape(2, -1) + pressure * other)
    safe = np.where(half > 0.0, half, 1.0)
    cos_sum, sin_sum, cos_gap, sin_gap = e / mean, k / mean, d / safe, g / safe
    even, odd = 0.5 * (alone[0] + alone[1]), 0.5 * (alone[0] - alone[1])
    out = np.empty((strains.shape[0], 4, 4))
    twice_left = odd * (cos_sum * cos_gap - sin_sum * sin_gap), odd * (sin_sum * cos_gap + cos_sum * sin_gap)
    twice_right = odd * (cos_sum * cos_gap + sin_sum * sin_gap), odd * (sin_sum * cos_gap - cos_sum * sin_gap)
    out[:, R_T, R_T], out[:, Z_T, Z_T] = even + twice_left[0], even - twice_left[0]
    out[:, R_T, Z_T] = out[:, Z_T, R_T] = twice_left[1]
    out[:, T_R, T_R], out[:, T_Z, T_Z] = even + twice_right[0], even - twice_right[0]
    out[:, T_R, T_Z] = out[:, T_Z, T_R] = -twice_right[1]
    even, odd = 0.5 * (both[0] + both[1]), 0.5 * (both[0] - both[1])
    out[:, R_T, T_R] = out[:, T_R, R_T] = even * cos_sum + odd * cos_gap
    out[:, R_T, T_Z] = out[:, T_Z, R_T] = odd * sin_gap - even * sin_sum
    out[:, Z_T, T_R] = out[:, T_R, Z_T] = odd * sin_gap + even * sin_sum
    out[:, Z_T, T_Z] = out[:, T_Z, Z_T] = even * cos_sum - odd * cos_gap
    return out
