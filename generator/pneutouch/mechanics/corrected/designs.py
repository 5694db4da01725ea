"""Figures of many designs with a contact that the atlas does not cover: those of the atlas times interpolated factors.

The solid gives the factors for some of the sensors. Space mapping (Bandler et al., IEEE Trans. Microwave Theory Tech.
42 (1994) 2536, doi:10.1109/22.339794): the cheap model is corrected to agree with the accurate model where that was
solved, and is searched again. Also a state of the solid in the form of an atlas response.
"""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import BUCKLING, DEPTH, ENDS, AtlasResponse
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.response import Figures

_LENGTHS = np.array([0.3, 0.25, 0.5, 1.0])
"""Lengths by which the columns of `places` are divided."""
_SAME = 1e-9
"""Distance below which two places are the same."""


def places(batch: SensorBatch, response: AtlasResponse) -> Array:
    """Coordinates (n, 4) in which the distance between sensors is measured: logarithm of the wall ratio, driving
    pressure over that of the limit point, logarithms of the inner radius and of the ambient pressure over the shear
    modulus; each over its `_LENGTHS`."""
    columns = [
        np.log(batch.wall_ratio),
        batch.driving_pressure / response.limit_pressure,
        np.log(batch.inner_radius),
        np.log(np.maximum(batch.ambient_pressure, _SAME) / batch.shear_modulus),
    ]
    return np.asarray(np.stack(columns, axis=1) / _LENGTHS)


def figures_of(response: AtlasResponse) -> Array:
    """Figures to correct, (n, 5): sensitivity, stiffness, force and travel at the end of the range, stretch minus 1."""
    lines = response.lines
    columns = [lines.sensitivity, lines.stiffness, lines.force_high, response.range_end, response.max_stretch - 1.0]
    return np.stack(columns, axis=1)


class ContactFactors(NamedTuple):
    """Logarithms of factors (m, 5) on `figures_of`, and the `places` (m, 4) where they were found."""

    places: Array
    logs: Array

    @classmethod
    def none(cls) -> "ContactFactors":
        """Factors without samples: nothing is corrected."""
        return cls(np.zeros((0, 4)), np.zeros((0, 5)))

    def with_sample(self, place: Array, atlas: AtlasResponse, solid: AtlasResponse) -> "ContactFactors":
        """Factors with one more sensor (one row each) added; unchanged if it is known or has no figures."""
        with np.errstate(invalid="ignore", divide="ignore"):
            log = np.log(figures_of(solid) / figures_of(atlas))
        near = np.linalg.norm(self.places - place, axis=1) < _SAME
        if near.any() or not np.isfinite(log).all():
            return self
        return ContactFactors(np.concatenate([self.places, place]), np.concatenate([self.logs, log]))

    def at(self, where: Array) -> Array:
        """Factors (n, 5) on `figures_of` at places ``where`` (n, 4).

        Their logarithms are interpolated by the radial basis function r (the distance) plus a constant, which is linear
        between two samples, and limited to the range of the samples.
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
        """Responses of the atlas for ``batch``, multiplied by the factors at their places."""
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
                stiffness_1mm=force * lines.stiffness_1mm,
                stiffness_3mm=force * lines.stiffness_3mm,
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
    """Facts about a candidate with a contact that the atlas does not cover; its figures are those of the solid.

    ends_with: reason for the end of its range. plate_kPa_per_N: sensitivity by the atlas, under the frictionless plate.
    rounds: number of searches until the candidate was found.
    """

    ends_with: str
    plate_kPa_per_N: float
    rounds: int


def ending(state: SensorState) -> str:
    """Reason for the end of a state's range: the kind of its first event that ends it, or "depth"."""
    return next((event.kind for event in state.events if event.ends_range), ENDS[DEPTH])


def solid_response(state: SensorState, atlas: AtlasResponse) -> AtlasResponse | None:
    """A state of the solid as an atlas response of one row; the limit pressure is that in ``atlas``, on which contact
    has no effect. None if the state has no figures. A reason for the range's end that is not in `ENDS` counts as
    buckling.
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
