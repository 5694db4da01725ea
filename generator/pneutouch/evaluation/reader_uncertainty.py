"""Standard uncertainty of the force that is read at a pressure rise, over the grid of a reader."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.reader import ReaderGrid
from pneutouch.evaluation.uncertainty import known, unknown

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.mechanics.atlas.press import SensorBatch

UNCERTAINTY_COLUMNS = 11
"""Shares of the indentation at which the uncertainty is tabulated."""

_STEP = 0.015
"""Half of the central difference, relative, as in `mechanics.uncertainty.derivatives`."""

_STEPS = 40


def force_uncertainty(evaluation: Evaluation, grid: ReaderGrid) -> Array | None:
    """Relative standard uncertainty of the force at the rows of a grid and `UNCERTAINTY_COLUMNS` shares of the
    indentation, (n, 11); None if it is unknown, see `why_unknown`.

    Sources that act on inputs of the model act through the curve of force over pressure rise; errors of the model are
    those of its sensitivity, the slope of that curve. The gauge's noise is not in it.
    """
    sensor, scene = evaluation.sensor, evaluation.scene
    if why_unknown(evaluation, grid) is not None:
        return None
    from pneutouch.mechanics.uncertainty.source import FIGURES, SENSITIVITY

    rows = grid.driving_pressure[grid.computed :]
    budget = known(
        sensor,
        [float(p) for p in rows],
        scene.membrane_material,
        list(evaluation.resins.values()),
        scene.printer,
        grid.model,
        calibration=scene.calibration,
        anywhere=scene.design.contact.anywhere,
    )
    slopes = _slopes(budget.batch)
    relative = np.empty((rows.size, UNCERTAINTY_COLUMNS))
    for column in range(UNCERTAINTY_COLUMNS):
        one = np.repeat(slopes[:, None, :, column], len(FIGURES), axis=1)
        variance = sum(source.variance(one)[SENSITIVITY] for source in budget.budget.sources)
        relative[:, column] = np.sqrt(variance)
    return np.concatenate([np.repeat(relative[:1], grid.computed, axis=0), relative])


def why_unknown(evaluation: Evaluation, grid: ReaderGrid) -> str | None:
    """Reason why the uncertainty of the force is unknown, or None if it is known."""
    other = evaluation.sensor.protocol.other_contact
    if other is not None:
        return f"computed for a central plate without friction alone; here {other}"
    return unknown(evaluation.sensor, grid.model)


def _slopes(batch: SensorBatch) -> Array:
    """Slopes of ln force at a fixed pressure rise by the inputs in their unit of uncertainty, (inputs, n, columns)."""
    from pneutouch.mechanics.atlas.respond import respond
    from pneutouch.mechanics.uncertainty.neighbours import joined, moved, neighbourhood, unit_step
    from pneutouch.mechanics.uncertainty.source import INPUTS

    unit, size = unit_step(batch), len(batch)
    moves = [moved(batch, name, sign * _STEP * unit[i]) for i, name in enumerate(INPUTS) for sign in (1.0, -1.0)]
    response = respond(joined([batch, *moves]), _STEPS, neighbourhood())
    curves = [(response.rise[k], response.force[k]) for k in range(size * (1 + len(moves)))]
    shares = np.linspace(0.0, 1.0, UNCERTAINTY_COLUMNS)
    slopes = np.zeros((len(INPUTS), size, UNCERTAINTY_COLUMNS))
    for n in range(size):
        # The force goes to nothing with the rise: the first column is that of the first step.
        at = np.interp(np.maximum(shares, 1.0 / _STEPS) * _STEPS, np.arange(_STEPS + 1.0), curves[n][0])
        for i in range(len(INPUTS)):
            more, less = (_log_force(curves[size * (1 + 2 * i + k) + n], at) for k in (0, 1))
            slopes[i, n] = (more - less) / (2.0 * _STEP * unit[i, n])
    return slopes


def _log_force(curve: Sequence[Array], rises: Array) -> Array:
    """Logarithm of a curve's force at pressure rises; beyond its end by its last power of the rise."""
    rise, force = np.log(curve[0][1:]), np.log(curve[1][1:])
    at = np.log(rises)
    inside = np.interp(at, rise, force)
    after = force[-1] + (at - rise[-1]) * (force[-1] - force[-2]) / (rise[-1] - rise[-2])
    before = force[0] + (at - rise[0]) * (force[1] - force[0]) / (rise[1] - rise[0])
    return np.asarray(np.where(at > rise[-1], after, np.where(at < rise[0], before, inside)))
