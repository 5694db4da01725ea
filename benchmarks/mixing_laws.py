"""The volume fraction that each source gives a modulus of the catalogue: the named curves of the mixing file."""

from __future__ import annotations

import numpy as np

from benchmarks.mixing_theory import Law
from pneutouch.arrays import Array
from pneutouch.spec.material import Material

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
