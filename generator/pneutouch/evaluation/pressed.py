"""The pressed dome of a datasheet, evaluated from the Fourier sums of a prediction."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.chart_data import PressedView
from pneutouch.mechanics import SensorPrediction
from pneutouch.units import KPA

_ANGLES = 64
"""Angles around the axis at which the surface is evaluated."""


def pressed_view(prediction: SensorPrediction) -> PressedView | None:
    """The dome at the first driving pressure, pressed to the end of its range; None by a model without a surface."""
    state = prediction.states[0]
    face = state.face
    if face is None:
        return None
    angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    rows = face.rows()
    points = face.positions(rows, angles)
    # On the axis all angles are one point.
    points[-1] = points[-1].mean(axis=0)
    pressure = face.pressure(rows, angles)
    pressure[-1] = pressure[-1].mean()
    sheared = None if state.beyond_axis is None else state.beyond_axis.shear
    moved = face.travel != 0.0 and sheared is not None
    force = sheared.force[-1] if moved and sheared else np.interp(face.indentation, state.indentation, state.force)
    return PressedView(
        driving_pressure_kPa=state.driving_pressure / KPA,
        indentation=face.indentation,
        travel=face.travel,
        force=float(force),
        points=points,
        normals=_normals(points),
        pressure_kPa=pressure / KPA,
        lines=face.lines,
    )


def _normals(points: Array) -> Array:
    """Outward unit normals of a surface (n, m, 3), from differences between neighbours."""
    along = np.gradient(points, axis=0)
    around = np.roll(points, -1, axis=1) - np.roll(points, 1, axis=1)
    out = np.cross(around, along)
    # On the axis a row is one point and has no tangent around it.
    out[-1] = out[-2].sum(axis=0)
    return np.asarray(out / np.linalg.norm(out, axis=2, keepdims=True))
