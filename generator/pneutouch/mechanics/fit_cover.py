"""Sensors that a calibration covers: those that the atlas, with which every fit is made, has answers for."""

from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.contact_correction import plate_alone
from pneutouch.mechanics.sensor import Sensor

_DEPTH = 0.75
"""Depth in R0 that a fit takes at most: that of the sensitivity test (paper, section 3-B)."""


def outside_fit(sensor: Sensor) -> str | None:
    """Reason why no fit to measured runs covers a sensor, or None if one does.

    Friction and objects are the solid's correction of the atlas (`contact_correction`).
    """
    plate = plate_alone(sensor)
    return outside_atlas(plate.replace(depth=min(plate.protocol.depth, _DEPTH * plate.dome.inner_radius)))
