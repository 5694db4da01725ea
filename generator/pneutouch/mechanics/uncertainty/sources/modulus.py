"""Sources of uncertainty of the shear modulus: between prints, between laboratories, and by ageing of the resin."""

from dataclasses import replace

import numpy as np

from pneutouch.arrays import Flags
from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.paper_sensor import logarithmic_change, logarithmic_slope, shore_a
from pneutouch.mechanics.uncertainty.source import UncertaintySource, counting
from pneutouch.spec.grade import FROM_CURVE
from pneutouch.spec.material import HARDEST, TENSION_ALONE_PERCENT, Material
from pneutouch.spec.values import Quantity

ASSUMED_FACTOR = 2.7
"""Ratio of the greatest to the least modulus if no independent value is known: an assumption, from four estimates of
relaxed Agilus30, 0.10 to 0.27 MPa, without that at its glass transition, 0.42 MPa (see `Agilus30.toml`)."""

ASSUMED_HARDNESS_SPREAD = 1.64
"""Standard deviation of Shore A if none is known: root mean square over the seven resins of the paper's Table 1."""

ASSUMED_HARDNESS_CHANGE = 2.88
"""Change of Shore A in a year if none is known: root mean square over the seven resins of the paper's Table 1."""

ASSUMED_AGEING = 0.24
"""Relative change of sensitivity in a year if none is known: root mean square of the paper's three values (14.8, 17.0
and 34.9 %, Supplement E)."""

_READINGS = 20
"""Number of readings behind a hardness spread of the paper's Table 1 (Supplement A)."""

_ELASTIC = 3.0
"""Ratio of Young's modulus to shear modulus of an incompressible solid."""

_MODULUS = "shear_modulus"

_GENT = "Gent 1958, d ln E/dS"


def modulus_sources(material: Material, validated: Flags) -> list[UncertaintySource]:
    """Sources for the shear modulus of n sensors in one resin.

    ``validated`` (n,) is True where the model's error was measured in this resin: that error includes the error of the
    published modulus, so the published range does not count there for the sensitivity.
    """
    modulus = material.shear_modulus_MPa
    assert modulus is not None
    size = validated.size
    if modulus.spread is not None:
        spread = np.full(size, modulus.spread / modulus.nominal)
        origin = f"spread of the shear modulus, {modulus.source}; the scatter between prints is in it"
        return [UncertaintySource("modulus as measured", _MODULUS, spread, "lognormal", counting(size), origin, True)]
    if modulus.source.startswith(FROM_CURVE):
        # The band is only that of the fraction; the uncertainty of the resins' own moduli is added.
        bare = modulus.model_copy(update={"low": None, "high": None})
        mixed = [_mixing_fraction(modulus, size)] if modulus.low is not None else []
        return [*mixed, _published(bare, validated), _between_prints(material, size)]
    return [_published(modulus, validated), _between_prints(material, size)]


def biaxial_sources(material: Material, size: int) -> list[UncertaintySource]:
    """Source for the free state of n sensors whose law was fitted to tension alone, as their walls are stretched in two
    directions; its deviation is of one side, from 0 to c, and has the mean square c^2/3 (JCGM 100, F.2.4.5)."""
    law = material.law
    if law is None or law.largest_stretch is None or law.kinds:
        return []
    most, only = TENSION_ALONE_PERCENT[1], (FIGURES.index("limit_pressure_kPa"), FIGURES.index("apex_height_outer_mm"))
    origin = f"equibiaxial stress up to {most:g} % higher than by a law of tension alone: three published rubbers"
    standard = np.full(size, np.log1p(0.01 * most) / np.sqrt(3.0))
    counts = counting(size, only=only)
    return [UncertaintySource("law of tension alone", _MODULUS, standard, "log-rectangular", counts, origin, True)]


def _mixing_fraction(modulus: Quantity, size: int) -> UncertaintySource:
    """Source for the possible error of an assumed mixing curve; see `ResolvedMixingCurve.band_at`."""
    standard = np.full(size, _log_rectangular(modulus.most / modulus.least))
    origin = (
        f"assumed: {modulus.least:.3g} to {modulus.most:.3g} MPa, as the laws differ by which the catalogue's moduli "
        "are given their fractions of the stiff resin; no greater modulus than the curve's stiffest was taken "
        "(docs/background/mixing.md)"
    )
    return UncertaintySource("mixing fraction", _MODULUS, standard, "log-rectangular", counting(size), origin, False)


def _log_rectangular(factor: float) -> float:
    """Standard deviation of the logarithm of a value that is log-uniform between two ends with the ratio ``factor``.

    For a rectangle the squared width is 12 times the variance; the width is kept although the value need not be the
    middle (JCGM 100, 4.3.8).
    """
    return float(np.log(factor) / np.sqrt(12.0))


def _published(modulus: Quantity, validated: Flags) -> UncertaintySource:
    known = modulus.low is not None and modulus.high is not None
    factor = modulus.most / modulus.least if known else ASSUMED_FACTOR
    counts = counting(validated.size)
    counts[SENSITIVITY] = ~validated
    origin = (
        f"range {modulus.least:g} to {modulus.most:g} MPa: {modulus.source}"
        if known
        else f"no independent value known; assumed a factor of {factor:g} from end to end, by four values of Agilus30"
    )
    if validated.any():
        origin += "; near the paper's sensor not counted for the sensitivity, whose model error holds it"
    spread = np.full(validated.size, _log_rectangular(factor))
    return UncertaintySource("published modulus", _MODULUS, spread, "log-rectangular", counts, origin, known)


def _hardness(material: Material) -> tuple[float, bool]:
    if material.shore_a is not None:
        return material.shore_a.nominal, True
    assert material.shear_modulus_MPa is not None
    # A resin softer than the scale can read is taken at its zero, where Gent's slope is greatest.
    return max(0.0, shore_a(_ELASTIC * material.shear_modulus_MPa.nominal)), False


def _between_prints(material: Material, size: int) -> UncertaintySource:
    shore, read = _hardness(material)
    given = material.shore_a.spread if material.shore_a is not None else None
    known = read and given is not None
    spread = ASSUMED_HARDNESS_SPREAD if given is None else given
    origin = f"{_GENT}, at Shore A {shore:.3g} with a standard deviation of {spread:.3g}: " + (
        material.shore_a.source
        if known and material.shore_a is not None
        else "assumed, as the seven resins of the paper's Table 1"
    )
    standard, freedom = np.full(size, logarithmic_slope(shore) * spread), _READINGS - 1 if known else np.inf
    counts = counting(size)
    return UncertaintySource("modulus between prints", _MODULUS, standard, "lognormal", counts, origin, known, freedom)


AGEING = ("ageing", "ageing of the modulus")
"""Names of the sources of `ageing_sources`."""


def ageing_sources(material: Material, size: int, remaining: float = 1.0) -> list[UncertaintySource]:
    """Sources for a year in light and air: for the modulus from the hardness, for the sensitivity as measured.

    ``remaining`` is the share of the year that counts: earlier ageing is in the values, later ageing does not matter.

    The age at use is taken as anything from fresh to a year. A deviation that is uniform from 0 to c has the mean
    square c^2/3 about the fresh value, like a rectangle of half-width c: the drift is not corrected, but included in
    full (JCGM 100, F.2.4.5).
    """
    whole = _ageing_by_hardness(material, size), _ageing_of_sensitivity(material, size)
    if remaining == 1.0:
        return [*whole]
    passed = f"; {remaining:.0%} of it counts"
    return [replace(one, standard=remaining * one.standard, origin=one.origin + passed) for one in whole]


def _ageing_by_hardness(material: Material, size: int) -> UncertaintySource:
    shore, _ = _hardness(material)
    aged = material.shore_a_one_year
    known = aged is not None and material.shore_a is not None
    # The assumed change ends at the top of the scale: there is no modulus at Shore A 100.
    after = aged.nominal if aged is not None and known else max(shore, min(shore + ASSUMED_HARDNESS_CHANGE, HARDEST))
    change = logarithmic_change(shore, after)
    origin = f"{_GENT}: Shore A {shore:.3g} to {after:.3g} in a year, modulus {np.expm1(change):+.0%}; " + (
        aged.source if aged is not None and known else "change assumed, as the seven resins of the paper's Table 1"
    )
    standard, counts = np.full(size, abs(change) / np.sqrt(3.0)), counting(size, without=(SENSITIVITY,))
    return UncertaintySource(AGEING[1], _MODULUS, standard, "log-rectangular", counts, origin, known)


def _ageing_of_sensitivity(material: Material, size: int) -> UncertaintySource:
    given = material.measured.sensitivity_change_one_year_percent if material.measured is not None else None
    change = ASSUMED_AGEING if given is None else given.nominal / 100
    origin = (
        "assumed, root mean square of the three resins measured in the paper, Supplement E"
        if given is None
        else given.source
    )
    origin = f"sensitivity {change:.1%} off after a year: {origin}"
    standard, counts = np.full(size, change / np.sqrt(3.0)), counting(size, only=(SENSITIVITY,))
    return UncertaintySource(AGEING[0], "figure", standard, "rectangular", counts, origin, given is not None)
