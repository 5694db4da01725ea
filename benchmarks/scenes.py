"""The scenes that methods are compared on: sensors and presses that differ in everything the answer depends on."""

from __future__ import annotations

from dataclasses import dataclass

from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import GAUGE_LIMIT, KPA, ML, STANDARD_ATMOSPHERE

OGDEN_AGILUS30 = ("ogden", (1.423, -3.68))
"""Agilus30 (A100V0), instantaneous, in the 2 mu/alpha^2 convention; fitted to 37 % strain with R2 0.60.

Source: alexdummer/dogbone-experiments, simulations/material-calibration/parameters; a repository's data, unreviewed.
"""

MOONEY_RIVLIN_AGILUS30 = ("mooney-rivlin", (0.248, 0.984))
"""The same resin and repository, Mooney-Rivlin instantaneous (C1, C2 in MPa)."""


@dataclass(frozen=True)
class Scene:
    """A sensor, and the gauge pressure (MPa) it is driven to before it is pressed."""

    name: str
    sensor: Sensor
    pressure: float

    @property
    def wall_ratio(self) -> float:
        """t0/R0."""
        return self.sensor.dome.wall_thickness / self.sensor.dome.inner_radius


def sensor(radius: float, wall: float, mu: float, depth_ratio: float, dead_ml: float = 0.0, nu: float = 0.49) -> Sensor:
    """A sensor under a plate wider than itself, at sea level, pressed in 14 steps to a share of its radius."""
    return Sensor(
        Dome(Hemisphere(radius, wall)),
        WallMaterial(mu, nu),
        GasCircuit(ambient_pressure=STANDARD_ATMOSPHERE, dead_volume=dead_ml * ML, gauge_limit=GAUGE_LIMIT),
        IndentationProtocol(plate_radius=radius * 15 / 9.25, depth=depth_ratio * radius, steps=14),
    )


def paper(mu: float, depth_ratio: float = 0.75, dead_ml: float = 0.0, nu: float = 0.49) -> Sensor:
    """The paper's sensor: 9.25 mm inside, wall 1.5 mm."""
    return sensor(9.25, 1.5, mu, depth_ratio, dead_ml, nu)


PAPER = paper(0.17)
"""The paper's sensor in TangoPlus."""

SCENES = (
    Scene("paper, TangoPlus, 0 kPa", PAPER, 0.0),
    Scene("paper, TangoPlus, 22 kPa", PAPER, 22 * KPA),
    Scene("paper, TangoPlus, 22 kPa, 2 mL", paper(0.17, dead_ml=2.0), 22 * KPA),
    Scene("paper, TangoPlus, 35 kPa", paper(0.17, 0.5), 35 * KPA),
    Scene("paper, FLX9960, 0 kPa", paper(0.91), 0.0),
    Scene("paper, FLX9985, 22 kPa, 0.5 mL", paper(4.0, 0.5, 0.5), 22 * KPA),
    Scene("paper, TangoPlus at nu 0.499, 20 kPa", paper(0.17, 0.5, nu=0.499), 20 * KPA),
    Scene("wall 0.05, 8 kPa", sensor(9.25, 0.4625, 0.17, 0.5), 8 * KPA),
    Scene("wall 0.08, 10 kPa, 4 mL", sensor(15.0, 1.2, 0.27, 0.6, 4.0), 10 * KPA),
    Scene("wall 0.1, 60 kPa, 1 mL", sensor(20.0, 2.0, 1.64, 0.5, 1.0), 60 * KPA),
    Scene("wall 0.3, 40 kPa", sensor(6.0, 1.8, 0.55, 0.4), 40 * KPA),
    Scene("wall 0.4, 0 kPa, 0.1 mL", sensor(5.0, 2.0, 0.91, 0.5, 0.1), 0.0),
    Scene(
        "Mooney-Rivlin, wall 0.083, 15 kPa, 1 mL",
        sensor(12.0, 1.0, 0.17, 0.65, 1.0).replace(law=("mooney-rivlin", (0.07, 0.015))),
        15 * KPA,
    ),
    Scene("Ogden (Agilus30), 50 kPa", paper(1.423, 0.5).replace(law=OGDEN_AGILUS30), 50 * KPA),
)
"""At least twelve, for every figure that is said to hold over scenes."""
