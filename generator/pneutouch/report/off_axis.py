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

SHEAR = (
    "Driving\nkPa",
    "Moved to\nmm",
    "Force\nN",
    "Sideways force\nN",
    "Moment\nN mm",
    "Pressure rise\nkPa",
    "Greatest sideways force\nN",
    "Slips throughout from\nmm",
)
"""Columns of the table of an object that moves sideways after pressing."""

SHEAR_CAPTION = (
    "The object moves sideways at the depth that it was pressed to. At the end of that travel, of the dome on the "
    "object: force, sideways force and moment as above, and the pressure rise; the sideways force where it is greatest "
    "against the travel; the first computed travel at which every point of the contact slides."
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


def shear_rows(states: tuple[SensorState, ...]) -> list[list[str]]:
    """One row a driving pressure at which the object moved sideways; a dash for a figure that was not reached."""
    rows = []
    for state in states:
        sheared = None if state.beyond_axis is None else state.beyond_axis.shear
        if sheared is None:
            continue
        columns = (
            (sheared.travel, ".2f"),
            (sheared.force, ".3f"),
            (sheared.sideways, ".3f"),
            (sheared.moment, ".2f"),
            (sheared.rise / KPA, ".2f"),
        )
        ends = [f"{column[-1]:{digits}}" if column.size else "-" for column, digits in columns]
        peak = "-" if sheared.peak is None else f"{sheared.peak:.3f}"
        slips = "-" if sheared.slips_from is None else f"{sheared.slips_from:.2f}"
        rows.append([f"{state.driving_pressure / KPA:g}", *ends, peak, slips])
    return rows
