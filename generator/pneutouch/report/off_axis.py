"""The datasheet's rows on contact off the axis: sideways force, moment, and the harmonics that the answer took."""

import numpy as np

from pneutouch.mechanics.prediction import SensorState
from pneutouch.units import KPA

OFF_AXIS = (
    "Driving\nkPa",
    "Indentation\nmm",
    "Force\nN",
    "Sideways force\nN",
    "Moment\nN mm",
    "Harmonics\nto order",
    "Last change\n%",
)
"""Columns of the table of contact off the axis."""

CAPTION = (
    "At the end of the range, of the dome on the object: the sideways force in the plane of symmetry, positive towards "
    "the offset or the side on which a plate rises; the moment about the centre of the base plane. The last raise of "
    "the harmonics changed sensitivity, force or pressure rise by the last change at most; the sideways force settles "
    "later than these."
)


def off_axis_rows(states: tuple[SensorState, ...]) -> list[list[str]]:
    """One row a driving pressure that was pressed off the axis."""
    rows = []
    for state in states:
        beyond = state.beyond_axis
        if beyond is None:
            continue
        end = min(state.range_end, float(state.indentation[-1]))
        curves = (state.force, beyond.sideways, beyond.moment)
        force, sideways, moment = (float(np.interp(end, state.indentation, curve)) for curve in curves)
        rows.append(
            [
                f"{state.driving_pressure / KPA:g}",
                f"{end:.2f}",
                f"{force:.3f}",
                f"{sideways:.3f}",
                f"{moment:.2f}",
                f"{beyond.order}",
                f"{100.0 * beyond.last_change:.2g}",
            ]
        )
    return rows
