"""Standard deviations of force and place that a reading of a pad leaves, by the Fisher information of its cells."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.touch.cell import TABLE_ERROR
from pneutouch.mechanics.touch.forward import ObjectKind, PadModel
from pneutouch.mechanics.touch.objects import answer_of, random_objects

_STEP, _RANDOM = 1e-3, 2000
"""Step of the differences in spreads of each parameter, and number of random objects that give these spreads."""


class TouchResolution(NamedTuple):
    """Standard deviations for m contacts: of force (m,), N; of its centre, of both directions together (m,), mm."""

    force: Array
    place: Array


def resolution(
    model: PadModel, kind: ObjectKind, objects: Array, noise: float, model_error: float = TABLE_ERROR / 3.0
) -> TouchResolution:
    """Resolution at objects (m, k) as of `answer_of`, of which nothing is known but the readings, what objects there
    are, and which cell is nearest to a ball. ``noise`` is the standard deviation of a gauge, MPa; ``model_error`` as of
    `reader_table`.

    Information is that of a linearised reading: where one cell is touched, the true region is a curve (see
    `export.reader.pad_reading`)."""
    random = random_objects(model, kind, _RANDOM, np.random.default_rng(0))
    if kind == "ball":
        # Which cell reads most tells which is near.
        nearest = np.hypot(*(random[:, None, :2] - model.places).transpose(2, 0, 1)).argmin(axis=1)
        random[:, :2] -= model.places[nearest]
    spread = random.std(axis=0)
    known, size = answer_of(model, kind, objects), objects.shape[1]
    deviation = np.hypot(noise, model_error * known.rise.max(axis=1))
    slopes, turned = [], []
    for step in np.diag(_STEP * spread):
        ahead, behind = answer_of(model, kind, objects + step), answer_of(model, kind, objects - step)
        slopes.append((ahead.rise - behind.rise) / (2.0 * _STEP) / deviation[:, None])
        told = [np.column_stack([one.force, one.centre]) for one in (ahead, behind)]
        turned.append((told[0] - told[1]) / (2.0 * _STEP))
    jacobian, along = np.stack(slopes, axis=-1), np.stack(turned, axis=-1)
    covariance = np.linalg.inv(np.einsum("mni,mnj->mij", jacobian, jacobian) + np.eye(size))
    square = np.einsum("mai,mij,maj->ma", along, covariance, along)
    return TouchResolution(np.sqrt(square[:, 0]), np.sqrt(square[:, 1] + square[:, 2]))
