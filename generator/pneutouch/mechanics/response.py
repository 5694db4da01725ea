"""From a curve to figures: predicted and measured curves go through the same few functions.

A curve is three arrays of one length: indentation (mm), contact force (N), pressure rise (kPa). Definitions
follow the paper where it gives one (sensitivity, section 3-B; stiffness dF/d(delta), section 4-A), else
the sensor makers' usual ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.meridian.segments import Array

_LEAST_POINTS = 3
_SATURATED = 0.5
"""Saturation: the local slope has fallen below this share of the fitted one."""


@dataclass(frozen=True, slots=True)
class Figures:
    """Key figures of one loading curve. Sensitivities in kPa/N, stiffness in N/mm, forces in N."""

    sensitivity: float
    intercept: float
    sensitivity_through_origin: float
    r_squared: float
    nonlinearity: float
    stiffness: float
    force_range: tuple[float, float]
    saturation_force: float | None


def figures(indentation: Array, force: Array, rise: Array) -> Figures | None:
    """Key figures over all the points given, or None where they do not determine a straight line.

    ``sensitivity`` is the slope of the least-squares line of pressure rise over force with intercept;
    ``nonlinearity`` the greatest distance from that line over the full-scale rise; ``stiffness`` the mean
    dF/d(delta) over the range.
    """
    if len(force) < _LEAST_POINTS or np.ptp(force) <= 0 or np.ptp(indentation) <= 0:
        return None
    slope, intercept = np.polyfit(force, rise, 1)
    residual = rise - (slope * force + intercept)
    spread = float(np.sum((rise - rise.mean()) ** 2))
    return Figures(
        sensitivity=float(slope),
        intercept=float(intercept),
        sensitivity_through_origin=float(force @ rise / (force @ force)),
        r_squared=1.0 - float(residual @ residual) / spread if spread > 0 else 1.0,
        nonlinearity=float(np.max(np.abs(residual)) / np.ptp(rise)) if np.ptp(rise) > 0 else 0.0,
        stiffness=float((force[-1] - force[0]) / (indentation[-1] - indentation[0])),
        force_range=(float(force.min()), float(force.max())),
        saturation_force=saturation_force(force, rise, float(slope)),
    )


def saturation_force(force: Array, rise: Array, slope: float) -> float | None:
    """Force at which the local slope of pressure over force falls below half the fitted one, or None."""
    local = np.gradient(rise, force)
    below = np.flatnonzero(local < _SATURATED * slope)
    return float(force[below[0]]) if below.size else None


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
