"""Figures from loading curves; predicted and measured curves are treated by the same functions.

A curve is three arrays of one length: indentation (mm), contact force (N), pressure rise (kPa). Definitions follow the
paper where it gives one (sensitivity, section 3-B; stiffness dF/d(delta), section 4-A), else those of sensor makers.
"""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from pneutouch.arrays import Array

_LEAST_POINTS = 3
SHALLOW = (1.0, 3.0)
"""Depths, mm, of the tangent stiffnesses: the paper's stiffness is dF/d(delta) at a depth, its Figure 5(a)."""
_RESOLVED = 8
"""Least number of points of a curve whose slope is read: within 4 % of a fine mesh's with 8, within 3 % with 14."""
STRAIGHT = 0.9
"""Least r_squared of a predicted curve whose slope is given as sensitivity."""
_SATURATED = 0.5
"""Share of the fitted slope below which the local slope counts as saturation."""


Of = TypeVar("Of", bound=Any)
"""One number for one curve, or an array with a number for each curve."""


class Figures(NamedTuple, Generic[Of]):
    """Key figures of one loading curve, or of many as arrays of one shape; definitions in `figures`. Sensitivities in
    kPa/N, stiffnesses N/mm, forces N, r_squared and nonlinearity fractions; saturation_force inf without saturation,
    ``stiffness_1mm`` and ``stiffness_3mm`` NaN where they are unknown."""

    sensitivity: Of
    intercept_kPa: Of
    sensitivity_through_origin: Of
    r_squared: Of
    nonlinearity: Of
    stiffness: Of
    force_low: Of
    force_high: Of
    saturation_force: Of
    stiffness_1mm: Of
    stiffness_3mm: Of

    def stiffness_at(self, depth: float | None) -> Of:
        """Tangent stiffness at a depth of `SHALLOW`, mm, or the mean over the range for None; N/mm."""
        found: Of = self.stiffness if depth is None else getattr(self, f"stiffness_{depth:g}mm")
        return found

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
            stiffness_1mm=self.stiffness_1mm * force,
            stiffness_3mm=self.stiffness_3mm * force,
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
            **dict(zip(("stiffness_1mm", "stiffness_3mm"), _tangents(indentation, force), strict=True)),
        )


def _tangents(indentation: Array, force: Array) -> list[Array]:
    """Slopes dF/d(delta) (...) of curves (..., n) at the depths of `SHALLOW`, N/mm; NaN beyond a curve's end.

    The difference of two forces a fourteenth of the range apart: the slope at one point varies by 6 % with the mesh's
    points of contact.
    """
    end = indentation[..., -1]
    if indentation.shape[-1] < _RESOLVED:
        return [np.full(end.shape, np.nan)] * len(SHALLOW)
    half = end / 28.0
    ends = [[_cubic(indentation, force, depth + side * half) for side in (-1, 1)] for depth in SHALLOW]
    inside = [end >= depth * (1.0 - 1e-9) for depth in SHALLOW]
    return [np.where(known, (b - a) / (2.0 * half), np.nan) for known, (a, b) in zip(inside, ends, strict=True)]


def _cubic(indentation: Array, force: Array, at: Array) -> Array:
    """Forces (...) at travels ``at`` (...), by the cubic through the four points of the curves (..., n) around them."""
    first = np.clip((indentation < at[..., None]).sum(axis=-1) - 2, 0, indentation.shape[-1] - 4)
    places = first[..., None] + np.arange(4)
    x, y = (np.moveaxis(np.take_along_axis(values, places, axis=-1), -1, 0) for values in (indentation, force))
    once = np.diff(y, axis=0) / np.diff(x, axis=0)
    twice = np.diff(once, axis=0) / (x[2:] - x[:-2])
    thrice = (twice[1] - twice[0]) / (x[3] - x[0])
    a, b, c = at - x[:3]
    return np.asarray(y[0] + a * (once[0] + b * (twice[0] + c * thrice)))


def _slopes(x: Array, y: Array) -> Array:
    """Slopes dy/dx at the points of curves (..., n): second-order differences, one-sided at the ends."""
    step = np.diff(x)
    side = np.diff(y) / step
    before, after = step[..., :-1], step[..., 1:]
    middle = (after * side[..., :-1] + before * side[..., 1:]) / (before + after)
    return np.concatenate([side[..., :1], middle, side[..., -1:]], axis=-1)


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
    with np.errstate(invalid="ignore", divide="ignore"):
        local = _slopes(force, rise_kPa)
    low = local < _SATURATED * np.asarray(slope)[..., None]
    below = low & np.logical_or.accumulate(~low, axis=-1)
    first = np.take_along_axis(force, below.argmax(axis=-1)[..., None], axis=-1)[..., 0]
    none = np.where(np.isnan(slope), np.nan, np.inf)
    return np.where(below.any(axis=-1), first, none)


def tangent_stiffness(indentation: Array, force: Array) -> Array:
    """Slope dF/d(delta) of force (N) over indentation (mm) at every point (n,), N/mm, by second-order differences;
    empty for a single point."""
    if len(force) < 2:
        return np.empty(0)
    slope: Array = np.gradient(force, indentation, edge_order=2 if len(force) > 2 else 1)
    return slope
