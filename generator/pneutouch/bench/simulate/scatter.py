"""Scatter between specimens of one resin and between runs of one specimen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.simulate.parameter import parameter
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA

YEAR = 365.0
"""Days."""

_LEAST_WALL = 0.05
"""Share of the nominal wall that a specimen has at least."""


@dataclass(frozen=True, slots=True)
class ScatterModel:
    """Differences between specimens and between runs; internal units."""

    modulus: float = parameter(
        0.04,
        "ln",
        "standard deviation of the modulus' logarithm: hardness spread of the paper's Table 1 (TangoPlus 1.0 Shore A) "
        "times Gent's slope, 0.042 at Shore A 27.6",
    )
    wall: float = parameter(
        0.10, "mm", "greatest deviation of the wall, even within: accuracy of the PolyJet machine (printprofiles)"
    )
    dead_volume: float = parameter(
        20.0,
        "mm3",
        "most extra air behind a specimen, even from none: 4 mm of a 2.5 mm bore, how far a tube is pushed on; our "
        "choice",
    )
    ageing: float = parameter(
        0.0,
        "ln/year",
        "change of the modulus' logarithm in the first year; set from the resin's hardness by Gent's relation",
    )
    gain: float = parameter(
        0.002, "1", "standard deviation of a run's gain on the pressure rise: paper, Table S1, 0.0051 of 2.547 kPa/N"
    )
    reset: float = parameter(
        0.05 * KPA,
        "MPa",
        "standard deviation of the driving pressure each time it is set: our choice, a hand regulator; "
        "its effect upon the curve, under 0.1 % of the sensitivity, is left to the gain",
    )

    @classmethod
    def none(cls) -> ScatterModel:
        """No scatter at all."""
        return cls(modulus=0.0, wall=0.0, dead_volume=0.0, gain=0.0, reset=0.0)


@dataclass(frozen=True, slots=True)
class SimulatedSpecimens:
    """Specimens that were drawn, arrays (n,): factor on the modulus, deviation of the wall (mm), extra air (mm3)."""

    modulus: Array
    wall: Array
    dead_volume: Array

    @classmethod
    def draw(cls, scatter: ScatterModel, count: int, rng: np.random.Generator) -> SimulatedSpecimens:
        """``count`` specimens."""
        return cls(
            np.exp(scatter.modulus * rng.standard_normal(count)),
            scatter.wall * rng.uniform(-1.0, 1.0, count),
            scatter.dead_volume * rng.uniform(0.0, 1.0, count),
        )

    def sensor(self, nominal: Sensor, k: int, factor: float = 1.0) -> Sensor:
        """The k-th specimen of a nominal sensor, its modulus times ``factor`` for its age."""
        stiffer = stiffened(nominal, float(self.modulus[k]) * factor)
        wall = max(nominal.dome.wall_thickness + float(self.wall[k]), _LEAST_WALL * nominal.dome.wall_thickness)
        return stiffer.replace(wall_thickness=wall, dead_volume=nominal.gas.dead_volume + float(self.dead_volume[k]))


def ageing_factor(scatter: ScatterModel, days: float) -> float:
    """Factor on the modulus after ``days``: even in its logarithm over the first year, then none.

    The paper measured at the ends of a year alone (Table 1); what lies between and after is our choice.
    """
    return float(np.exp(scatter.ageing * min(days / YEAR, 1.0)))


def stiffened(sensor: Sensor, factor: float) -> Sensor:
    """The sensor with every modulus of its wall times ``factor``."""
    law = sensor.wall.law
    if law is not None:
        name, constants = law
        law = name, tuple(c if name == "ogden" and k % 2 else c * factor for k, c in enumerate(constants))
    return sensor.replace(shear_modulus=sensor.wall.shear_modulus * factor, law=law)
