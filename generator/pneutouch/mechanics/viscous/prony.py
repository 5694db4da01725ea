"""Linear relaxation of a resin as a Prony series.

Also the checks that a resin's relaxation and ageing are known.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
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

AGED = (
    "The ratio alone of Gent's relation of Shore A to modulus (Rubber Chem. Technol. 31, 896, 1958) is used, not its "
    "level; above Shore A 80, where the scale is compressed, it grows steep. Hardness is read in seconds and is "
    "applied to the relaxed modulus; what light and air harden may be a skin, and is taken as the whole wall"
)
"""Assumptions of the conversion from hardness to modulus, in words."""


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
    if test.other_contact is not None and test.off_axis is None and sensor.wall.law is None:
        return None
    from pneutouch.mechanics.models.choice import outside

    reasons = [outside("atlas", relaxed(sensor, material, series)) for series in prony_series(material)]
    return None if None in reasons else f"the sensor is outside the atlas: {reasons[0]}"


def ageing_unknown(material: Material) -> str | None:
    """Reason why the change of the modulus in a year is not known, or None if it is."""
    if material.shore_a is None or material.shore_a_one_year is None:
        return f"the hardness of {material.title} after a year is not known"
    if material.law is not None:
        return f"{material.title} has a law of its own, whose constants hardness does not give"
    return None


def ageing_ratio(material: Material) -> float:
    """Shear modulus after a year in light and air over the fresh modulus, by hardness; `AGED` states the assumptions.

    Raises InputError for a resin without known ageing.
    """
    why = ageing_unknown(material)
    if why is not None:
        remedy = "give shore_a and shore_a_one_year in its material file, or leave `aged` out"
        raise InputError(f"aged: {why}", remedy=remedy)
    from pneutouch.mechanics.paper_sensor import young_modulus

    assert material.shore_a is not None and material.shore_a_one_year is not None
    fresh, aged = material.shore_a.nominal, material.shore_a_one_year.nominal
    return young_modulus(aged) / young_modulus(fresh)
