"""Figures from loading curves; predicted and measured curves are treated by the same functions.

A curve is three arrays of one length: indentation (mm), contact force (N), pressure rise (kPa). Definitions follow the
paper where it gives one (sensitivity, section 3-B; stiffness dF/d(delta), section 4-A), else the usual ones of sensor
makers.
"""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from pneutouch.arrays import Array

_LEAST_POINTS = 3
_SATURATED = 0.5
"""Share of the fitted slope below which the local slope counts as saturation."""


Of = TypeVar("Of", bound=Any)
"""One number for one curve, or an array with a number for each curve."""


class Figures(NamedTuple, Generic[Of]):
    """Key figures of one loading curve, or of many as arrays of one shape; definitions in `figures`. Sensitivities in
    kPa/N, stiffness N/mm, forces N, r_squared and nonlinearity fractions; saturation_force inf without saturation."""

    sensitivity: Of
    intercept_kPa: Of
    sensitivity_through_origin: Of
    r_squared: Of
    nonlinearity: Of
    stiffness: Of
    force_low: Of
    force_high: Of
    saturation_force: Of

    @property
    def force_range(self) -> tuple[Of, Of]:
        """Least and greatest contact force of the range, N."""
        return self.force_low, self.force_high

    @property
    def reach(self) -> Of:
        """Upper force of the usable range, N: the force at its end, or at saturation if that is lower."""
        force: Of = np.minimum(self.force_high, self.saturation_force)
        return force

    def scaled(self, force: float, rise: float) -> "Figures[Of]":
        """Figures of the same curve with its forces times ``force`` and its pressure rises times ``rise``."""
        return self._replace(
            sensitivity=self.sensitivity * rise / force,
            intercept_kPa=self.intercept_kPa * rise,
            sensitivity_through_origin=self.sensitivity_through_origin * rise / force,
            stiffness=self.stiffness * force,
            force_low=self.force_low * force,
            force_high=self.force_high * force,
            saturation_force=self.saturation_force * force,
        )


def lines(indentation: Array, force: Array, rise_kPa: Array) -> Figures[Array]:
    """Key figures (...) of curves (..., n) along the last axis: mm, N, kPa; definitions in `figures`.

    For a curve with constant force the undetermined figures are NaN.
    """
    mean_force, mean_rise_kPa = force.mean(axis=-1, keepdims=True), rise_kPa.mean(axis=-1, keepdims=True)
    df, dr = force - mean_force, rise_kPa - mean_rise_kPa
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (df * dr).sum(axis=-1) / (df * df).sum(axis=-1)
        residual = dr - slope[..., None] * df
        spread, span = (dr * dr).sum(axis=-1), np.ptp(rise_kPa, axis=-1)
        return Figures(
            sensitivity=slope,
            intercept_kPa=mean_rise_kPa[..., 0] - slope * mean_force[..., 0],
            sensitivity_through_origin=(force * rise_kPa).sum(axis=-1) / (force * force).sum(axis=-1),
            r_squared=1.0 - np.where(spread == 0, 0.0, (residual * residual).sum(axis=-1) / spread),
            nonlinearity=np.where(span == 0, 0.0, np.abs(residual).max(axis=-1) / span),
            stiffness=(force[..., -1] - force[..., 0]) / (indentation[..., -1] - indentation[..., 0]),
            force_low=force.min(axis=-1),
            force_high=force.max(axis=-1),
            saturation_force=saturation_force(force, rise_kPa, slope),
        )


def figures(indentation: Array, force: Array, rise_kPa: Array) -> Figures[float] | None:
    """Key figures over all points of a curve, arrays (n,) in mm, N and kPa; None if they determine no straight line.

    ``sensitivity`` is the slope of the least-squares line of pressure rise over force with intercept;
    ``nonlinearity`` the greatest distance from that line over the full-scale rise; ``stiffness`` the mean
    dF/d(delta) over the range.
    """
    if len(force) < _LEAST_POINTS or np.ptp(force) <= 0 or np.ptp(indentation) <= 0:
        return None
    return Figures(*(float(value) for value in lines(indentation, force, rise_kPa)))


def saturation_force(force: Array, rise_kPa: Array, slope: Array | float) -> Array:
    """Force (N) at which the local slope of pressure over force falls below half of the fitted ``slope`` (kPa/N):
    infinite if it does not, NaN if ``slope`` is NaN.

    The local slope must have been above half before: a curve that begins flat is not saturated. Curves along the last
    axis; the local slope is the second-order difference, one-sided at the ends.
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
    none = np.where(np.isnan(slope), np.nan, np.inf)
    return np.where(below.any(axis=-1), first, none)


def tangent_stiffness(indentation: Array, force: Array) -> Array:
    """Slope dF/d(delta) of force (N) over indentation (mm) at every point (n,), N/mm, by second-order differences."""
    slope: Array = np.gradient(force, indentation, edge_order=2 if len(force) > 2 else 1)
    return slope


def hysteresis(force_up: Array, rise_up: Array, force_down: Array, rise_down: Array) -> tuple[float, float]:
    """Hysteresis between a loading and an unloading branch by its two usual definitions, as fractions.

    First the greatest difference of the pressure rises at equal force over the range of the loading branch's rise; then
    the area of the loop over the area under the loading branch. The paper gives hysteresis without a formula.
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
