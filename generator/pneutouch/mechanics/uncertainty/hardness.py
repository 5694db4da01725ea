"""Shore A hardness to modulus: A. N. Gent, Rubber Chem. Technol. 31, 896-906 (1958), in its usual metric form.

E = 0.0981 (56 + 7.62336 S) / (0.137505 (254 - 2.54 S)) MPa. Only its slope and its ratios are used: the relation's own
level is not trusted for a relaxed modulus (it gives TangoPlus twice the modulus of the paper's Table 1). Above 80 the
scale is compressed and the slope grows without bound towards 100.
"""

import numpy as np

_OFFSET, _RISE = 56.0, 7.62336
_UNIT = 0.0981 / (0.137505 * 2.54)
_FULL = 100.0


def young_modulus(shore_a: float) -> float:
    """E in MPa of a Shore A hardness below 100."""
    return _UNIT * (_OFFSET + _RISE * shore_a) / (_FULL - shore_a)


def shore_a(modulus: float) -> float:
    """The Shore A hardness of a Young's modulus in MPa: `young_modulus` solved."""
    return (_FULL * modulus - _UNIT * _OFFSET) / (modulus + _UNIT * _RISE)


def logarithmic_slope(shore: float) -> float:
    """Logarithmic slope d ln E / dS, per unit of Shore A."""
    return _RISE / (_OFFSET + _RISE * shore) + 1.0 / (_FULL - shore)


def logarithmic_change(before: float, after: float) -> float:
    """Logarithm of the ratio of the moduli at two hardnesses."""
    return float(np.log(young_modulus(after) / young_modulus(before)))
