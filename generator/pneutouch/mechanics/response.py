"""Figures from a curve: predicted and measured curves go through the same few functions.

A curve is three arrays of one length: indentation (mm), contact force (N), pressure rise (kPa). Definitions
follow the paper where it gives one (sensitivity, section 3-B; stiffness dF/d(delta), section 4-A), else
the sensor makers' usual ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array

_LEAST_POINTS = 3
_SATURATED = 0.5
"""Saturation: the local slope has fallen below this share of the fitted one."""


@dataclass(frozen=True, slots=True)
class Figures:
    """Key figures of one loading curve. Sensitivities in kPa/N, stiffness in N/mm, forces in N."""

    sensitivity_kPa_per_N: float
    intercept_kPa: float
    sensitivity_through_origin_kPa_per_N: float
    r_squared: float
    nonlinearity: float
    stiffness: float
    force_range: tuple[float, float]
    saturation_force: float | None

    def scaled(self, force: float, rise: float) -> Figures:
        """Figures of the curve whose forces and pressure rises are these times two factors."""
        saturated = self.saturation_force
        return replace(
            self,
            sensitivity_kPa_per_N=self.sensitivity_kPa_per_N * rise / force,
            intercept_kPa=self.intercept_kPa * rise,
            sensitivity_through_origin_kPa_per_N=self.sensitivity_through_origin_kPa_per_N * rise / force,
            stiffness=self.stiffness * force,
            force_range=(self.force_range[0] * force, self.force_range[1] * force),
            saturation_force=None if saturated is None else saturated * force,
        )


class FigureArrays(NamedTuple):
    """Key figures of many curves, arrays of one shape; NaN for no saturation. Units as in `Figures`, nonlinearity and
    r_squared as fractions."""

    sensitivity_kPa_per_N: Array
    intercept_kPa: Array
    sensitivity_through_origin_kPa_per_N: Array
    r_squared: Array
    nonlinearity: Array
    stiffness: Array
    force_low: Array
    force_high: Array
    saturation_force: Array


def lines(indentation: Array, force: Array, rise_kPa: Array) -> FigureArrays:
    """Key figures of curves along the last axis, (..., n) each; definitions in `figures`.

    A curve whose force does not vary has NaN for what it does not determine.
    """
    mean_force, mean_rise_kPa = force.mean(axis=-1, keepdims=True), rise_kPa.mean(axis=-1, keepdims=True)
    df, dr = force - mean_force, rise_kPa - mean_rise_kPa
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (df * dr).sum(axis=-1) / (df * df).sum(axis=-1)
        residual = dr - slope[..., None] * df
        spread, span = (dr * dr).sum(axis=-1), np.ptp(rise_kPa, axis=-1)
        return FigureArrays(
            sensitivity_kPa_per_N=slope,
            intercept_kPa=mean_rise_kPa[..., 0] - slope * mean_force[..., 0],
            sensitivity_through_origin_kPa_per_N=(force * rise_kPa).sum(axis=-1) / (force * force).sum(axis=-1),
            r_squared=1.0 - np.where(spread == 0, 0.0, (residual * residual).sum(axis=-1) / spread),
            nonlinearity=np.where(span == 0, 0.0, np.abs(residual).max(axis=-1) / span),
            stiffness=(force[..., -1] - force[..., 0]) / (indentation[..., -1] - indentation[..., 0]),
            force_low=force.min(axis=-1),
            force_high=force.max(axis=-1),
            saturation_force=saturation_force(force, rise_kPa, slope),
        )


def figures(indentation: Array, force: Array, rise_kPa: Array) -> Figures | None:
    """Key figures over all the points given, or None if they do not determine a straight line.

    ``sensitivity`` is the slope of the least-squares line of pressure rise over force with intercept;
    ``nonlinearity`` the greatest distance from that line over the full-scale rise; ``stiffness`` the mean
    dF/d(delta) over the range.
    """
    if len(force) < _LEAST_POINTS or np.ptp(force) <= 0 or np.ptp(indentation) <= 0:
        return None
    values = {name: float(value) for name, value in lines(indentation, force, rise_kPa)._asdict().items()}
    low, high, saturated = (values.pop(name) for name in ("force_low", "force_high", "saturation_force"))
    return Figures(**values, force_range=(low, high), saturation_force=None if np.isnan(saturated) else saturated)


def saturation_force(force: Array, rise_kPa: Array, slope: Array | float) -> Array:
    """Force at which the local slope of pressure over force falls below half the fitted one, NaN if it does not.

    A curve that begins flat has not saturated: the slope must have been above before. Curves along the last axis; the
    local slope is the second-order difference, one-sided at the ends.
    """
    step, climb = np.diff(force), np.diff(rise_kPa)
    with np.errstate(invalid="ignore", divide="ignore"):
        side = climb / step
        before, after = step[..., :-1], step[..., 1:]
        middle = (after * side[..., :-1] + before * side[..., 1:]) / (before + after)
    local = np.concatenate([side[..., :1], middle, side[..., -1:]], axis=-1)
    low = local < _SATURATED * np.asarray(slope)[..., None]
    below = low & np.logical_or.accumulate(~low, axis=-1)
    first = np.take_along_axis(force, below.argmax(axis=-1)[..., None], axis=-1)[..., 0]
    return np.where(below.any(axis=-1), first, np.nan)


def tangent_stiffness(indentation: Array, force: Array) -> Array:
    """dF/d(delta) at every point, N/mm, by second-order differences."""
    slope: Array = np.gradient(force, indentation, edge_order=2 if len(force) > 2 else 1)
    return slope


def hysteresis(force_up: Array, rise_up: Array, force_down: Array, rise_down: Array) -> tuple[float, float]:
    """Hysteresis of a loading and an unloading branch in its two usual definitions, as fractions.

    First the greatest difference in pressure at equal force over the full-scale rise; then the area of the
    loop over the area under the loading branch. The paper gives its figures without a formula.
    """
    up, down = np.argsort(force_up), np.argsort(force_down)
    low = max(force_up.min(), force_down.min())
    high = min(force_up.max(), force_down.max())
    grid = np.unique(np.concatenate([force_up, force_down]))
    grid = grid[(grid >= low) & (grid <= high)]
    loading = np.interp(grid, force_up[up], rise_up[up])
    unloading = np.interp(grid, force_down[down], rise_down[down])
    gap = np.abs(unloading - loading)
    width, area = float(gap.max() / np.ptp(rise_up)), float(np.trapezoid(gap, grid))
    return width, area / float(np.trapezoid(loading, grid))
