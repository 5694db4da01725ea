"""The one unit system: mm, N and MPa inside; kPa and mL where numbers enter and leave.

These three are consistent, so no factor stands in any formula. Names that leave the program carry
their unit (``driving_pressure_kPa``); names inside it do not.
"""

KPA = 1e-3
"""One kilopascal in MPa."""

ML = 1e3
"""One millilitre in cubic millimetres."""

UM = 1e-3
"""One micrometre in millimetres."""

STANDARD_ATMOSPHERE = 101.325 * KPA
"""The paper never gives its p_m; only the atmosphere makes its eq. (15) consistent (gauge pressures)."""

GAUGE_LIMIT = 100.0 * KPA
"""Range of the SMC PSE543-R06 pressure sensor, +-100 kPa (paper, Supplement C)."""


def grams(volume_mm3: float, density_g_per_cm3: float) -> float:
    """Mass in grams of a volume in mm3 at a density in g/cm3."""
    return volume_mm3 * density_g_per_cm3 * 1e-3
