"""Linear relaxation of a resin as a Prony series."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.sensor import Sensor
from pneutouch.spec.material import Material


@dataclass(frozen=True)
class Prony:
    """G(t)/G_0 = 1 - sum of ``shares`` (1 - exp(-t/``times``)), times in s; ``source`` names its origin."""

    shares: tuple[float, ...]
    times: tuple[float, ...]
    source: str = ""

    @property
    def relaxed_share(self) -> float:
        """Relaxed over instantaneous modulus."""
        return 1.0 - sum(self.shares)

    @property
    def excess(self) -> Array:
        """Each term over the relaxed modulus, (terms,)."""
        return np.array(self.shares) / self.relaxed_share

    def modulus(self, time: Array) -> Array:
        """Modulus after a step of strain, over the relaxed one; any shape, s."""
        decay = np.exp(-np.asarray(time)[..., None] / np.array(self.times))
        return np.asarray(1.0 + decay @ self.excess)


def prony_series(material: Material) -> tuple[Prony, ...]:
    """The relaxation data of a resin, one series a source; empty if there are none."""
    return tuple(
        Prony(tuple(t.share for t in data.terms), tuple(t.time_s for t in data.terms), data.source)
        for data in material.relaxation
    )


def relaxed(sensor: Sensor, material: Material, series: Prony) -> Sensor:
    """A sensor with its relaxed modulus; that of its resin's file is relaxed or instantaneous as the file says."""
    share = series.relaxed_share if material.shear_modulus_is == "instantaneous" else 1.0
    return sensor.replace(shear_modulus=share * sensor.wall.shear_modulus)
