"""Sensitivity of the figures of many sensors to their inputs: local derivatives, and the effect of the inputs' whole
spread."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.contact import ContactShift
from pneutouch.mechanics.uncertainty.neighbours import joined, log_figures, moved, unit_step
from pneutouch.mechanics.uncertainty.source import DEAD, INPUTS

STEP = 0.015
"""Half of the central difference, relative. Below it the noise of tabulated ends of ranges grows (the buckling edge is
kept in straight pieces), above it curvature, most of it where a wall lies down on its base: half and twice the step
move a derivative of the sensitivity by less than 0.04 and the combined uncertainty by less than 1.5 %, in most sensors
by less than 0.1 % (`tests/mechanics/uncertainty/test_derivatives.py`; 0.01 and 0.02 keep neither bound)."""

_BENT = 0.05
"""Share by which the whole spread may differ from the derivative before it takes its place."""

_WIDE = 0.5
"""A figure for which less than this share of an input's spread counts keeps the derivative."""


@dataclass(frozen=True)
class Derivatives:
    """Figures of n sensors and how they move.

    Attributes:
        logs: ln of the figures, (figures, n).
        elasticities: d ln figure / d ln input, (inputs, figures, n); 0 for the dead volume if there is none.
        local: Derivatives of ln figure by the input in its unit of uncertainty (relative; dead volume mm3), same shape.
        slopes: The same, or root mean square change over the input's spread per standard uncertainty where it is bent.
        one_sided: True where a sensor could not be evaluated on one side: beyond its limit point or the atlas,
            (inputs, n).
    """

    logs: Array
    elasticities: Array
    local: Array
    slopes: Array
    one_sided: Flags

    def part(self, rows: slice) -> Derivatives:
        """The derivatives of some of the sensors."""
        return Derivatives(*(getattr(self, each.name)[..., rows] for each in fields(self)))


def derivatives(
    batch: SensorBatch,
    standard: Array,
    kurtosis: Array,
    step: float = STEP,
    shift: ContactShift | None = None,
    groups: Index | None = None,
) -> Derivatives:
    """Move every input of n sensors by a small step and over its spread.

    Args:
        batch: The sensors.
        standard: Standard uncertainties of the inputs as they count for each figure, (inputs, figures, n).
        kurtosis: Fourth moment over squared variance of each input's deviation, (inputs, n).
        step: Half of the central difference, relative.
        shift: Of the figures from the plate's to those of another contact.
        groups: Numbers from 0 on, (n,), of what several calls would compute; see `respond`.
    """
    unit = unit_step(batch)
    widest = standard.max(axis=1)
    far = np.sqrt(kurtosis) * widest
    offsets = (step * unit, -step * unit, far, -far)
    rows = [moved(batch, name, offset[i]) for i, name in enumerate(INPUTS) for offset in offsets]
    every, size = joined([batch, *rows]), len(batch)
    logs = log_figures(every, None if groups is None else np.tile(groups, 1 + len(rows)))
    if shift is not None:
        by = np.log(every.shear_modulus.reshape(-1, size) / batch.shear_modulus)
        logs = logs + shift.at(by).reshape(logs.shape)
    here = logs[:, :size]
    around = logs[:, size:].reshape(len(logs), len(INPUTS), len(offsets), size).transpose(1, 2, 0, 3) - here
    local = _slope(around[:, 0], around[:, 1]) / (step * unit[:, None])
    whole, known = _over_spread(around[:, 2], around[:, 3], kurtosis[:, None])
    linear = np.abs(local) * widest[:, None]
    bent = known & (np.abs(whole - linear) > _BENT * linear) & (standard >= _WIDE * widest[:, None]) & (standard > 0)
    sign = np.where(around[:, 2] < around[:, 3], -1.0, 1.0)
    slopes = np.where(bent, sign * whole / np.where(bent, widest[:, None], 1.0), local)
    scale = np.ones_like(unit)
    scale[DEAD] = batch.dead_volume
    one_sided = np.asarray((np.isnan(around[:, 2:]).any(axis=1) & np.isfinite(here)).any(axis=1))
    return Derivatives(here, local * scale[:, None], local, slopes, one_sided)


def _slope(up: Array, down: Array) -> Array:
    """Half the difference of both sides; one side alone at an edge, 0 with neither."""
    both = np.where(np.isnan(down), up, np.where(np.isnan(up), -down, 0.5 * (up - down)))
    return np.where(np.isnan(both), 0.0, both)


def _over_spread(up: Array, down: Array, kurtosis: Array) -> tuple[Array, Flags]:
    """Standard deviation of ln figure over an input's spread, and where it is known.

    By the three-point rule at sqrt(kurtosis) standard uncertainties, weights 1/(2 kurtosis), which has the first five
    moments of the deviation: Gauss-Hermite's for a normal one, Gauss-Legendre's for a rectangular one.
    """
    known = np.isfinite(up) & np.isfinite(down)
    high, low = np.where(known, up, 0.0), np.where(known, down, 0.0)
    weight = 0.5 / kurtosis
    return np.sqrt(np.maximum(weight * (high**2 + low**2) - (weight * (high + low)) ** 2, 0.0)), known
