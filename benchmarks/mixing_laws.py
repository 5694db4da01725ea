"""The volume fraction that laws of mixing give a modulus: compared on docs/mixing.md with that of the mixing curve."""

from __future__ import annotations

import numpy as np

from benchmarks.mixing_theory import THRESHOLD, Law, hashin_shtrikman_low, percolation
from pneutouch.arrays import Array
from pneutouch.spec.material import Material

VOXEL_THRESHOLD = 0.3116
"""`THRESHOLD` for voxels that fill their cells and touch by faces: site threshold of the simple cubic lattice."""

LONG_TERM = ((0.0, 0.30), (0.165, 1.08), (0.333, 3.04), (0.5, 5.34), (1.0, 8.47))
"""Fraction of VeroWhite in Agilus30 Black and the mix's long-term modulus, MPa: the Abaqus/MATLAB mixture tool
(HELPER_MaterialsFE.m). VeroWhite's own is that of its rubbery state, not of the glass at room temperature."""

_HALVINGS = 200


def logarithmic(fraction: Array, soft: float, stiff: float) -> Array:
    """The logarithm by volume (Lichtenecker, Phys. Z. 27, 115-158, 1926): an empirical rule, no bound."""
    return np.asarray(soft * (stiff / soft) ** np.asarray(fraction))


def like_agilus(fraction: Array, soft: float, stiff: float) -> Array:
    """The soft modulus times the ratio of Agilus30 with VeroWhite, up to half; beyond by the last slope."""
    known = np.array(LONG_TERM[:-1])
    at, ratio = known[:, 0], np.log(known[:, 1] / known[0, 1])
    last = (ratio[-1] - ratio[-2]) / (at[-1] - at[-2])
    beyond = np.maximum(np.asarray(fraction) - at[-1], 0.0)
    return np.asarray(soft * np.exp(np.interp(fraction, at, ratio) + last * beyond))


def fraction_of(law: Law, modulus: float, soft: float, stiff: float) -> float:
    """The least fraction at which a law reaches a modulus, by halving; 1 where it does not."""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        reached = float(law(np.array(middle), soft, stiff)) >= modulus
        low, high = (low, middle) if reached else (middle, high)
    return high


PLACING: dict[str, Law] = {
    "as Agilus30 with VeroWhite": like_agilus,
    "logarithmic": logarithmic,
    f"droplets that touch beyond {100 * THRESHOLD:g} %": percolation,
    "islands, the softest isotropic mix": hashin_shtrikman_low,
}
"""The laws that give a catalogue modulus its fraction: the first is that of the mixing curve, the others bound its
error."""


def placings(modulus: float, soft: float, stiff: float) -> dict[str, float]:
    """The fraction that each law of `PLACING` gives a modulus."""
    return {name: fraction_of(law, modulus, soft, stiff) for name, law in PLACING.items()}


def stiff_moduli(material: Material) -> tuple[float, float]:
    """Least and greatest shear modulus in MPa of a rigid resin taken as incompressible: a third of its Young's modulus.

    A glassy resin's Poisson ratio is nearer 0.4; its modulus is then 7 % more, small compared with the range of E.
    Raises ValueError where the material has none.
    """
    young = material.young_modulus_MPa
    if young is None:
        raise ValueError(f"{material.label} has no young_modulus_MPa")
    return young.least / 3, young.most / 3
