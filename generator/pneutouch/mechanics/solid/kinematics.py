"""Rows of strains and of unknowns in the arrays of the finite elements."""

import numpy as np

from pneutouch.arrays import Array

F_RR, F_RZ, F_ZR, F_ZZ, HOOP = range(5)
"""Strains of a point: the in-plane deformation gradient by (R, Z) and the hoop stretch r/R."""

IN_PLANE = slice(F_RR, HOOP)

RADIAL, AXIAL = slice(0, None, 2), slice(1, None, 2)
"""Unknowns of a cell or an edge in r and in z: the positions of its nodes, interleaved."""


def area_ratio(strains: Array) -> Array:
    """Determinant of the in-plane deformation gradient of strains (..., 5)."""
    return np.asarray(strains[..., F_RR] * strains[..., F_ZZ] - strains[..., F_RZ] * strains[..., F_ZR])
