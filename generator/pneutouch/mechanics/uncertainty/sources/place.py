"""The uncertainty of a sensitivity that is used with unknown object and place of contact."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.reading import (
    FARTHEST,
    SMALLEST_BALL,
    STEEPEST_TILT,
    batch_conditions,
    place_uncertainty,
)
from pneutouch.mechanics.atlas.figures import SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import AtlasResponse, respond
from pneutouch.mechanics.uncertainty.source import FIGURE, UncertaintySource, counting
from pneutouch.mechanics.uncertainty.sources.model_error import PLACE

_ORIGIN = (
    f"assumed (Type B, JCGM 100, 4.3.7): a ball of {SMALLEST_BALL:g} R0 radius or more, its curvature even, its axis "
    f"even over the disc of {FARTHEST:g} R0; a plate tilted by up to {np.degrees(STEEPEST_TILT):.0f} degrees; root "
    "mean square of the logarithm of the force read over the true one"
)


def place_sources(batch: SensorBatch) -> list[UncertaintySource]:
    """Source for n sensors; it counts for those that the table of contact anywhere covers."""
    standard = place_uncertainties(batch, respond(batch))
    known = np.isfinite(standard)
    counts = counting(standard.size, only=(SENSITIVITY,)) & known
    return [UncertaintySource(PLACE, FIGURE, np.where(known, standard, 0.0), "lognormal", counts, _ORIGIN, False)]


def place_uncertainties(batch: SensorBatch, response: AtlasResponse) -> Array:
    """Relative standard uncertainties (n,) of sensors with their atlas responses; NaN outside the table."""
    domes = batch_conditions(batch, response.limit_pressure, response.cavity_volume)
    return place_uncertainty(domes, response.range_end / batch.inner_radius)
