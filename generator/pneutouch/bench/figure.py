"""What a run says in figures: measured curves through the same `mechanics.response` as predicted ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.bench.record import Curve
from pneutouch.mechanics.response import figures, hysteresis
from pneutouch.meridian.segments import Array
from pneutouch.units import KPA

Pooled = Literal["mean", "within", "between"]


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure of a sensor: its key, name, unit, and how many runs are made one value."""

    key: str
    name: str
    unit: str
    pooled: Pooled = "mean"
    of: str = ""
    digits: int = 3


FIGURES = (
    Figure("sensitivity_kPa_per_N", "Sensitivity, line with intercept", "kPa/N", digits=4),
    Figure("sensitivity_through_origin_kPa_per_N", "Sensitivity, line through the origin", "kPa/N", digits=4),
    Figure("r_squared", "R²", "", digits=5),
    Figure("nonlinearity_percent", "Nonlinearity", "% of full scale"),
    Figure("repeatability_kPa_per_N", "Repeatability of the sensitivity", "kPa/N", "within", "sensitivity_kPa_per_N"),
    Figure("part_to_part_kPa_per_N", "Part to part, of the sensitivity", "kPa/N", "between", "sensitivity_kPa_per_N"),
    Figure("stiffness_N_per_mm", "Mean stiffness", "N/mm"),
    Figure("force_range_N", "Force at the greatest depth", "N"),
    Figure("saturation_force_N", "Saturation force", "N"),
    Figure("sensing_range_N", "Sensing range", "N"),
    Figure("hysteresis_width_percent", "Hysteresis, greatest width", "% of full scale"),
    Figure("hysteresis_area_percent", "Hysteresis, area of the loop", "% of loading"),
    Figure("relaxation_force_percent", "Relaxation of the force", "%"),
    Figure("relaxation_force_percent_per_decade", "Relaxation of the force", "% a decade"),
    Figure("relaxation_pressure_percent", "Relaxation of the pressure rise", "%"),
    Figure("relaxation_pressure_percent_per_decade", "Relaxation of the pressure rise", "% a decade"),
    Figure("drift_pressure_kPa_per_min", "Drift of the pressure without contact", "kPa/min"),
    Figure("noise_force_N", "Noise of a force sample", "N rms"),
    Figure("noise_pressure_kPa", "Noise of a pressure sample", "kPa rms"),
    Figure("resolution_N", "Resolution of the force read from the pressure", "N"),
)  # fmt: skip
"""In the order of every table. Definitions with formula and source: docs/measuring.md."""

BY_KEY = {figure.key: figure for figure in FIGURES}

FIRST = 1.0
"""Seconds after the hold began from which relaxation is counted: the plate's stop has rung down."""

RESOLVED = 3.0
"""Noise standard deviations that count as resolved: the limit of detection of IUPAC (Gold Book, L03540)."""

_BINS, _CURVE = 40, 7
"""Bins of force that a loop's gap is averaged in, and coefficients of the middle line that is taken out before: the gap of the
solid's loops changes little within a bin, and a bin of a fast record holds hundreds of samples, so that the greatest gap is not
that of their noise."""
_LEAST_BINS = 5
_GRID = 200


def run_figures(curve: Curve) -> dict[str, float]:
    """The figures that one run gives, by key; those it does not determine are left out."""
    found: dict[str, float] = {}
    kind = curve.run.kind
    if kind in ("steps", "saturation") and len(curve.force) > 2:
        found |= _line(curve, saturating=kind == "saturation")
    if kind == "loop" and curve.loop:
        found |= _loop(curve)
    if kind == "relaxation" and curve.relaxation is not None:
        found |= _relaxation(*curve.relaxation)
    found |= _still(curve, found.get("sensitivity_kPa_per_N"))
    return {key: value for key, value in found.items() if np.isfinite(value)}


def _line(curve: Curve, *, saturating: bool) -> dict[str, float]:
    got = figures(curve.indentation, curve.force, curve.rise / KPA)
    if got is None:
        return {}
    if saturating:
        end = got.force_range[1] if got.saturation_force is None else got.saturation_force
        saturated = {} if got.saturation_force is None else {"saturation_force_N": got.saturation_force}
        return {**saturated, "sensing_range_N": end}
    return {
        "sensitivity_kPa_per_N": got.sensitivity, "sensitivity_through_origin_kPa_per_N": got.sensitivity_through_origin,
        "r_squared": got.r_squared, "nonlinearity_percent": 100 * got.nonlinearity, "stiffness_N_per_mm": got.stiffness,
        "force_range_N": got.force_range[1],
    }  # fmt: skip


def _loop(curve: Curve) -> dict[str, float]:
    """Hysteresis of all cycles together: the greatest difference of two noisy branches would be that of their noise."""
    up, down = ([np.concatenate(part) for part in zip(*side, strict=True)] for side in (
        [cycle[:2] for cycle in curve.loop], [cycle[2:] for cycle in curve.loop],
    ))  # fmt: skip
    force, rise = np.concatenate([up[0], down[0]]), np.concatenate([up[1], down[1]])
    middle = np.polynomial.Polynomial.fit(force, rise, _CURVE - 1)
    edges = np.linspace(max(up[0].min(), down[0].min(), 0.0), min(up[0].max(), down[0].max()), _BINS + 1)
    centre = 0.5 * (edges[1:] + edges[:-1])
    off = [_in_bins(f, r - middle(f), edges) for f, r in (up, down)]
    known = np.isfinite(off[0]) & np.isfinite(off[1])
    if known.sum() < _LEAST_BINS:
        return {}
    line = middle(centre[known])
    width, area = hysteresis(centre[known], line + off[0][known], centre[known], line + off[1][known])
    full = float(rise.max() / np.ptp(line + off[0][known]))
    return {"hysteresis_width_percent": 100 * width / full, "hysteresis_area_percent": 100 * area}


def _in_bins(force: Array, values: Array, edges: Array) -> Array:
    """Means of values by bin of force; NaN where a bin is empty."""
    which = np.digitize(force, edges) - 1
    inside = (which >= 0) & (which < edges.size - 1)
    count = np.bincount(which[inside], minlength=edges.size - 1)
    total = np.bincount(which[inside], weights=values[inside], minlength=edges.size - 1)
    with np.errstate(invalid="ignore"):
        return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _relaxation(time: Array, force: Array, rise: Array) -> dict[str, float]:
    """Loss from `FIRST` to the end of the hold, and its slope over log10 of time, both over the value at `FIRST`."""
    later = time >= FIRST
    if later.sum() < 3:
        return {}
    decades = np.log10(time[later])
    found = {}
    for name, values in (("force", force[later]), ("pressure", rise[later])):
        # Even in log time: a hold of 600 s has nine tenths of its samples in its last decade.
        grid = np.linspace(decades[0], decades[-1], _GRID)
        even = _binned(decades, values, grid)
        start = even[0]
        slope = np.polyfit(grid, even, 1)[0]
        found[f"relaxation_{name}_percent"] = float(100 * (start - even[-1]) / start)
        found[f"relaxation_{name}_percent_per_decade"] = float(-100 * slope / start)
    return found


def _binned(place: Array, values: Array, grid: Array) -> Array:
    """Means of values around each grid point; straight between where a bin is empty."""
    edges = np.concatenate([[-np.inf], 0.5 * (grid[1:] + grid[:-1]), [np.inf]])
    which = np.digitize(place, edges) - 1
    count = np.bincount(which, minlength=grid.size)
    total = np.bincount(which, weights=values, minlength=grid.size)
    known = count > 0
    return np.interp(grid, grid[known], total[known] / count[known])


def _still(curve: Curve, sensitivity: float | None) -> dict[str, float]:
    """What the channels do without contact; the resolution follows where the run has a sensitivity."""
    found = {"drift_pressure_kPa_per_min": 60 * curve.drift[0] / KPA}
    if curve.run.kind == "loop":
        # Its rests are too short for the noise: the wall still recovers.
        return found
    noise_force, noise_pressure = curve.noise[0], curve.noise[1] / KPA
    found |= {"noise_force_N": noise_force, "noise_pressure_kPa": noise_pressure}
    if sensitivity:
        found["resolution_N"] = RESOLVED * noise_pressure / abs(sensitivity)
    return found
