"""Linear relaxation of a resin as a Prony series.

Also the check that a resin's relaxation is known.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.sensor import Sensor
from pneutouch.spec.material import Material


@dataclass(frozen=True)
class Prony:
    """Relaxation G(t)/G(0) = 1 - sum of ``shares`` (1 - exp(-t/``times``)), times in s; ``source`` of the data."""

    shares: tuple[float, ...]
    times: tuple[float, ...]
    source: str = ""

    @property
    def relaxed_share(self) -> float:
        """Relaxed modulus over instantaneous modulus."""
        return 1.0 - sum(self.shares)

    @property
    def excess(self) -> Array:
        """Share of each term over that of the relaxed modulus, (terms,)."""
        return np.array(self.shares) / self.relaxed_share

    def modulus(self, time: Array) -> Array:
        """Modulus at times (s, array of any shape) after a step of strain, over the relaxed modulus."""
        decay = np.exp(-np.asarray(time)[..., None] / np.array(self.times))
        return np.asarray(1.0 + decay @ self.excess)


def prony_series(material: Material) -> tuple[Prony, ...]:
    """Relaxation series of a resin, one for each source of its data; empty without data."""
    return tuple(
        Prony(tuple(t.share for t in data.terms), tuple(t.time_s for t in data.terms), data.source)
        for data in material.relaxation
    )


def relaxed(sensor: Sensor, material: Material, series: Prony) -> Sensor:
    """The sensor with its relaxed modulus by a series; unchanged if the material's file states the relaxed one."""
    share = series.relaxed_share if material.shear_modulus_is == "instantaneous" else 1.0
    return sensor.replace(shear_modulus=share * sensor.wall.shear_modulus)


_MEMBRANE = "the membrane has no stiffness of its own to relax; take model atlas, solid or auto"


def unknown(sensor: Sensor, material: Material, model: str) -> str | None:
    """Reason why relaxation and hysteresis of a sensor cannot be predicted, or None if they can.

    The solid follows a contact that the atlas does not cover, unless it is off the axis or the wall has another law
    than the neo-Hookean one, whose constants are not scaled.
    """
    if not material.relaxation:
        return f"no relaxation data for {material.title}; no other resin's are put in their place"
    if model == "membrane":
        return _MEMBRANE
    test = sensor.protocol
    if test.soft is not None:
        return f"{test.other_contact}: neither its own relaxation nor the wall's under it is modelled"
    if test.other_contact is not None and test.off_axis is None and sensor.wall.law is None:
        return None
    from pneutouch.mechanics.models.choice import outside

    reasons = [outside("atlas", relaxed(sensor, material, series)) for series in prony_series(material)]
    return None if None in reasons else f"the sensor is outside the atlas: {reasons[0]}"
