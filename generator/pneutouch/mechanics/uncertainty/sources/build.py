"""The uncertainty of the print and its surroundings: wall, radius, air behind the cavity, weather, driving pressure."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import Distribution, UncertaintySource, counting
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

BORE, BORE_TOLERANCE = 2.5, 0.1
"""Bore of a 4 mm tube (SMC TU0425) and its tolerance, mm. Only outer diameters have a published one, +-0.1 mm for nylon
(SMC KQ2 precautions); that the bore keeps the same is an assumption."""

UNSTATED_VOLUME = 100.0
"""Air in fitting and gauge that a stated dead volume may have missed, mm3: an assumption, 20 mm of a 2.5 mm bore."""

WEATHER = 4.5 * KPA
"""Sea level pressure mostly stays within 960 and 1050 mbar (San Francisco State University, Geosciences, course M301,
Atmospheric Pressure)."""

GAUGE = 0.02
"""Temperature characteristic of the SMC PSE543, +-2 % of its range (paper, Supplement C)."""

_LIMITS = 3.0
"""Standard deviations within which limits that hold nearly always are read (JCGM 100, 4.3.5)."""

_ROOT = np.sqrt(3.0)

_SMC_TUBES = "SMC states outer diameters only"
_BAROMETER = (
    "960 to 1050 mbar at sea level (San Francisco State University, Geosciences M301), read as three standard "
    "deviations to either side; the height of the place is not in it"
)
_GAUGE_DATA = (
    "SMC PSE543, +-2 % (paper, Supplement C); assumed to be of the reading, the gauge being zeroed when vented"
)


def build_sources(batch: SensorBatch, printer: Printer) -> list[UncertaintySource]:
    """Sources on dimensions, dead volume, ambient and driving pressure of n sensors from one printer."""
    accuracy = printer.accuracy_mm.nominal
    origin = (
        f"{printer.title}, +-{accuracy:g} mm, even between its bounds (JCGM 100, 4.3.7): {printer.accuracy_mm.source}"
    )
    bore = 2.0 * BORE_TOLERANCE / BORE

    bores = f"assumed: bore {BORE:g} +-{BORE_TOLERANCE:g} mm, so the volume +-{bore:.0%}; {_SMC_TUBES}"
    unstated = f"assumed: up to {UNSTATED_VOLUME * 1e-3:g} mL of air that the stated dead volume does not hold"
    wall, radius = accuracy / _ROOT / batch.wall_thickness, 0.5 * accuracy / _ROOT / batch.inner_radius
    volume, fitting = bore / _ROOT * np.abs(batch.dead_volume), np.full(len(batch), UNSTATED_VOLUME / _ROOT)
    ambient, driving = WEATHER / _LIMITS / batch.ambient_pressure, np.full(len(batch), GAUGE / _ROOT)

    def source(name: str, acts_on: str, standard: Array, origin: str, known: bool) -> UncertaintySource:
        shape: Distribution = "normal" if acts_on == "ambient_pressure" else "rectangular"
        return UncertaintySource(name, acts_on, standard, shape, counting(len(batch)), origin, known)

    return [
        source("wall thickness", "wall_thickness", wall, origin, True),
        source("inner radius", "inner_radius", radius, f"half of the diameter's: {origin}", True),
        source("tube bore", "dead_volume", volume, bores, False),
        source("fitting and gauge", "dead_volume", fitting, unstated, False),
        source("weather", "ambient_pressure", ambient, _BAROMETER, True),
        source("driving pressure", "driving_pressure", driving, _GAUGE_DATA, False),
    ]
