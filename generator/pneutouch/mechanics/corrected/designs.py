"""Figures under another contact than the atlas's: the atlas's times factors that the solid gave at some sensors.

Space mapping (Bandler et al., IEEE Trans. Microwave Theory Tech. 42 (1994) 2536, doi:10.1109/22.339794): the cheap
model is corrected to meet the accurate one where that was solved, and is searched again.

The solid's state of a candidate under a contact that the atlas does not cover, as an answer of the atlas.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import BUCKLING, DEPTH, ENDS, AtlasResponse
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.response import Figures

_LENGTHS = np.array([0.3, 0.25, 0.5, 1.0])
"""Distances that count as one in the columns of `places`."""
_SAME = 1e-9
"""Two samples nearer than this are one."""


def places(batch: SensorBatch, response: AtlasResponse) -> Array:
    """Coordinates of sensors, (n, 4), by which neighbours are found: logarithm of the wall ratio, driving pressure over
    that of the limit point, logarithms of the inner radius and of the ambient pressure over the shear modulus; each
    over its `_LENGTHS`.
    """
    columns = [
        np.log(batch.wall_ratio),
        batch.driving_pressure / response.limit_pressure,
        np.log(batch.inner_radius),
        np.log(np.maximum(batch.ambient_pressure, _SAME) / batch.shear_modulus),
    ]
    return np.asarray(np.stack(columns, axis=1) / _LENGTHS)


def figures_of(response: AtlasResponse) -> Array:
    """Figures that are corrected, (n, 5): sensitivity, stiffness, force and travel at the end of the range, stretch
    above 1."""
    lines = response.lines
    columns = [lines.sensitivity, lines.stiffness, lines.force_high, response.range_end, response.max_stretch - 1.0]
    return np.stack(columns, axis=1)


class ContactFactors(NamedTuple):
    """Logarithms of factors (m, 5) on `figures_of`, and the `places` (m, 4) where they were found."""

    places: Array
    logs: Array

    @classmethod
    def none(cls) -> ContactFactors:
        """No sample: nothing is corrected."""
        return cls(np.zeros((0, 4)), np.zeros((0, 5)))

    def with_sample(self, place: Array, atlas: AtlasResponse, solid: AtlasResponse) -> ContactFactors:
        """One more sensor (one row each) that both models answered; left out where it is known or has no figures."""
        with np.errstate(invalid="ignore", divide="ignore"):
            log = np.log(figures_of(solid) / figures_of(atlas))
        near = np.linalg.norm(self.places - place, axis=1) < _SAME
        if near.any() or not np.isfinite(log).all():
            return self
        return ContactFactors(np.concatenate([self.places, place]), np.concatenate([self.logs, log]))

    def at(self, where: Array) -> Array:
        """Factors (n, 5) at places (n, 4).

        Interpolated by the radial function r and a constant, which is straight between two samples; never beyond the
        least and the greatest of the samples.
        """
        count = len(self.places)
        if count == 0:
            return np.ones((len(where), self.logs.shape[1]))
        matrix = np.ones((count + 1, count + 1))
        matrix[:count, :count] = _distances(self.places, self.places)
        matrix[count, count] = 0.0
        weights = np.linalg.solve(matrix, np.concatenate([self.logs, np.zeros((1, self.logs.shape[1]))]))
        logs = _distances(where, self.places) @ weights[:count] + weights[count]
        return np.asarray(np.exp(np.clip(logs, self.logs.min(axis=0), self.logs.max(axis=0))))

    def corrected(self, batch: SensorBatch, response: AtlasResponse) -> AtlasResponse:
        """Answers of the atlas with the factors at their places."""
        known = np.isfinite(response.limit_pressure)
        factors = np.full((len(batch), self.logs.shape[1]), np.nan)
        factors[known] = self.at(places(batch, response)[known])
        slope, stiffness, force, travel, stretch = factors.T
        lines = response.lines
        return response._replace(
            lines=lines._replace(
                sensitivity=slope * lines.sensitivity,
                intercept_kPa=slope * force * lines.intercept_kPa,
                sensitivity_through_origin=slope * lines.sensitivity_through_origin,
                stiffness=stiffness * lines.stiffness,
                force_low=force * lines.force_low,
                force_high=force * lines.force_high,
                saturation_force=force * lines.saturation_force,
            ),
            range_end=travel * response.range_end,
            max_stretch=1.0 + stretch * (response.max_stretch - 1.0),
            force=force[:, None] * response.force,
            rise=(slope * force)[:, None] * response.rise,
        )


def _distances(a: Array, b: Array) -> Array:
    """Distances (n, m) between points (n, d) and (m, d)."""
    return np.asarray(np.linalg.norm(a[:, None] - b[None], axis=2))


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
    return AtlasResponse(
        lines=Figures(*(np.array([value]) for value in figures)),
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
