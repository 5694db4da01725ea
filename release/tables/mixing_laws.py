"""Stiffness of a mix of a soft and a stiff incompressible solid, and the fractions of the shipped mixing curves.

The fractions of printprofiles/mixing/TangoPlus+VeroClear.toml follow from `placings`: what each source gives a modulus
of the catalogue. Shear moduli are in MPa, ``fraction`` is the volume fraction of the stiff solid, of any shape.
Every bound gives the soft modulus at 0 and the stiff one at 1, and rises between.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pneutouch.arrays import Array
from pneutouch.spec.material import Material

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

LONG_TERM = ((0.0, 0.30), (0.165, 1.08), (0.333, 3.04), (0.5, 5.34), (1.0, 8.47))
"""Fraction of VeroWhite in Agilus30 Black and the mix's long-term modulus, MPa: the Abaqus/MATLAB mixture tool
(HELPER_MaterialsFE.m). VeroWhite's own is that of its rubbery state, not of the glass at room temperature."""

TENSION_INTERCEPT, TENSION_SLOPE = 0.55, 4.2
"""Base-ten logarithm of Young's modulus in MPa of Agilus30 with Vero at fraction 0, and its rise for a fraction of 1,
as printed by a J750 and pulled, from 5 to 40 % Vero: the characterization behind OpenVCAD's J750 conversions (package
pyvcad-attribute-resolver, University of Colorado Boulder; OpenVCAD is DOI 10.1016/j.addma.2023.103912). Rate and
temperature are not stated."""

SOFT_HARDNESS = 41.0
"""Shore A of the soft resin of that characterization."""

HARDNESS_READ = {"FLX9950": 0.04, "FLX9960": 0.07, "FLX9970": 0.11, "FLX9985": 0.19}
"""Fraction of Vero at which that characterization has the hardness of a catalogue resin, to about a percent."""

_RATIOS = (0.55 / 0.17, 0.91 / 0.17, 1.64 / 0.17, 4.0 / 0.17)
"""Moduli of the resins of `HARDNESS_READ` over TangoPlus's, from their files; a test compares them."""

_HALVINGS = 200


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


def _straight(fraction: Array, at: Array, logs: Array, soft: float) -> Array:
    """Straight in the logarithm between points, beyond the last by the last slope."""
    last = (logs[-1] - logs[-2]) / (at[-1] - at[-2])
    beyond = np.maximum(np.asarray(fraction) - at[-1], 0.0)
    return np.asarray(soft * np.exp(np.interp(fraction, at, logs) + last * beyond))


def by_tension(fraction: Array, soft: float, stiff: float) -> Array:
    """The soft modulus times the rise of the tensile modulus on the J750."""
    return np.asarray(soft * 10.0 ** (TENSION_SLOPE * np.asarray(fraction)))


def by_hardness(fraction: Array, soft: float, stiff: float) -> Array:
    """Catalogue moduli where the J750 characterization has their hardness; beyond the last by the last slope."""
    at = np.array([0.0, *HARDNESS_READ.values()])
    return _straight(fraction, at, np.log([1.0, *_RATIOS]), soft)


def by_mixture_tool(fraction: Array, soft: float, stiff: float) -> Array:
    """The soft modulus times the ratio of Agilus30 with VeroWhite, up to half; beyond by the last slope."""
    known = np.array(LONG_TERM[:-1])
    return _straight(fraction, known[:, 0], np.log(known[:, 1] / known[0, 1]), soft)


def fraction_of(law: Law, modulus: float, soft: float, stiff: float) -> float:
    """The least fraction at which a law reaches a modulus, by halving; 1 where it does not."""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        reached = float(law(np.array(middle), soft, stiff)) >= modulus
        low, high = (low, middle) if reached else (middle, high)
    return high


PLACING: dict[str, Law] = {"fraction": by_tension, "fraction_low": by_hardness, "fraction_high": by_mixture_tool}
"""The law of each curve of the mixing file, by the key of a point's fraction on it."""


def placings(modulus: float, soft: float) -> dict[str, float]:
    """The fraction that each law of `PLACING` gives a modulus; none depends on the stiff resin."""
    return {key: fraction_of(law, modulus, soft, 1e3) for key, law in PLACING.items()}


def stiff_moduli(material: Material) -> tuple[float, float]:
    """Least and greatest shear modulus in MPa of a rigid resin taken as incompressible: a third of its Young's modulus.

    A glassy resin's Poisson ratio is nearer 0.4; its modulus is then 7 % more, small compared with the range of E.
    Raises ValueError where the material has none.
    """
    young = material.young_modulus_MPa
    if young is None:
        raise ValueError(f"{material.label} has no young_modulus_MPa")
    return young.least / 3, young.most / 3
