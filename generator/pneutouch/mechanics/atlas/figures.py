"""Predicted figures, by the atlas, of batches of sensors and of the same sensors with shifted inputs."""

from dataclasses import replace
from functools import cache

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.atlas.table import REST_VOLUME, Atlas, shipped
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.units import KPA

FIGURES = (
    SENSITIVITY_KEY,
    "limit_pressure_kPa",
    STIFFNESS_KEY,
    "force_at_range_end_N",
    "range_end_mm",
    "apex_height_outer_mm",
)
"""The predicted figures, in the order of every array over figures."""

INPUTS = ("shear_modulus", "wall_thickness", "inner_radius", "dead_volume", "ambient_pressure", "driving_pressure")
"""Inputs of the model on which a source of uncertainty may act, in the order of every array over inputs; names of
fields of `SensorBatch`."""

SENSITIVITY = FIGURES.index(SENSITIVITY_KEY)
CONTACT_FIGURES = (
    SENSITIVITY,
    FIGURES.index(STIFFNESS_KEY),
    FIGURES.index("force_at_range_end_N"),
    FIGURES.index("range_end_mm"),
)
"""Indices of the figures that depend on the contact; the last is the end of the range."""
DEAD = INPUTS.index("dead_volume")


_MARGIN = 0.001
"""Distance (R0) from the depth limit of `neighbourhood` to the depth of the solved states (`AtlasRecipe.beyond`)."""

SOFTEST = 6.0
"""Greatest ambient pressure over modulus for which derivatives are taken from the tables. The gas is not one of their
coordinates: it only decides which states a press passes, and in a stiff gas these are among the solved ones. Checked
with the paper's dome without driving pressure and at 6 % of the limit pressure
(`tests/mechanics/uncertainty/test_soft_walls.py`): at 1.8, 4.1 and 5.8 moduli the figures are within 0.2 % of the
solid's, derivatives by modulus and wall within 5 % or 0.04; at 11 they are off by 2 % and up to 25 %."""

THICKEST = 0.5
"""Greatest wall ratio of `wider_box`. Of 120 random presses of thicker walls than the atlas's own, half are within
0.02 % of the solid's sensitivity, 99 of 100 within 0.6 %, and all within 1.5 %
(`tests/mechanics/uncertainty/test_soft_walls.py`)."""


@cache
def neighbourhood() -> Atlas:
    """The shipped atlas with its box (limits of inputs) opened to nearly all its data, for sensors with shifted inputs.

    A sensor pressed to three quarters of R0 is on the edge of the box, and outside if its radius is reduced at the same
    travel. The tables go on to `AtlasRecipe.beyond` and to walls outside the box, so that such sensors can be
    evaluated. The gas may be twice as stiff as in `wider_box`, for the shifted sensors of that atlas.
    """
    known = shipped()
    recipe, walls = known.recipe, known.recipe.wall_ratios
    open_ = replace(
        recipe,
        thinnest=float(walls[0]),
        thickest=float(walls[-1]),
        margin=1.0,
        deepest=recipe.beyond - _MARGIN,
        stiffest=2.0 * SOFTEST,
    )
    return known.boxed(open_)


@cache
def wider_box() -> Atlas:
    """The shipped atlas with its box opened to an ambient pressure of `SOFTEST` moduli and to walls of `THICKEST`: for
    derivatives, and for a search whose designs the solid confirms."""
    known = shipped()
    return known.boxed(replace(known.recipe, stiffest=SOFTEST, thickest=THICKEST))


def moved(batch: SensorBatch, name: str, by: Array) -> SensorBatch:
    """The batch with the input ``name`` multiplied by exp(``by``), (n,); the dead volume changes by the sum, mm3.

    At least half of the unloaded cavity stays as gas volume: a tiny sensor holds less than a deviation of 0.1 mL.
    """
    value = getattr(batch, name)
    if name != INPUTS[DEAD]:
        return replace(batch, **{name: value * np.exp(by)})
    least = np.minimum(value, -0.5 * REST_VOLUME * batch.inner_radius**3)
    return replace(batch, dead_volume=np.maximum(value + by, least))


def unit_step(batch: SensorBatch) -> Array:
    """Unit of ``by`` in `moved` for each input, (inputs, n): 1, for the dead volume the whole gas volume, mm3."""
    steps = np.ones((len(INPUTS), len(batch)))
    steps[DEAD] = REST_VOLUME * batch.inner_radius**3 + np.maximum(batch.dead_volume, 0.0)
    return steps


def log_figures(batch: SensorBatch) -> Array:
    """Natural logarithms of the figures, (figures, n); NaN for a missing figure. Units as stated in `FIGURES`."""
    # In order of the wall ratio, because the atlas cuts its tables once for each ratio of a chunk.
    order = np.argsort(batch.wall_ratio, kind="stable")
    response = respond(batch.take(order), atlas=neighbourhood())
    figures = np.empty((len(FIGURES), len(batch)))
    figures[:, order] = [
        response.lines.sensitivity,
        response.limit_pressure / KPA,
        response.lines.stiffness,
        response.lines.force_high,
        response.range_end,
        response.apex_outer,
    ]
    with np.errstate(invalid="ignore", divide="ignore"):
        logs = np.log(figures)
    return np.where(np.isfinite(logs), logs, np.nan)
