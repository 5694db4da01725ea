"""The solid's state of a candidate under a contact that the atlas does not cover, as an answer of the atlas."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.mechanics.atlas.respond import BUCKLING, DEPTH, ENDS, AtlasResponse
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.response import FigureArrays


class ContactFigures(NamedTuple):
    """Record of a candidate under a contact that the atlas does not cover; its figures are the solid's.

    ends_with: what ends its range. plate_kPa_per_N: sensitivity by the atlas, under the plate without friction.
    rounds: searches that were made until it was found.
    """

    ends_with: str
    plate_kPa_per_N: float
    rounds: int


def ending(state: SensorState) -> str:
    """End of the range of a state: an event, or the depth."""
    return next((event.kind for event in state.events if event.ends_range), ENDS[DEPTH])


def solid_response(state: SensorState, atlas: AtlasResponse) -> AtlasResponse | None:
    """A state of the solid as an answer of one row; the atlas's row gives the limit point, which no contact changes.

    None if the state has no figures. An end that the atlas does not have counts as buckling, which no margin reads.
    """
    figures, kind = state.figures, ending(state)
    if figures is None:
        return None
    grid = np.linspace(0.0, state.range_end, atlas.force.shape[1])
    force, rise, stretch = (
        np.interp(grid, state.indentation, values) for values in (state.force, state.pressure_rise, state.max_stretch)
    )
    saturation = np.nan if figures.saturation_force is None else figures.saturation_force
    values = {name: getattr(figures, name) for name in FigureArrays._fields if hasattr(figures, name)}
    low, high = figures.force_range
    values |= {"force_low": low, "force_high": high, "saturation_force": saturation}
    return AtlasResponse(
        lines=FigureArrays(**{name: np.array([value]) for name, value in values.items()}),
        ends=np.array([ENDS.index(kind) if kind in ENDS else BUCKLING]),
        near_buckling=np.array([False]),
        range_end=np.array([state.range_end]),
        contact_radius=np.interp([state.range_end], state.indentation, state.contact_radius),
        limit_pressure=atlas.limit_pressure,
        apex_outer=np.array([state.apex_outer]),
        cavity_volume=np.array([state.cavity_volume]),
        max_stretch=np.array([stretch.max()]),
        indentation=grid[None],
        force=force[None],
        rise=rise[None],
    )
