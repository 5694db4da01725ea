"""The uncertainty of the limit pressure alone: without a press, so that thousands of candidates cost little."""

from functools import cache
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.neighbours import neighbourhood
from pneutouch.mechanics.uncertainty.propagate import variances
from pneutouch.mechanics.uncertainty.source import FIGURES, INPUTS, UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model import ModelErrors
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

LIMIT = FIGURES.index("limit_pressure_kPa")

COUPON = 0.03
"""Relative standard deviation of a modulus from tensile coupons of the same print: our choice."""

_RATIOS = 200
"""Wall ratios of the table of slopes: 1 % apart, half a step of the derivatives of the budget."""


class LimitSpread(NamedTuple):
    """Relative standard uncertainties of the limit pressure of n sensors, (n,) each.

    standard: As the resin's modulus is known. measured: With the modulus measured on coupons, to `COUPON`.
    """

    standard: Array
    measured: Array


def limit_spread(
    batch: SensorBatch,
    material: Material,
    printer: Printer,
    numerical: float,
    calibration: SensorCalibration | None = None,
) -> LimitSpread:
    """The uncertainty that `budget` states for the limit pressure, of n sensors of one resin and printer.

    ``numerical`` is the greatest relative error of the limit pressure as a numerical answer.
    """
    modulus = material.shear_modulus_MPa
    assert modulus is not None
    coupon = modulus.model_copy(update={"spread": COUPON * modulus.nominal})
    error = {FIGURES[LIMIT]: numerical}

    def standard(known: Material) -> Array:
        none = ModelErrors()
        return _standard(
            batch,
            sources(batch, known, printer, near_paper=False, errors=none, numerical=error, calibration=calibration),
        )

    measured = material.model_copy(update={"shear_modulus_MPa": coupon})
    return LimitSpread(standard(material), standard(measured))


def _standard(batch: SensorBatch, source_list: list[UncertaintySource]) -> Array:
    """Combined as `propagate` does, with the slopes of ln limit pressure known beforehand.

    It is the modulus times a function of the wall ratio, and depends on nothing else.
    """
    by_ratio = wall_slope(batch.wall_ratio)
    slopes = np.zeros((len(INPUTS), len(FIGURES), len(batch)))
    slopes[INPUTS.index("shear_modulus"), LIMIT] = 1.0
    slopes[INPUTS.index("wall_thickness"), LIMIT] = by_ratio
    slopes[INPUTS.index("inner_radius"), LIMIT] = -by_ratio
    return np.asarray(np.sqrt(variances(source_list, slopes)[:, LIMIT].sum(axis=0)))


def wall_slope(wall_ratio: Array) -> Array:
    """Slope of the logarithm of the limit pressure by that of the wall ratio, (n,); beyond the atlas its edge's."""
    at, slope = _slopes()
    return np.asarray(np.interp(np.log(wall_ratio), at, slope))


@cache
def _slopes() -> tuple[Array, Array]:
    """Logarithms of wall ratios, and the slopes there."""
    walls = neighbourhood().recipe.wall_ratios
    at = np.linspace(np.log(walls[0]), np.log(walls[-1]), _RATIOS)
    # Powers of e round: the ends stay inside the table.
    pressure = neighbourhood().slices(np.clip(np.exp(at), walls[0], walls[-1]), ()).limit_pressure
    return at, np.gradient(np.log(pressure), at)
