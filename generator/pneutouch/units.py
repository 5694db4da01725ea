"""The unit system: mm, N and MPa inside the program; kPa and mL where numbers enter and leave it.

1 MPa is 1 N/mm2, so no formula needs a factor. A sensitivity alone is in kPa/N everywhere. Names that leave the program
carry their unit (``driving_pressure_kPa``); names inside it do so only for other units than mm, N and MPa.
"""

KPA = 1e-3
"""One kilopascal in MPa."""

ML = 1e3
"""One millilitre in cubic millimetres."""

UM = 1e-3
"""One micrometre in millimetres."""

STANDARD_ATMOSPHERE = 101.325 * KPA
"""Ambient pressure in MPa: the paper gives none; its eq. 15, in gauge pressures, is right for one atmosphere only."""

GAUGE_LIMIT = 100.0 * KPA
"""Upper end in MPa of the range of the SMC PSE543-R06 pressure sensor, +-100 kPa (paper, Supplement C)."""


def grams(volume_mm3: float, density_g_per_cm3: float) -> float:
    """Mass in grams of a volume in mm3 at a density in g/cm3."""
    return volume_mm3 * density_g_per_cm3 * 1e-3
