"""A dome with its prediction, for the rules on the sensor's working."""

from __future__ import annotations

from typing import Any

from pneutouch.mechanics import predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.rating import ratings
from pneutouch.printability import Finding, PrintSubject, SensorContext, check
from pneutouch.units import KPA
from tests.printability.gallery import cup, item, material

WORKING = (
    "layers",
    "driving",
    "freedom",
    "filling",
    "bubbles",
    "inhibition",
    "glue",
    "inserts",
    "gland",
    "mixing curve",
)
"""Rules that need a sensor's prediction."""


def working(pressures: list[float], **options: Any) -> list[Finding]:
    """Findings of the rules on working for the `dome`."""
    found = check(*dome(pressures, **options))
    return [finding for finding in found if finding.rule in WORKING]


def dome(
    pressures: list[float],
    wall: float = 1.488,
    radius: float = 9.3,
    resin: str = "TangoPlus",
    *,
    calibrated: bool = False,
) -> tuple[PrintSubject, SensorContext]:
    """The paper's dome (kPa, mm) and what the rules on working need of it; 1.488 mm are 93 layers of 16 um."""
    sensor = material_sensor(material(resin)).replace(wall_thickness=wall, inner_radius=radius)
    prediction = predict("dome", sensor, [p * KPA for p in pressures], model="membrane")
    part = item(cup(radius + wall, wall), "membrane", resin)
    judged = ratings([prediction.limits], [sensor], material(resin), part.printer)[0]
    return PrintSubject((part,)), SensorContext(prediction, sensor, judged, calibrated=calibrated)
